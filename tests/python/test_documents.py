"""What documents name is there: files, headings, cases, commands and their options."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
from functools import cache
from pathlib import Path

import pytest
import typer.main

from isomortar.cli.commands import app

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
#: Folders of a checkout whose files documents name by their path.
FOLDERS = ("docs", "examples", "fortran", "python", "reference_data", "tests", "tools", "verification")
#: What stands in a path for a name of one's own.
OWN = re.compile(r"\b(NAME|FAMILY|SCENE|LAYER|FILE)\b")
#: Pictures and pages that the blocks of a page make when the manual is built.
MADE = re.compile(r"^\w+/results/")


pages = pytest.mark.parametrize("page", PAGES, ids=[str(page.relative_to(ROOT)) for page in PAGES])


@cache
def text(page: Path) -> str:
    return page.read_text(encoding="utf-8")


@cache
def headings(page: Path) -> set[str]:
    """The names by which links know the headings of a page."""
    found = re.findall(r"^#+ (.*)$", text(page), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in found}


@pages
def test_links_lead_somewhere(page: Path) -> None:
    prose = re.sub(r"```.*?```", "", text(page), flags=re.DOTALL)
    for link in re.findall(r"\]\(([^)\s]+)\)", prose):
        if "://" in link or MADE.match(link):
            continue
        path, _, heading = link.partition("#")
        target = Path(os.path.normpath(page.parent / path)) if path else page
        assert target.exists(), f"there is no {link}"
        assert not heading or target.suffix != ".md" or heading in headings(target), f"{link}: there is no such heading"


@pages
def test_files_that_are_named_are_there(page: Path) -> None:
    for path in re.findall(rf"`((?:{'|'.join(FOLDERS)})/[\w./-]*\w)`", text(page)):
        written = re.search(rf"`{re.escape(path)}` \(made ", text(page))
        assert written or list(ROOT.glob(OWN.sub("*", path))), f"there is no {path}"


@pages
def test_cases_that_are_named_are_there(page: Path) -> None:
    """As `family/name`, or behind `--case`."""
    for family, name in re.findall(r"(?:`|--case \"?)([a-z_]+)/([a-z_]+)(?:`|\b)", text(page)):
        folder = ROOT / "verification" / family
        if folder.is_dir():
            sources = "".join(text(path) for path in folder.rglob("*.py"))
            assert re.search(rf"^def {name}\b", sources, re.MULTILINE), f"family {family} has no case {name}"


def commands(page: Path) -> list[str]:
    """Lines that are commands of the program, in blocks and in the running text."""
    lines = re.findall(r"^(?: {4})?(?:\.venv/bin/)?(isomortar [a-z].*)$", text(page), re.MULTILINE)
    return [*lines, *re.findall(r"`(isomortar [a-z-]+[^`]*)`", text(page))]


@pages
def test_commands_have_the_options_that_are_shown(page: Path) -> None:
    for line in commands(page):
        try:
            words = shlex.split(line, comments=True)[1:]
        except ValueError:  # a sentence with an apostrophe
            continue
        command = typer.main.get_command(app)
        while words and words[0] in getattr(command, "commands", {}):
            command, words = command.commands[words[0]], words[1:]  # type: ignore[attr-defined]
        known = {option for parameter in command.params for option in (*parameter.opts, "--help", "-h", "--install-completion")}
        shown = {word.partition("=")[0] for word in words if re.fullmatch(r"--?[a-z][a-z-]*(=.*)?", word)}
        assert shown <= known, f"{line}: {command.name} has no {', '.join(sorted(shown - known))}"


def test_runs_that_the_readme_shows_can_be_run_one_after_the_other() -> None:
    """A file of results that exists is an error: `run press --cost` came behind `run press`, and `run iron` behind `make demo`."""
    begun = {"iron"}  # by make demo
    for line in commands(ROOT / "README.md"):
        _, command, *words = shlex.split(line, comments=True)
        if command == "run" and not {"--overwrite", "--resume", "--help", "--output"} & set(words):
            assert words[0] not in begun, f"{line}: results/{words[0]}.h5 is there already"
            begun.add(words[0])


def test_make_tells_all_that_it_makes() -> None:
    told = subprocess.run(["make", "help"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    makefile = text(ROOT / "Makefile")
    targets = re.search(r"^\.PHONY: (.*)$", makefile, re.MULTILINE)
    assert targets is not None
    assert set(re.findall(r"^  make (\S+)", told, re.MULTILINE)) == set(targets[1].split())
    for page in PAGES:
        assert set(re.findall(r"(?:`|^ {4})make ([a-z-]+)", text(page), re.MULTILINE)) <= set(targets[1].split())
