"""The layers of the kernel: each uses those below it, and a module is named by its path."""

import re
from pathlib import Path

import pytest

FORTRAN = Path(__file__).parents[2] / "fortran"
FILES = sorted(FORTRAN.rglob("*.f90"))

#: The layers that each layer may use besides itself.
BELOW = {
    "base": set(),
    "nurbs": {"base"},
    "sparse": {"base"},
    "solid": {"base", "nurbs", "sparse"},
    "contact": {"base", "nurbs", "sparse"},
    "api": {"base", "nurbs", "sparse", "solid", "contact"},
}


def test_every_layer_is_known():
    assert {path.relative_to(FORTRAN).parts[0] for path in FILES} == set(BELOW)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.relative_to(FORTRAN).as_posix())
def test_file_uses_only_layers_below(path):
    layer = path.relative_to(FORTRAN).parts[0]
    used = set(re.findall(r"^\s*use isomortar_([a-z]+)_", path.read_text(), re.MULTILINE))
    assert used <= BELOW[layer] | {layer}


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.relative_to(FORTRAN).as_posix())
def test_module_is_named_by_its_path(path):
    names = re.findall(r"^module (\w+)", path.read_text(), re.MULTILINE)
    # Files that take another's place bear its module's name: other kinds, checked contracts. API files are bare subroutines.
    stem = path.stem.removesuffix("_extended").removesuffix("_checked")
    wanted = "_".join(["isomortar", *path.relative_to(FORTRAN).parent.parts, stem])
    assert names == ([] if path.stem.endswith("_api") else [wanted])


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.relative_to(FORTRAN).as_posix())
def test_every_parallel_loop_says_of_each_variable_whether_threads_share_it(path):
    joined = re.sub(r"&\s*\n\s*!\$omp", "", path.read_text(), flags=re.IGNORECASE)
    regions = re.findall(r"^\s*!\$omp\s+(?!end\b)(.*\b(?:parallel|task|taskloop|teams)\b.*)$", joined, re.MULTILINE | re.IGNORECASE)
    assert all(re.search(r"\bdefault\s*\(\s*none\s*\)", region, re.IGNORECASE) for region in regions), regions


def test_a_contract_is_one_line_that_names_its_procedure():
    """One line, so that faults are not planted in what the product leaves out; a name that the file has, or a reader looks in vain."""
    wrong, count = [], 0
    for path in FILES:
        text = path.read_text()
        if path.name.startswith("contract"):
            continue
        procedures = set(re.findall(r"^ *(?!end )[^!\n]*\b(?:function|subroutine) (\w+)", text, re.MULTILINE))
        for line in (line for line in text.splitlines() if "require(" in line):
            count += 1
            found = re.fullmatch(r' *if \(contracts\b.*\) call require\(.*, "(\w+): .+"\)', line)
            if not found or found[1] not in procedures:
                wrong.append(f"{path.relative_to(FORTRAN)}: {line.strip()}")
    assert not wrong, "\n".join(wrong)
    assert count > 80
