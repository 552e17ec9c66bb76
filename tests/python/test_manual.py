"""Every block of the manual runs, its pages are built without a warning, and what fails is named."""

from __future__ import annotations

import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def manual() -> ModuleType:
    """The script that builds it, as a module."""
    spec = importlib.util.spec_from_file_location("build_manual", ROOT / "tools" / "build_manual.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["build_manual"] = module
    spec.loader.exec_module(module)
    return module


def test_the_manual_is_built_of_blocks_that_run(tmp_path: Path) -> None:
    script = [sys.executable, str(ROOT / "tools" / "build_manual.py"), str(tmp_path / "manual")]
    ended = subprocess.run(script, env={**os.environ, "OMP_NUM_THREADS": "1"}, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    html = tmp_path / "manual" / "html"
    tutorial = (html / "tutorial.html").read_text(encoding="utf-8")
    assert "load steps done, 0 warnings" in tutorial, "what a block prints is on the page"
    pictures = re.findall(r'<img alt="[^"]+" src="([^"]+)"', tutorial)
    assert len(pictures) == 4
    assert all((html / picture).stat().st_size > 10_000 for picture in pictures)
    count = re.search(r"(\d+) blocks run", ended.stdout)
    assert count is not None
    assert int(count[1]) > 20


@pytest.mark.parametrize(
    ("block", "word"),
    [
        ("python\n1 / 0\n", "ZeroDivisionError"),
        ("sh\nfalse\ntrue\n", "exit code 1"),
        ("sh\nisomortar run nothing.toml\n", "nothing.toml"),
        ("toml\nformat = 1\n", "no comment # NAME.toml"),
    ],
)
def test_a_block_that_fails_is_named(manual: ModuleType, tmp_path: Path, block: str, word: str) -> None:
    page = tmp_path / "page.txt"
    page.write_text(f"# A page\n\n```sh\necho first\n```\n\nand\n\n```{block}```\n", encoding="utf-8")
    with pytest.raises(manual.BlockError, match=rf"page\.txt, line 10: (?s:.)*{re.escape(word)}"):
        manual.run_page(page)


def test_blocks_of_a_page_share_a_folder_and_what_they_print_follows_them(manual: ModuleType, tmp_path: Path) -> None:
    page = tmp_path / "page.txt"
    page.write_text(
        "```toml\n# here.toml\na = 1\n```\n\n```python\nprint(open('here.toml').read())\n```\n\n```text\nfalse\n```\n", encoding="utf-8"
    )
    assert manual.run_page(page) == (2, None)
    assert "```text\n# here.toml\na = 1\n```\n\n```text\nfalse\n```\n" in page.read_text(encoding="utf-8")


def test_formulas_have_no_line_breaks_that_sphinx_would_wrap() -> None:
    theory = (ROOT / "docs" / "theory.md").read_text(encoding="utf-8")
    wrapped = [formula for formula in re.findall(r"\$\$(.*?)\$\$", theory, re.DOTALL) if "\\\\" in formula]
    assert not wrapped, "with \\\\ Sphinx puts them into a split, where MathJax allows no tag: write \\cr"
