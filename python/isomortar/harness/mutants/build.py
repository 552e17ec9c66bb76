"""Programs with a fault, each a folder of files that take the place of the package's own.

A kernel with a fault is built from a copy of the sources that is built once, and copied with its build for every fault.
"""

from __future__ import annotations

import hashlib
import shutil
import tempfile
from collections.abc import Set
from pathlib import Path
from typing import Protocol

from isomortar.errors import IsomortarError
from isomortar.harness.mutants import lines_of_kernel, lines_of_python
from isomortar.harness.mutants.faults import Fault
from isomortar.harness.mutants.layers import Layer
from isomortar.harness.mutants.meaning import meaning
from isomortar.harness.store import kernel_hash, package_hash
from isomortar.program.process import output_of, tools_first

#: What of a checkout makes the kernel.
_PARTS = ("meson.build", "meson.options", "fortran", "tools/f2py_wrap.py", "tools/compile_bytecode.py", "tools/version.py")
#: Seconds after which a compiler that found no end has rejected a fault.
_SECONDS = 300


class Workshop(Protocol):
    """Makes programs with faults."""

    #: Hash of the sources.
    sources: str
    #: Hash of all that a program is made of besides them.
    rest: str
    #: The program without a fault.
    sound: Path
    #: It as it is for `scout`, the program that measures cells on it and notes what lines of the sources they run.
    scouted: Path
    scout: str

    def build(self, fault: Fault) -> Path | None:
        """The program with a fault, a folder; None where the compiler rejects it."""

    def identity(self, program: Path) -> str:
        """Hash of what a program does: two faults with one hash are one."""

    def places(self, fault: Fault, /) -> list[Set[int]]:
        """Lines around a fault, narrowest first: who runs none of the first that anybody runs can not see it."""


class KernelWorkshop:
    """Kernels with faults, in double and in extended precision: a mistake in the shared sources is in both.

    Copies are cheap: ninja finds in a copy (times and all) nothing to do but what depends on the file that changed. Faults do not touch
    the checkout.

    Parameters
    ----------
    project : Path
        The checkout.
    folder : Path
        Where to work.
    """

    scout = lines_of_kernel.__name__

    def __init__(self, project: Path, folder: Path) -> None:
        self._programs = folder / "programs"
        self._programs.mkdir(parents=True, exist_ok=True)
        self._sound = folder / "sources"
        shutil.rmtree(self._sound, ignore_errors=True)
        (self._sound / "python/isomortar").mkdir(parents=True)
        for part in _PARTS:
            (self._sound / part).parent.mkdir(exist_ok=True)
            copy = shutil.copytree if (project / part).is_dir() else shutil.copy2
            copy(project / part, self._sound / part)
        self.sources = _hash_of_files(self._sound)
        self.rest = package_hash()
        counting = _that_counts(self._sound, folder / "counting")
        _set_up(self._sound)
        targets = [line.split(":")[0] for line in _run(["ninja", "-C", "build", "-t", "targets", "all"], self._sound)]
        self._targets = [t for t in targets if t.startswith(("fortran/_kernel.", "fortran/_extended.")) and t.endswith(".so")]
        self.sound = self._made(self._sound, folder / "sound")
        self.scouted = self._made(counting, folder / "scouted")

    def build(self, fault: Fault) -> Path | None:
        """The kernels with a fault, a folder; None where the compiler rejects it."""
        program = self._programs / content(self, fault)[:20]
        if program.exists():
            return program
        with tempfile.TemporaryDirectory(dir=self._programs.parent) as place:
            copy = Path(shutil.copytree(self._sound, Path(place) / "copy"))
            source = copy / "fortran" / fault.file
            source.write_text(fault.applied(source.read_text()))
            try:
                return self._made(copy, Path(place) / "program").replace(program)
            except IsomortarError:
                return None

    def identity(self, program: Path) -> str:
        """Hash of the compiled kernels."""
        return _hash_of_files(program)

    def places(self, fault: Fault, /) -> list[Set[int]]:
        """Lines of the statements that a fault is in, and of the procedures."""
        return lines_of_kernel.places((self._sound / "fortran" / fault.file).read_text(), fault.lines)

    def _made(self, sources: Path, program: Path) -> Path:
        """Build the kernels of some sources, and put them into a folder."""
        _run(["ninja", "-C", "build", *self._targets], sources)
        shutil.rmtree(program, ignore_errors=True)
        program.mkdir()
        for target in self._targets:
            shutil.copy2(sources / "build" / target, program)
        return program


