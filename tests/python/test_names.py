"""A class or a type has a name of its own in the package: a word that stands for two things is read for the other one."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

PACKAGE = Path(__file__).parents[2] / "python" / "isomortar"
#: Arrays by the type of their entries, the same wherever a layer that imports nothing has to say it.
SAME = {"FloatArray", "IntArray", "LongArray"}


def types_of(path: Path) -> Iterator[str]:
    """Public classes and aliases of types that a file defines."""
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ClassDef):
            yield node.name
        targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) else []
        yield from (t.id for t in targets if isinstance(t, ast.Name) and t.id[:1].isupper() and not t.id.isupper())


def test_no_type_is_called_like_another_one() -> None:
    places = defaultdict(list)
    for path in sorted(PACKAGE.rglob("*.py")):
        for name in types_of(path):
            places[name].append(str(path.relative_to(PACKAGE)))
    assert len(places) > 200, "all of the package was looked at"
    assert {name: where for name, where in places.items() if len(where) > 1 and name not in SAME and not name.startswith("_")} == {}
