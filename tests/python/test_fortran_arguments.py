"""Every argument of the kernel's public procedures is told of, in the comment of its procedure or at the head of its file.

In backticks, with the shape behind it where the declaration leaves that open: `rows` (3, kinds, blocks).
"""

import re
from dataclasses import dataclass
from pathlib import Path

import pytest

FORTRAN = Path(__file__).parents[2] / "fortran"
FILES = sorted(FORTRAN.rglob("*.f90"))
HEADING = re.compile(
    r"\s*(?:(?:pure|elemental|recursive|integer|real|logical|type|class)(?:\([^)]*\))? +)*(?:subroutine|function) (\w+)\(([^)]*)\)"
)
ENTITY = re.compile(r"(\w+)(?:\(((?:[^()]|\([^()]*\))*)\))?")


def statements(path: Path) -> list[str]:
    """Its lines, continued ones joined."""
    return re.sub(r"&\n\s*&?", "", path.read_text()).splitlines()


def names(text: str) -> set[str]:
    return set(re.findall(r"\w+", text))


def head(path: Path) -> str:
    """Comments before the module, or before what is said of the first routine."""
    text = path.read_text()
    bare = not re.search(r"^module ", text, re.MULTILINE)
    return re.match(r"(?:!(?!>).*\n)*" if bare else r"(?:!.*\n)*", text)[0]


@dataclass
class Procedure:
    """A procedure with its arguments, how many dimensions of each have no extent, and what stands above it."""

    file: str
    name: str
    arguments: dict[str, int]
    comment: str


def open_dimensions(declared: str) -> int:
    """Of a declared shape, where its extents are left open: its rank; else 0."""
    sizes = re.split(r",(?![^(]*\))", declared)
    return len(sizes) if any(size.strip().endswith(":") for size in sizes) else 0


def procedures(path: Path) -> list[Procedure]:
    """All of a file."""
    lines, found = statements(path), []
    for k, line in enumerate(lines):
        if not (heading := HEADING.match(line)):
            continue
        first = k
        while first and lines[first - 1].lstrip().startswith("!>"):
            first -= 1
        shapes = dict.fromkeys(re.findall(r"\w+", heading[2]), 0)
        for declaration in lines[k + 1 :]:
            if declaration.lstrip().startswith("end "):
                break
            attributes, colons, entities = declaration.partition("::")
            if not colons or "intent" not in attributes:
                continue
            common = re.search(r"dimension\(([^)]*)\)", attributes)
            for name, declared in ENTITY.findall(entities):
                if name in shapes:
                    shapes[name] = open_dimensions(declared or (common[1] if common else ""))
        shapes.pop("self", None)
        found.append(Procedure(path.name, heading[1], shapes, "\n".join(lines[first:k])))
    return found


def public(path: Path) -> set[str]:
    """Names of its procedures that others can call: all of a file without a module; those bound to types, too."""
    lines = statements(path)
    if not any(line.startswith("module ") for line in lines):
        return {procedure.name for procedure in procedures(path)}
    found = set()
    for line in lines:
        if told := re.match(r"\s*public :: (.*)", line):
            found |= names(told[1])
        elif told := re.match(r"\s*procedure(?:\((\w+)\))?[^:]*:: (.*)|\s*(?:module )?procedure ([^:]*)$", line):
            found |= {told[1]} if told[1] else names((told[2] or told[3]).split("=>")[-1])
    return found


def parents(path: Path) -> str:
    """Comments of the files that declare the types that those of this one extend: they tell of what is overridden."""
    extended = set(re.findall(r"extends\((\w+)\)", path.read_text()))
    declaring = [
        one for one in FILES if any(re.search(rf"^\s*type, abstract.*:: {name}$", one.read_text(), re.MULTILINE) for name in extended)
    ]
    return "\n".join(head(one) + "\n".join(procedure.comment for procedure in procedures(one)) for one in declaring)


#: All words of the code, and files that comments name without their endings.
CODE = names("\n".join(line.partition("!")[0] for path in FILES for line in statements(path))) | {"contract_checked"}
#: Names and arguments of a C library are told of in its own documentation.
LEFT_OUT = FORTRAN / "sparse" / "umfpack.f90"
PUBLIC = [(path, procedure) for path in FILES if path != LEFT_OUT for procedure in procedures(path) if procedure.name in public(path)]


@pytest.mark.parametrize(
    ("path", "procedure"), PUBLIC, ids=lambda value: str(value.relative_to(FORTRAN)) if isinstance(value, Path) else value.name
)
def test_every_argument_is_told_of(path, procedure):
    told = head(path) + procedure.comment + parents(path)
    untold = [name for name in procedure.arguments if f"`{name}`" not in told]
    assert untold == [], f"{path}: {procedure.name}"
    for name, rank in procedure.arguments.items():
        shapes = re.findall(rf"`{name}` \(([^)]*)\)", told)
        assert not rank or rank in {shape.count(",") + 1 for shape in shapes}, f"{path}: {procedure.name}: the shape of {name}"


def test_no_procedure_is_missed():
    counted = sum(
        len(re.findall(r"^(?!\s*(?:end|!)).*\b(?:subroutine|function) \w+\(", "\n".join(statements(path)), re.MULTILINE)) for path in FILES
    )
    assert sum(len(procedures(path)) for path in FILES) == counted
    assert len(PUBLIC) > 200


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(FORTRAN)))
def test_what_is_told_of_is_there(path):
    """No name in backticks is left over: in a list from an argument that is gone, else from anything that is in no code."""
    own = {name for procedure in procedures(path) for name in procedure.arguments}
    for line in path.read_text().splitlines():
        if line.lstrip().startswith("!"):
            listed = re.findall(r"`(\w+)`[^:.]*:", line) if line.lstrip("!> ").startswith("- `") else []
            assert {name for name in listed if name not in own} == set(), line
            assert set(re.findall(r"`(\w+)`", line)) - CODE == set(), line


def test_which_dimensions_are_open():
    assert [open_dimensions(declared) for declared in (":, :", ":, 0:, 0:", "0:self%order, 0:derivatives", "3, size(x, 1)", "")] == [
        2,
        3,
        0,
        0,
        0,
    ]
