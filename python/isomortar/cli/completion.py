"""What shells complete besides commands, options and files: scenes, their keys, families, benchmarks."""

from __future__ import annotations

import ast
from collections.abc import Iterable
from pathlib import Path

import typer

from isomortar.errors import InputError


def scenes(incomplete: str) -> list[str]:
    """Bundled scenes, and scene files."""
    from isomortar.scene import bundled_scenes

    folder, slash, _ = incomplete.rpartition("/")
    files = sorted(f"{folder}{slash}{path.name}" for path in Path(folder or slash or ".").glob("*.toml"))
    return _beginning(incomplete, [*bundled_scenes(), *files])


def keys(context: typer.Context, incomplete: str) -> list[tuple[str, str]]:
    """What `--set` can change of the scene that stands before it, else of any, and what that means."""
    from isomortar.scene.keys import settable_keys

    scene = context.args[0] if context.args else None  # behind an option without its value arguments are not told apart yet
    try:
        return [(f"{path}=", meaning) for path, meaning in settable_keys(scene) if path.startswith(incomplete)]
    except InputError:  # the command itself says what is wrong with the scene
        return []


def families(context: typer.Context, incomplete: str) -> list[str]:
    """Folders with cases."""
    from isomortar.harness.collection import holds_cases

    return _beginning(incomplete, sorted({path.parent.name for path in context.params["cases"].glob("*/*.py") if holds_cases(path)}))


def benchmarks(context: typer.Context, incomplete: str) -> list[str]:
    """Functions with `@benchmark`."""
    trees = [ast.parse(path.read_text(encoding="utf-8")) for path in sorted(context.params["cases"].glob("performance/*.py"))]
    functions = [node for tree in trees for node in tree.body if isinstance(node, ast.FunctionDef)]
    return _beginning(incomplete, [f.name for f in functions if any("'benchmark'" in ast.dump(mark) for mark in f.decorator_list)])


def _beginning(incomplete: str, names: Iterable[str]) -> list[str]:
    return [name for name in names if name.startswith(incomplete)]
