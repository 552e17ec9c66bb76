"""The theory page and the sources name each other: every equation its procedures, every citation an equation."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "theory.md"
TEXT = PAGE.read_text(encoding="utf-8")
#: Numbers of equations in their order; rows of the tables: number, procedures, source.
EQUATIONS = re.findall(r"\\tag\{(\d+\.\d+)\}", TEXT)
ROWS = re.findall(r"^\| (\d+\.\d+) \| (.+) \| (.+) \|$", TEXT, re.MULTILINE)
SECTIONS = re.findall(r"^## (\d+)\. ", TEXT, re.MULTILINE)
SOURCES = sorted(
    path
    for folder, suffix in (("fortran", "f90"), ("python", "py"), ("verification", "py"), ("tests", "py"), ("tools", "py"))
    for path in (ROOT / folder).rglob(f"*.{suffix}")
    if path != Path(__file__)
)
#: "theory 4", "theory 4.3", "theory 4.3, 4.5 and 4.7 to 4.9".
CITATION = re.compile(r"\btheory (\d+(?:\.\d+)?(?:(?:, | and | to )\d+(?:\.\d+)?)*)")


def cited(text):
    """Numbers of sections and equations that a text cites."""
    return [number for found in CITATION.findall(text) for number in re.findall(r"\d+(?:\.\d+)?", found)]


def procedures(path):
    """What is said of each procedure of a Fortran or Python file: the comment above it, or its docstring."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        functions = (node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef))
        return {function.name: ast.get_docstring(function) or "" for function in functions}
    said = re.findall(r"((?:^ *!>.*\n)*)^(?! *end )[^!\n]*\b(?:function|subroutine) (\w+)", text, re.MULTILINE)
    return {name: comment for comment, name in said}


def test_equations_are_numbered_without_gaps():
    counts = [sum(number.split(".")[0] == section for number in EQUATIONS) for section in SECTIONS]
    assert all(counts)
    assert [str(k + 1) for k in range(len(SECTIONS))] == SECTIONS
    assert [f"{k + 1}.{n + 1}" for k, count in enumerate(counts) for n in range(count)] == EQUATIONS


def test_every_equation_has_one_row_with_a_source():
    assert [number for number, _, _ in ROWS] == EQUATIONS
    assert all(source.strip() for _, _, source in ROWS)


@pytest.mark.parametrize(("number", "where"), [(number, where) for number, where, _ in ROWS])
def test_equation_and_its_procedures_name_each_other(number, where):
    files = re.findall(r"\[([\w.]+)\]\(\.\./([\w/.]+)\)([^\[]*)", where)
    assert files
    for shown, path, rest in files:
        assert Path(path).name == shown
        named, there = set(re.findall(r"`(\w+)`", rest)), procedures(ROOT / path)
        assert named, f"equation {number} names no procedure of {path}"
        assert named <= there.keys(), f"{path} has no {named - there.keys()}"
        assert all(number in cited(there[name]) for name in named), f"{path}: {named} must each say (theory {number})"


def test_the_page_refers_to_its_own_equations():
    within = re.findall(r"(?<!paper )\((\d\.\d+)\)", re.sub(r"^\|.*$|\$\$.*?\$\$", "", TEXT, flags=re.MULTILINE | re.DOTALL))
    papers = {"2.16", "2.17", "2.18", "2.12"}  # of the paper's equations, named as such in the text
    assert within
    assert set(within) - set(EQUATIONS) <= papers


def test_every_citation_of_the_theory_exists():
    known = {*EQUATIONS, *SECTIONS}
    wrong = [f"{path.relative_to(ROOT)}: theory {n}" for path in SOURCES for n in cited(path.read_text(encoding="utf-8")) if n not in known]
    assert not wrong


def test_no_comment_cites_a_page_outside_of_the_repository():
    """Pages by name, sections of a page without its author and year, equations in brackets."""
    wrong = []
    for path in SOURCES:
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            pages = [p for p in re.findall(r"[\w./-]+\.md\b", line) if not any((base / p).is_file() for base in (ROOT, ROOT / "docs"))]
            sections = re.findall(r"\bSection \d", line) if not re.search(r"\b(?:1[89]|20)\d\d\b|\bpaper\b", line) else []
            brackets = re.findall(r"!.*(\[\d\.\d+\])", line) if path.suffix == ".f90" else []
            wrong += [f"{path.relative_to(ROOT)}:{number}: {what}" for what in pages + sections + brackets]
    assert not wrong, "\n".join(wrong)
