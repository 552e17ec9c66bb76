"""The theory page and the sources name each other: every equation its procedures, every citation an equation."""

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
    """Names of the procedures of a Fortran or Python file."""
    pattern = r"^\s*def (\w+)" if path.suffix == ".py" else r"^[^!\n]*\b(?:function|subroutine) (\w+)"
    return set(re.findall(pattern, path.read_text(encoding="utf-8"), re.MULTILINE))


def test_equations_are_numbered_without_gaps():
    counts = [sum(number.split(".")[0] == section for number in EQUATIONS) for section in SECTIONS]
    assert all(counts)
    assert [str(k + 1) for k in range(len(SECTIONS))] == SECTIONS
    assert [f"{k + 1}.{n + 1}" for k, count in enumerate(counts) for n in range(count)] == EQUATIONS


def test_every_equation_has_one_row_with_a_source():
    assert [number for number, _, _ in ROWS] == EQUATIONS
    assert all(source.strip() for _, _, source in ROWS)


@pytest.mark.parametrize(("number", "where"), [(number, where) for number, where, _ in ROWS], ids=EQUATIONS)
def test_every_equation_names_procedures_that_exist(number, where):
    files = re.findall(r"\[([\w.]+)\]\(\.\./([\w/.]+)\)([^\[]*)", where)
    assert files
    for shown, path, rest in files:
        assert Path(path).name == shown
        named = set(re.findall(r"`(\w+)`", rest))
        assert named, f"equation {number} names no procedure of {path}"
        assert named <= procedures(ROOT / path), f"equation {number}: {path} has no {named - procedures(ROOT / path)}"


def test_the_page_refers_to_its_own_equations():
    within = re.findall(r"(?<!paper )\((\d\.\d+)\)", re.sub(r"^\|.*$|\$\$.*?\$\$", "", TEXT, flags=re.MULTILINE | re.DOTALL))
    papers = {"2.16", "2.17", "2.18", "2.12"}  # of the paper's equations, named as such in the text
    assert within
    assert set(within) - set(EQUATIONS) <= papers


def test_every_citation_of_the_theory_exists():
    known = {*EQUATIONS, *SECTIONS}
    wrong = [f"{path.relative_to(ROOT)}: theory {n}" for path in SOURCES for n in cited(path.read_text(encoding="utf-8")) if n not in known]
    assert not wrong
