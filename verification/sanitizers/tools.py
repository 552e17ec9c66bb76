"""The tools that watch a kernel at work: how it is built for each, how its process is started, and what was seen."""

from __future__ import annotations

import re
import shutil
import sys
import xml.etree.ElementTree as Xml
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

from isomortar.program.process import output_of, run, tools_first

PROJECT = Path(__file__).resolve().parents[2]
#: What of a checkout makes the kernel.
_PARTS = ("meson.build", "meson.options", "fortran", "tools/f2py_wrap.py", "tools/compile_bytecode.py", "tools/version.py")
_KERNEL = f"_kernel{EXTENSION_SUFFIXES[0]}"
#: Seconds after which a build or a watched process has failed.
_BUILD, _WORK = 600, 1500
#: valgrind knows no AVX-512. One thread: the runtime of OpenMP is not the kernel's.
_ENVIRONMENT = {"OPENBLAS_CORETYPE": "Haswell", "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}


@dataclass(frozen=True)
class Tool:
    """A tool: options of the build, words before the command, variables of the environment, what a report looks like.

    `{log}` in words and variables is where reports go; a report of memcheck counts where a frame of it is the kernel's.
    """

    build: tuple[str, ...]
    words: tuple[str, ...] = ()
    variables: tuple[tuple[str, str], ...] = ()
    report: str = ""


def _library(name: str) -> str:
    return output_of(["gcc", f"-print-file-name={name}"]).strip()


TOOLS = {
    "bounds": Tool(("--buildtype=debug",), report=r"Fortran runtime error: .*|contract broken: .*"),
    "address": Tool(
        ("--buildtype=debugoptimized", "-Db_sanitize=address,undefined", "-Db_lundef=false"),
        variables=(
            ("LD_PRELOAD", "libasan.so libubsan.so"),
            ("ASAN_OPTIONS", "detect_leaks=0:log_path={log}"),  # Python leaves memory to the system at its end
            ("UBSAN_OPTIONS", "print_stacktrace=1:log_path={log}"),
        ),
        report=r"ERROR: AddressSanitizer.*|runtime error: .*",
    ),
    "memcheck": Tool(
        ("--buildtype=debugoptimized",),
        words=("valgrind", "--tool=memcheck", "--xml=yes", "--xml-file={log}.xml", "--num-callers=30", "--undef-value-errors=yes"),
        variables=(("PYTHONMALLOC", "malloc"),),
    ),
}


def is_missing(name: str) -> str:
    """The program that a tool lacks here; empty where it is all there."""
    needed = {"memcheck": "valgrind"}.get(name, "gcc")
    if shutil.which(needed) is None:
        return needed
    return "" if name != "address" or Path(_library("libasan.so")).is_absolute() else "libasan.so"


def sources(folder: Path) -> Path:
    """A copy of what makes the kernel."""
    (folder / "python/isomortar").mkdir(parents=True)
    for part in _PARTS:
        (folder / part).parent.mkdir(exist_ok=True)
        copy = shutil.copytree if (PROJECT / part).is_dir() else shutil.copy2
        copy(PROJECT / part, folder / part)
    return folder


def build(tool: Tool, folder: Path) -> Path:
    """The kernel for a tool, from the sources in a folder; built again where they changed."""
    if not (folder / "build").exists():
        output_of(["meson", "setup", "build", "-Db_lto=false", "-Davx2=false", *tool.build], _BUILD, folder, tools_first())
    output_of(["ninja", "-C", "build", f"fortran/{_KERNEL}"], _BUILD, folder, tools_first())
    return folder / "build/fortran" / _KERNEL


def watched(tool: Tool, kernel: Path, package: Path, work: Path, words: Sequence[str]) -> tuple[list[str], int]:
    """Run a program on a kernel under a tool: the reports, and the exit code.

    `package` holds a copy of the package, which takes the kernel; `work` is the program.
    """
    shutil.copy2(kernel, package / "isomortar" / _KERNEL)
    log = package / "reports"
    for old in package.glob("reports*"):
        old.unlink()
    # With `-S`: the import hook of an editable install would come first.
    start = f"import runpy, sys; sys.path[:0] = [{str(package)!r}]; sys.path += {[p for p in sys.path if p]!r}; "
    start += f"sys.argv = {[str(work), *words]!r}; runpy.run_path({str(work)!r}, run_name='__main__')"
    variables = {name: _preloaded(value) if name == "LD_PRELOAD" else value.format(log=log) for name, value in tool.variables}
    command = [*(word.format(log=log) for word in tool.words), sys.executable, "-S", "-X", "faulthandler", "-c", start]
    done = run(command, seconds=_WORK, folder=package, environment=_ENVIRONMENT | variables)
    said = [done.output, done.errors, *(path.read_text(errors="replace") for path in package.glob("reports*") if path.suffix != ".xml")]
    reports = [found for text in said for found in re.findall(tool.report, text)] if tool.report else []
    reports += [report for path in package.glob("reports*.xml") for report in _of_kernel(path)]
    status = done.end.status
    if status is None or (status and not reports):
        ended = done.end.words.splitlines()[-1]
        raise RuntimeError(f"{' '.join(tool.words[:1] or ['the program'])}: {ended}: {_words_of(done.errors)}")
    return reports, status


def _words_of(text: str) -> str:
    """The last lines, without Python's list of modules."""
    return "\n".join([line for line in text.splitlines() if not re.match(r"Extension modules|$", line)][-30:])


def _preloaded(libraries: str) -> str:
    return " ".join(_library(name) for name in libraries.split())


def _of_kernel(path: Path) -> list[str]:
    """What memcheck found with the kernel at work: its own frames, or what it called."""
    reports = []
    for _, error in Xml.iterparse(path):  # of the interpreter's leaks there are hundreds of megabytes: each is forgotten once it is read
        if error.tag != "error":
            continue
        frames = list(error.find("stack").iter("frame"))  # type: ignore[union-attr]
        if any(Path(frame.findtext("obj", "")).name == _KERNEL for frame in frames) and not _is_another_s(
            error.findtext("kind", ""), frames
        ):
            where = " < ".join(
                f"{frame.findtext('fn', '?')} ({frame.findtext('file', '?')}:{frame.findtext('line', '?')})" for frame in frames[:6]
            )
            reports.append(f"{error.findtext('kind')}: {where}")
        error.clear()
    return reports


def _is_another_s(kind: str, frames: Sequence[Xml.Element]) -> bool:
    """Whether a leak is of memory that the interpreter took for itself, as for names, or the loader, for a thread's variables."""
    takers = (Path(frame.findtext("obj", "")).name for frame in frames)
    taker = next((name for name in takers if not name.startswith("vgpreload")), "")
    return kind.startswith("Leak") and taker.startswith(("python", "libpython", "ld-linux"))
