"""A start of a working copy finds its Python compiled."""

import subprocess
import sys
from pathlib import Path

import pytest

import isomortar

SOURCES = Path(isomortar.__file__).parent


def test_a_start_compiles_nothing():
    if not SOURCES.is_relative_to(Path(__file__).parents[2]):
        pytest.skip("an installed package is compiled by its installer")
    said = subprocess.run(
        [sys.executable, "-v", "-c", "import isomortar.cli.commands, isomortar.march.simulation"],
        capture_output=True,
        text=True,
        check=True,
    ).stderr
    taken = [line for line in said.splitlines() if line.startswith("# code object from") and str(SOURCES) in line]
    compiled = [line for line in taken if "__pycache__" not in line]
    assert len(taken) > 20
    assert not compiled
