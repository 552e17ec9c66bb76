"""Kernels with a fault: a copy of the sources that is built once, and copied with its build for every fault."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from isomortar.errors import IsomortarError
from isomortar.harness.mutants.faults import Fault

#: What of a checkout makes the kernel.
_PARTS = ("meson.build", "meson.options", "fortran", "tools/f2py_wrap.py")
#: Seconds after which a compiler that found no end has rejected a fault.
_SECONDS = 300


class Workshop:
    """Builds kernels with faults.

    Copies are cheap: ninja finds in a copy (times and all) nothing to do but what depends on the file that changed. Faults touch
    neither the checkout nor the extended-precision twin: the twin that measures a faulty kernel has no fault.

    Parameters
    ----------
    project : Path
        The checkout.
    folder : Path
        Where to work.
    """

    def __init__(self, project: Path, folder: Path) -> None:
        self._kernels = folder / "kernels"
        self._kernels.mkdir(parents=True, exist_ok=True)
        self._sound = folder / "sound"
        shutil.rmtree(self._sound, ignore_errors=True)
        (self._sound / "python/isomortar").mkdir(parents=True)
        for part in _PARTS:
            (self._sound / part).parent.mkdir(exist_ok=True)
            copy = shutil.copytree if (project / part).is_dir() else shutil.copy2
            copy(project / part, self._sound / part)
        self.sources = _hash_of_files(self._sound)
        _run(["meson", "setup", "build", "--buildtype=release", "-Db_lto=false"], self._sound)  # linked in a second
        targets = _run(["ninja", "-C", "build", "-t", "targets", "all"], self._sound)
        self._target = next(t for t in (line.split(":")[0] for line in targets) if t.startswith("fortran/_kernel.") and t.endswith(".so"))
        _run(["ninja", "-C", "build", self._target], self._sound)

    @property
    def sound(self) -> Path:
        """The kernel without a fault."""
        return self._sound / "build" / self._target

    def content(self, fault: Fault) -> str:
        """Hash of all that a faulty kernel is made from."""
        change = "\0".join((self.sources, fault.file, str(fault.position), fault.old, fault.new))
        return hashlib.sha256(change.encode()).hexdigest()

    def build(self, fault: Fault) -> Path | None:
        """The kernel with a fault; None where the compiler rejects it."""
        kernel = self._kernels / f"{self.content(fault)[:20]}.so"
        if kernel.exists():
            return kernel
        with tempfile.TemporaryDirectory(dir=self._kernels.parent) as place:
            copy = Path(shutil.copytree(self._sound, Path(place) / "copy"))
            source = copy / "fortran" / fault.file
            source.write_text(fault.applied(source.read_text()))
            try:
                _run(["ninja", "-C", "build", self._target], copy)
            except IsomortarError:
                return None
            return (copy / "build" / self._target).replace(kernel)


def hash_of(kernel: Path) -> str:
    """Hash of a compiled kernel: two faults with one hash are one."""
    return hashlib.sha256(kernel.read_bytes()).hexdigest()


def _hash_of_files(folder: Path) -> str:
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    parts = (hashlib.sha256(path.relative_to(folder).as_posix().encode() + b"\0" + path.read_bytes()).digest() for path in files)
    return hashlib.sha256(b"".join(parts)).hexdigest()


def _run(command: list[str], folder: Path) -> list[str]:
    """Run one of the environment's build tools; the lines it says."""
    environment = os.environ | {"PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ.get('PATH', os.defpath)}"}
    try:
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=_SECONDS, check=True)
    except FileNotFoundError:
        raise IsomortarError(f"{command[0]} is not installed: `make setup` installs it") from None
    except subprocess.TimeoutExpired:
        raise IsomortarError(f"{' '.join(command)} took longer than {_SECONDS} s in {folder}") from None
    except subprocess.CalledProcessError as error:
        raise IsomortarError(f"{' '.join(command)} failed in {folder}:\n{error.stdout[-2000:]}{error.stderr[-2000:]}") from None
    return done.stdout.splitlines()
