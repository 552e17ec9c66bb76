"""How a working copy finds the package: its Python where it lies, its kernel where it is built; first built, where a source has changed.

Set-up puts this beside the environment's packages, and every start of its Python imports it. meson-python's own loader, which builds
here, asks ninja each time and takes a good part of the standard library to do so: 17 ms of a start.
"""

import os
import sys
from collections.abc import Iterator
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path
from zlib import crc32

ROOT = Path(sys.prefix).parent
BUILD = ROOT / "build" / f"cp{sys.version_info.major}{sys.version_info.minor}"
#: What is built depends on the files in these folders, and on these files.
FOLDERS, FILES = ("fortran", "python", "tools"), ("meson.build", "meson.options")


def sources() -> str:
    """What tells one state of the sources from another: by their names, sizes and times. Empty: a file has gone while it was looked at."""
    try:
        found = [state for folder in FOLDERS for state in states(ROOT / folder)]
    except FileNotFoundError:
        return ""
    found += [(file, (ROOT / file).stat().st_size, (ROOT / file).stat().st_mtime_ns) for file in FILES]
    return str(crc32(repr(sorted(found)).encode()))


def states(folder: str | Path) -> Iterator[tuple[str, int, int]]:
    """Name, size and time of each file in a folder; of a link its own, as those that editors leave lead nowhere."""
    with os.scandir(folder) as entries:
        for entry in entries:
            if not entry.is_dir(follow_symlinks=False):
                found = entry.stat(follow_symlinks=False)
                yield entry.path, found.st_size, found.st_mtime_ns
            elif entry.name != "__pycache__":
                yield from states(entry.path)


class WorkingCopy:
    """Finds the package for Python's import."""

    def find_spec(self, name: str, *_: object) -> ModuleSpec | None:
        """Where the package is, after a build where there is something to build; None of others, and of what a build imports."""
        if name != "isomortar" or str(BUILD) in os.environ.get("MESONPY_EDITABLE_SKIP", "").split(os.pathsep):
            return None
        now, built = sources(), BUILD / "sources"
        if not now or not built.is_file() or now != built.read_text(encoding="ascii"):
            build()
            built.write_text(now, encoding="ascii")
        spec = PathFinder.find_spec(name, [str(ROOT / "python")])
        if spec is not None and spec.submodule_search_locations is not None:
            spec.submodule_search_locations.append(str(BUILD / "fortran"))
        return spec


def build() -> None:
    """Build what has changed.

    Raises
    ------
    ImportError
        The build fails; the compiler's words are its notes.
    OSError
        This account may not write to the working copy.
    """
    import _isomortar_editable_loader as loader

    loader.init()
    sys.meta_path.pop(0).find_spec("isomortar", None, None)


sys.meta_path.insert(0, WorkingCopy())
