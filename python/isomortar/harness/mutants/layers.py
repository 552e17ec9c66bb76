"""Where faults are put: the kernel's sources, and the Python between a scene file and the kernel."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path, PurePath

from isomortar._frozen import frozen
from isomortar.errors import InputError


@frozen
class Layer:
    """Sources that faults are put into.

    Parameters
    ----------
    name : str
    folder : Path
        Where the sources stand in a checkout.
    suffix : str
        Of their files.
    parts : tuple of str
        Folders below it that get faults.
    left_out : dict of str to str
        Files that get none, by the path below the folder, and why.
    rules : str
        The rules of universalmutator for the language.
    ignored : tuple of str
        Patterns of lines that compute nothing.
    least_share : float
        Share of the random faults, without those classified as equivalent, that must be caught.
    """

    name: str
    folder: Path
    suffix: str
    parts: tuple[str, ...]
    left_out: dict[str, str]
    rules: str
    ignored: tuple[str, ...]
    least_share: float

    def read(self, root: Path) -> dict[str, str]:
        """Text of every source that faults are put into, by its path below the folder.

        Raises
        ------
        InputError
            No such sources in the checkout at `root`.
        """
        folder = root / self.folder
        paths = sorted(path for part in self.parts for path in (folder / part).rglob(f"*{self.suffix}"))
        found = {path.relative_to(folder).as_posix(): path.read_text() for path in paths}
        if not found:
            raise InputError(f"there are none in {folder}: faults are planted in a checkout, from its folder", "sources")
        return {file: text for file, text in found.items() if file not in self.left_out}

    def within(self, sources: Mapping[str, str], paths: Sequence[str]) -> dict[str, str]:
        """Those of the sources that are one of `paths` or stand below it; all of them where there are no paths.

        Raises
        ------
        InputError
            One of `paths` is no source that faults are put into, and no folder of some.
        """
        places = {path: [file for file in sources if PurePath(file).is_relative_to(path)] for path in paths}
        for path, files in places.items():
            if not files:
                raise InputError(
                    f"is {path!r}: no file or folder in {self.folder} that faults are put into; an example: {next(iter(sources))}", "within"
                )
        wanted = {file for files in places.values() for file in files}
        return {file: text for file, text in sources.items() if not paths or file in wanted}


LAYERS = {
    layer.name: layer
    for layer in (
        Layer(
            name="kernel",
            folder=Path("fortran"),
            suffix=".f90",
            parts=("api", "base", "contact", "nurbs", "solid", "sparse"),
            left_out={
                "base/contract.f90": "for debug builds alone",
                "base/contract_checked.f90": "for debug builds alone",
                "base/predicate.f90": "for debug builds alone: what contracts say",
                "base/kinds.f90": "names of kinds",
                "base/kinds_extended.f90": "names of kinds",
                "base/status.f90": "names of status codes: any numbers do",
                "sparse/cholmod.f90": "declarations of a C library",
                "sparse/umfpack.f90": "declarations of a C library",
                "sparse/ranks.f90": "of the engine mumps, which not every build has",
                "sparse/mumps.f90": "of the engine mumps, which not every build has",
                "sparse/distributed.f90": "of the engine mumps, which not every build has",
                "api/mumps_api.f90": "of the engine mumps, which not every build has",
                "api/assembled.f90": "of the extended-precision twin alone",
                "api/difference.f90": "of the extended-precision twin alone",
                "api/extended_api.f90": "of the extended-precision twin alone",
                "api/precision_api.f90": "what a kernel says about itself",
            },
            rules="fortran.rules",
            # Comments, contracts (for debug builds), ends of blocks, headings, declarations that give no value.
            ignored=(
                r"^\s*(!|&?\s*$|if \(contracts\b)",
                r"^\s*(use|implicit|private|public|module|end|contains|type|else|return|cycle|exit)\b",
                r"::(?!.*=)",
            ),
            least_share=0.95,
        ),
        Layer(
            name="python",
            folder=Path("python/isomortar"),
            suffix=".py",
            parts=("accuracy", "geometry", "march", "model", "results", "scene", "solve", "told", "trade"),
            left_out={
                "results/style.py": "colours and sizes of figures",
                "trade/figures.py": "figures of a page",
                "trade/page.py": "sentences of a page",
            },
            rules="python.rules",
            ignored=(r"^\s*(#|@|$)", r"^\s*(from|import|class)\b"),
            least_share=0.85,
        ),
    )
}
