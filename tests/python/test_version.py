"""The version is that of the tag: in a repository, in what `git archive` makes of it, and without either."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def git(folder: Path, *words: str) -> str:
    author = ["-c", "user.name=nobody", "-c", "user.email=nobody@nowhere"]
    return subprocess.run(["git", "-C", str(folder), *author, *words], capture_output=True, text=True, check=True).stdout.strip()


def told(folder: Path) -> str:
    return subprocess.run([sys.executable, str(folder / "tools/version.py")], capture_output=True, text=True, check=True).stdout.strip()


def archived(repository: Path, folder: Path) -> Path:
    """What `git archive` makes of the last commit."""
    folder.mkdir()
    tar = subprocess.run(["git", "-C", str(repository), "archive", "HEAD"], capture_output=True, check=True).stdout
    subprocess.run(["tar", "-x", "-C", str(folder)], input=tar, check=True)
    return folder


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    folder = tmp_path / "repository"
    (folder / "tools").mkdir(parents=True)
    shutil.copy(ROOT / "tools/version.py", folder / "tools")
    shutil.copy(ROOT / ".gitattributes", folder)
    git(folder, "init", "--quiet")
    git(folder, "add", ".")
    git(folder, "commit", "--quiet", "--message", "first")
    return folder


def test_without_a_release_it_is_a_development(repository: Path, tmp_path: Path) -> None:
    git(repository, "tag", "vague")
    assert told(repository) == told(archived(repository, tmp_path / "archive")) == "0.1.0.dev0"


def test_a_tag_is_the_version(repository: Path, tmp_path: Path) -> None:
    git(repository, "tag", "v0.2.0")
    assert told(repository) == told(archived(repository, tmp_path / "archive")) == "0.2.0"


def test_commits_since_are_counted(repository: Path, tmp_path: Path) -> None:
    git(repository, "tag", "v1.12")
    git(repository, "commit", "--quiet", "--allow-empty", "--message", "second")
    commit = git(repository, "rev-parse", "--short", "HEAD")
    assert told(repository) == told(archived(repository, tmp_path / "archive")) == f"1.12.post1+g{commit}"
