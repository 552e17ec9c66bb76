"""Every sentence between a scene file and the kernel has an example in `sentences.toml`, which other tests hear, or stands on a page."""

from __future__ import annotations

import ast
import os
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
from told.word_by_word import SENTENCES

import isomortar
import test_refusals
import test_sentences

PACKAGE = Path(isomortar.__file__).parent
DOCS = Path(__file__).parents[2] / "docs"
#: Folders whose sentences are looked at, and how many spaces make one.
LAYERS, SPACES = ("geometry", "march", "model", "results", "scene", "solve", "told"), 4
#: What is filled in is not longer than this.
GAP = ".{0,200}"
#: Sentences without an example: they are not said to people, or are about what a test can not bring about.
UNSAID = {
    "bodies of the scene are missing": "of a file that is told to be damaged",
    "body  has no volume": "of a file that is told to be damaged",
    "pressures of contact  are not finite": "of a file that is told to be damaged",
    "a general system has found it singular": "an assertion",
}
#: Where else sentences are read by people.
PAGES = ("method.md", "results.md")


def sentences(source: str) -> Iterator[list[str]]:
    """Every text of a source that is a sentence, by its parts between what is filled in; documentation is none."""
    tree = ast.parse(source)
    aside = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    aside |= {id(value) for node in ast.walk(tree) if isinstance(node, ast.JoinedStr) for value in node.values}
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            parts = [str(value.value) for value in node.values if isinstance(value, ast.Constant)]
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in aside:
            parts = re.split(r"\{[^}]*\}", node.value)
        else:
            continue
        if "".join(parts).count(" ") >= SPACES:
            yield parts


def _of_layers() -> dict[Path, list[list[str]]]:
    paths = sorted(path for layer in LAYERS for path in (PACKAGE / layer).rglob("*.py"))
    return {path: found for path in paths if (found := list(sentences(path.read_text())))}


def _heard() -> dict[str, dict[str, str]]:
    return tomllib.loads(SENTENCES.read_text(encoding="utf-8"))


@pytest.mark.parametrize(("path", "found"), _of_layers().items(), ids=lambda value: value.stem if isinstance(value, Path) else "")
def test_every_sentence_has_an_example(path: Path, found: list[list[str]]) -> None:
    examples = [sentence for kind in _heard().values() for sentence in kind.values()]
    examples += [" ".join((DOCS / name).read_text().split()) for name in PAGES]
    for parts in found:
        if "".join(parts) not in UNSAID:
            shape = re.compile(GAP.join(re.escape(part) for part in parts), re.DOTALL | re.IGNORECASE)
            assert any(shape.search(example) for example in examples), f"{os.path.relpath(path, PACKAGE)}: {'…'.join(parts)}"


def test_what_is_unsaid_stands_in_the_sources_and_what_is_heard_is_tested() -> None:
    assert UNSAID.keys() <= {"".join(parts) for found in _of_layers().values() for parts in found}
    kinds = {kind.__name__ for kind in (*test_sentences.KINDS, *test_refusals.KINDS)}
    assert kinds | test_sentences.OF_SCENES.keys() | {"given_up"} == _heard().keys()
