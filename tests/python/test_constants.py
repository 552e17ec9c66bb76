"""What decides how a computation goes, beside its settings, stands in one place with its reason, and is in use."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

import isomortar
from isomortar.model import constants

PACKAGE = Path(isomortar.__file__).parent
PLACE = PACKAGE / "model" / "constants.py"
#: Modules that refuse, warn or explain, as all of told/ do: their thresholds stand with their sentences.
JUDGES = {"checks", "contact_checks", "free_motions", "layers", "magnitudes", "memory", "rational", "singular", "stance"}
#: Numbers that stand for something else.
CODES = {"RECENT", "_FAMILY_CODE", "_NO_SLIP", "_SLIPS_AT_POLE"}
NAMES = [name for name in vars(constants) if name.isupper()]


def numbers_of(path: Path) -> list[str]:
    """Names that a module gives to numbers."""
    found = []
    for statement in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(statement, ast.Assign | ast.AnnAssign) and statement.value is not None:
            values = statement.value.values if isinstance(statement.value, ast.Dict) else [statement.value]
            leaves = [type(leaf.value) for value in values for leaf in ast.walk(value) if isinstance(leaf, ast.Constant)]
            targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
            names = [name.id for target in targets for name in ast.walk(target) if isinstance(name, ast.Name)]
            found += [name for name in names if {int, float} & set(leaves) and name.isupper()]
    return found


def test_numbers_that_decide_have_one_place() -> None:
    modules = [path for folder in ("march", "model", "solve") for path in (PACKAGE / folder).rglob("*.py") if path.stem not in JUDGES]
    elsewhere = {path.name: names for path in modules if path != PLACE and (names := [n for n in numbers_of(path) if n not in CODES])}
    assert elsewhere == {}
    assert sorted(numbers_of(PLACE)) == sorted(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_each_has_a_meaning_and_a_use(name: str) -> None:
    said = re.search(rf"((?:^#:.*\n)+){name} = ", PLACE.read_text(encoding="utf-8"), re.MULTILINE)
    assert said, "a comment #: above it says what it is and why"
    assert len(said[1].split()) > 12
    assert any(f"constants.{name}" in path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.py"))