class PythonWorkshop:
    """Packages with a changed Python file; the kernel is the one that is built.

    Parameters
    ----------
    project : Path
        The checkout.
    folder : Path
        Where to work.
    layer : Layer
        Where the sources stand.
    """

    scout = lines_of_python.__name__

    def __init__(self, project: Path, folder: Path, layer: Layer) -> None:
        self._programs = folder / "programs"
        self._files = layer.read(project)
        self.sources, self.rest = package_hash(), kernel_hash()
        self.sound = self.scouted = folder / "sound"
        self.sound.mkdir(parents=True, exist_ok=True)

    def build(self, fault: Fault) -> Path | None:
        """The changed file, in a folder; None where it can not be compiled."""
        text = fault.applied(self._files[fault.file])
        try:
            compile(text, fault.file, "exec")
        except SyntaxError:
            return None
        program = self._programs / content(self, fault)[:20]
        (program / fault.file).parent.mkdir(parents=True, exist_ok=True)
        (program / fault.file).write_text(text)
        return program

    def identity(self, program: Path) -> str:
        """Hash of what is executed of the files that are not as they were."""
        changed = {path.relative_to(program).as_posix(): meaning(path.read_text()) for path in sorted(program.rglob("*.py"))}
        parts = [f"{file}\0{text}" for file, text in changed.items() if text != meaning(self._files[file])]
        return hashlib.sha256("\0".join([self.sources, *parts]).encode()).hexdigest()

    def places(self, fault: Fault, /) -> list[Set[int]]:
        """Lines of the statements that a fault is in."""
        return lines_of_python.places(self._files[fault.file], fault.lines)


def workshop_of(layer: Layer, project: Path, folder: Path) -> Workshop:
    """The workshop for faults in a layer."""
    return KernelWorkshop(project, folder) if layer.name == "kernel" else PythonWorkshop(project, folder, layer)


def content(workshop: Workshop, fault: Fault) -> str:
    """Hash of all that a program with a fault is made from."""
    change = "\0".join((workshop.sources, fault.file, str(fault.position), fault.old, fault.new))
    return hashlib.sha256(change.encode()).hexdigest()


def _set_up(sources: Path, *options: str) -> None:
    """Set up the build of a copy of the sources: the kernel for all processors, linked in a second, not optimised across files."""
    _run(["meson", "setup", "build", "--buildtype=release", "-Db_lto=false", "-Davx2=false", *options], sources)


def _that_counts(sound: Path, sources: Path) -> Path:
    """Set up a copy of the sources so that its kernels count which lines they run, not one of them lost to what is inlined."""
    shutil.rmtree(sources, ignore_errors=True)
    shutil.copytree(sound, sources)
    (sources / "counts.c").write_text(lines_of_kernel.COUNTS)
    _run(["cc", "-fPIC", "-c", "counts.c"], sources)
    linked = f"-Dfortran_link_args=['{sources.resolve() / 'counts.o'}', '--coverage']"
    _set_up(sources, "-Doptimization=1", "-Db_coverage=true", "-Dfortran_args=-fno-inline", linked)
    return sources


def _hash_of_files(folder: Path) -> str:
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    parts = (hashlib.sha256(path.relative_to(folder).as_posix().encode() + b"\0" + path.read_bytes()).digest() for path in files)
    return hashlib.sha256(b"".join(parts)).hexdigest()


def _run(command: list[str], folder: Path) -> list[str]:
    """Run one of the environment's build tools; the lines it says."""
    return output_of(command, _SECONDS, folder, tools_first()).splitlines()
