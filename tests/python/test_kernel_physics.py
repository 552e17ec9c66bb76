"""The kernel's modules, each called directly by a test in Fortran (tests/fortran), with run-time checks compiled in."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from isomortar import _compiled, _kernel

PROJECT = Path(__file__).parents[2]
SUBJECTS = sorted(path.stem.removeprefix("test_") for path in (PROJECT / "tests" / "fortran").glob("test_*.f90"))


@pytest.fixture(scope="module")
def build() -> Path:
    """The debug build, up to date."""
    subprocess.run(["bash", str(PROJECT / "tools" / "build_debug.sh")], check=True, capture_output=True, text=True)
    return PROJECT / "build" / "debug"


@pytest.fixture(scope="module")
def program(build: Path) -> Path:
    """The executable of all subjects."""
    return build / "tests" / "fortran" / "physics"


@pytest.mark.parametrize("subject", SUBJECTS)
def test_physics(program: Path, subject: str) -> None:
    done = subprocess.run([str(program), subject], capture_output=True, text=True, check=False)
    said = done.stdout.splitlines()
    assert [line for line in said if not line.startswith("ok ")] == []
    assert done.returncode == 0, done.stderr
    assert len(said) > 3


def test_a_subject_that_there_is_not(program: Path) -> None:
    done = subprocess.run([str(program), "alchemy"], capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert "no such subject" in done.stderr


def test_a_broken_contract_ends_with_its_sentence(build: Path) -> None:
    done = subprocess.run([str(build / "tests/fortran/broken_contract")], capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert "contract broken: new_direction: knots do not fall" in done.stderr


def test_contracts_are_in_the_debug_build_alone(build: Path) -> None:
    debug = (build / "fortran" / Path(str(_kernel.__file__)).name).read_bytes()
    assert b"contract broken" in debug
    release = Path(_compiled.kernel.__file__).read_bytes()
    assert [words for words in (b"contract broken", b"knots do not fall", b"it is a unit vector") if words in release] == []
