"""By what measurements are known: other programs, libraries, cases and settings have other names, and nothing else has."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path
from unittest import mock

from judge.ways import BOUNDS, WAYS, told

from isomortar.harness import case, store
from isomortar.harness.cases import Case, Cell

#: Files of a package, and whether the numbers of all cases depend on them.
FILES = {
    "errors.py": True, "solve/newton.py": True, "scene/bundled/press.toml": True, "model/deep/er.py": True, "solve/notes.txt": False,
    "harness/compare.py": False, "cli/commands.py": False, "accuracy/measures.py": False, "program/own.py": False, "trade/want.py": False,
}  # fmt: skip


def package_key(folder: Path) -> str:
    """Hash of a package in a folder."""
    aside = tuple(folder / path.name for path in store._ASIDE)
    with mock.patch.multiple(store, _PACKAGE=folder, _ASIDE=aside, linked=list, versions=dict):
        return store.package_hash.__wrapped__()


@case(
    claim="A measurement is known by the sources of the package, by settings, and by the text of its case and of what that imports; what "
    "stands aside does not count.",
    tier="gate",
    grid={"way": WAYS},
    bounds=BOUNDS,
)
def keys(way: str) -> dict[str, float]:
    """How many changes are not seen, or are and should not be."""
    wrong = []
    with tempfile.TemporaryDirectory() as name:
        package = Path(name).resolve() / "package"
        for file in FILES:
            (package / file).parent.mkdir(parents=True, exist_ok=True)
            (package / file).write_text(file)
        before = package_key(package)
        for file, counts in FILES.items():
            (package / file).write_text(f"{file} #")
            wrong += [file] * ((package_key(package) != before) != counts)
            (package / file).write_text(file)
        wrong += ["the same package"] * (package_key(package) != before)
        with mock.patch.multiple(store, kernel_hash=lambda: "one kernel", package_hash=lambda: "one package"):
            same = store.program_hash.__wrapped__()
            for part in ("kernel_hash", "package_hash"):
                with mock.patch.object(store, part, return_value="another"):
                    wrong += [part] * (store.program_hash.__wrapped__() == same)
        texts = {"same": ("import helper", "x = 1"), "other case": ("import helper ", "x = 1"), "other helper": ("import helper", "x = 2")}
        found: dict[str, str] = {}
        binaries: list[str] = []
        for what, (text, helper) in {"first": texts["same"], **texts}.items():
            root = Path(name).resolve() / what.replace(" ", "_")
            (root / "family").mkdir(parents=True)
            (root / "family/some.py").write_text(text)
            (root / "helper.py").write_text(helper)
            of = Case(dict, "It holds.", {}, "gate", {}, None, ())
            vars(of)["path"], vars(of)["name"] = root / "family/some.py", "family/some"
            (root / "kernel.so").write_text(what)
            beside = replace(of, files=(root / "kernel.so",))
            vars(beside).update(vars(of) | {"files": beside.files})
            binaries.append(store.cell_key(Cell(beside, {}), "program"))
            cells = {"": Cell(of, {}), " with k=1": Cell(of, {"k": 1}), " with k=2": Cell(of, {"k": 2}), " with l=1": Cell(of, {"l": 1})}
            found |= {f"{what}{also}": store.cell_key(cell, "program") for also, cell in cells.items()}
            found[f"{what} by another program"] = store.cell_key(cells[""], "another")
        wrong += [what for what, key in found.items() if what.startswith("same") and key != found[f"first{what[4:]}"]]
        wrong += ["files beside"] * (len({*binaries, *found.values()}) != len(binaries) + len(found) * 3 // 4)
        wrong += ["keys that are alike"] * (len(set(found.values())) != len(found) * 3 // 4)
    return told(wrong, way)
