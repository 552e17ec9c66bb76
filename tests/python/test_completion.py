"""Shells complete commands, scenes, keys of a scene, families and benchmarks."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from isomortar.errors import InputError
from isomortar.scene import Scene, bundled_scenes
from isomortar.scene.keys import settable_keys
from isomortar.scene.source import parse, read_source

ROOT = Path(__file__).parents[2]


def completed(line: str, folder: Path = ROOT) -> list[str]:
    """What a shell would be told after a line, whose last word is being typed."""
    words = {"COMP_WORDS": line, "COMP_CWORD": str(line.count(" ")), "_ISOMORTAR_COMPLETE": "complete_bash"}
    command = [sys.executable, "-c", "import sys; sys.argv[0] = 'isomortar'; from isomortar.cli import main; main()"]
    ended = subprocess.run(command, env={**os.environ, **words}, cwd=folder, capture_output=True, text=True)
    assert ended.stderr == ""
    return ended.stdout.split()


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("isomortar ad", ["advise"]),
        ("isomortar run iron", ["iron", "iron-round"]),
        ("isomortar report orders pres", ["press"]),
        ("isomortar run press --set contacts.floor.fr", ["contacts.floor.friction="]),
        ("isomortar trade twist --set stages.press.steps=2 --set stages.twist.st", ["stages.twist.steps="]),
        ("isomortar check --set solver.max_", ["solver.max_augmentations=", "solver.max_iterations=", "solver.max_cuts="]),
        ("isomortar run nothing.toml --set solver.max_", []),
        ("isomortar verify --family orde", ["orders"]),
        ("isomortar bench solid_", ["solid_assembly"]),
    ],
)
def test_words_of_the_program_are_completed(line: str, expected: list[str]) -> None:
    assert completed(line) == expected


def test_scene_files_are_completed(tmp_path: Path) -> None:
    for name in ("press-mine.toml", "press-mine.h5", "other.toml"):
        (tmp_path / name).touch()
    assert completed("isomortar run pres", tmp_path) == ["press", "press-mine.toml"]
    assert completed("isomortar run ./pre", tmp_path) == ["./press-mine.toml"]
    assert completed(f"isomortar run {tmp_path}/o", tmp_path.parent) == [f"{tmp_path}/other.toml"]


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_every_shell_is_told_how(shell: str) -> None:
    command = [sys.executable, "-m", "isomortar", "--show-completion", shell]
    environment = {**os.environ, "_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION": "1"}
    ended = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert "_ISOMORTAR_COMPLETE" in ended.stdout or "_COMPLETE=" in ended.stdout, ended.stderr


def leaves(content: Any, path: str = "") -> Iterator[str]:
    """Paths of the single values of a scene file; lists are such but for those of tables."""
    if isinstance(content, list) and content and isinstance(content[0], dict) and "name" in content[0]:
        content = {entry["name"]: entry for entry in content}
    if not isinstance(content, dict):
        yield path
        return
    for key, entry in content.items():
        yield from leaves(entry, f"{path}.{key}" if path else key)


def refusal(name: str, path: str) -> str:
    """What is said of a scene with nonsense at a path; nothing where any text will do."""
    try:
        Scene.load(name, {path: "?"})
    except InputError as error:
        return str(error)
    return ""


@pytest.mark.parametrize("name", bundled_scenes())
def test_what_is_offered_is_what_can_be_set(name: str) -> None:
    """Every value that the scene has is offered, and what is offered is a key: a wrong value of it is told as that."""
    offered = dict(settable_keys(name))
    text, _, _ = read_source(name)
    assert set(leaves(parse(text, name))) <= set(offered)
    assert all(meaning or path.endswith("geometry.kind") for path, meaning in offered.items()), "each says what it means"
    told = {path: refusal(name, path) for path in offered}
    assert not [path for path, words in told.items() if "unknown key" in words or "no such entry" in words]


def test_keys_of_a_geometry_are_those_of_its_kind(tmp_path: Path) -> None:
    kinds = {"box": "upper", "bowl": "half_width", "torus": "radius"}
    for kind, key in kinds.items():
        (tmp_path / "a.toml").write_text(f'bodies.a.geometry.kind = "{kind}"\n')
        paths = {path.rpartition(".")[2] for path, _ in settable_keys(str(tmp_path / "a.toml")) if ".geometry." in path}
        assert paths & set(kinds.values()) == {key}
