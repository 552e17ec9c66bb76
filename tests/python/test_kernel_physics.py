"""The kernel's modules, each called directly by a test in Fortran (tests/fortran), with run-time checks compiled in."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

PROJECT = Path(__file__).parents[2]
SUBJECTS = sorted(path.stem.removeprefix("test_") for path in (PROJECT / "tests" / "fortran").glob("test_*.f90"))


@pytest.fixture(scope="module")
def program() -> Path:
    """The executable, built where it is not up to date."""
    subprocess.run(["bash", str(PROJECT / "tools" / "build_debug.sh")], check=True, capture_output=True, text=True)
    return PROJECT / "build" / "debug" / "tests" / "fortran" / "physics"


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
