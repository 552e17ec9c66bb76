"""Every argument of the kernel's interface is told of: in the comment of its routine, or at the head of its file."""

import re
from pathlib import Path

import pytest

API = Path(__file__).parents[2] / "fortran" / "api"
FILES = sorted(API.glob("*_api.f90"))
ROUTINE = re.compile(r"((?:^!>.*\n)+)^(?:\w+ )*?subroutine (\w+)\(([^)]*)\)", re.MULTILINE)


def routines() -> list[tuple[str, str, tuple[str, ...], frozenset[str]]]:
    """File, name and arguments of each routine, and what stands in backticks above it or at the head of the file."""
    found = []
    for path in FILES:
        text = path.read_text()
        head = re.match(r"(?:!(?!>).*\n)*", text)[0]
        for comment, name, arguments in ROUTINE.findall(text):
            told = frozenset(re.findall(r"`(\w+)`", head + comment))
            found.append((path.name, name, tuple(re.findall(r"\w+", arguments)), told))
    return found


@pytest.mark.parametrize(("file", "name", "arguments", "told"), routines(), ids=lambda value: value if isinstance(value, str) else "")
def test_every_argument_is_told_of(file, name, arguments, told):
    assert [argument for argument in arguments if argument not in told] == [], f"{file}: {name}"


def test_no_routine_is_missed():
    counted = sum(len(re.findall(r"^(?!end).*\bsubroutine \w+\(", path.read_text(), re.MULTILINE)) for path in FILES)
    assert len(routines()) == counted > 20


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_what_is_told_of_is_an_argument(path):
    """A name left over from an argument that is gone."""
    text = path.read_text()
    own = {argument for file, _, arguments, _ in routines() if file == path.name for argument in arguments}
    names = set(re.findall(r"subroutine (\w+)", "".join(other.read_text() for other in FILES)))
    told = {name for line in text.splitlines() if line.startswith("!") for name in re.findall(r"`(\w+)`", line)}
    assert told - own - names == set()
