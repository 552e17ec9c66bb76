"""Which lines of Python a cell runs.

As a program (``python -m isomortar.harness.mutants.lines_of_python FOLDER``) a measuring process whose measurements also say which lines
of the sources in a folder were run. Other processes that a cell starts are not seen.
"""

from __future__ import annotations

import ast
import sys
import threading
from collections.abc import Iterable, Set
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

from isomortar.harness.mutants.reach import with_lines
from isomortar.harness.worker import serve

#: Decorators of functions that run once for the same arguments.
_KEPT = {"cache", "lru_cache"}


def places(text: str, lines: Iterable[int]) -> list[Set[int]]:
    """Lines of the statements of a source that some lines are of (see `reach`).

    None of them where one is run once a process, and anybody may use what it makes: outside of functions, which is run when the file is
    imported; in a function that is called from there; in one whose results are kept.
    """
    tree = ast.parse(text)
    statements = [node for node in ast.walk(tree) if isinstance(node, ast.stmt)]
    once = _called_outside(tree)
    found: set[int] = set()
    for line in lines:
        inside = [node for node in statements if line in _lines_of(node)]
        functions = [node for node in inside if isinstance(node, ast.FunctionDef)]
        if not functions or any(node.name in once or _KEPT & _named(node.decorator_list) for node in functions):
            return []
        found.update(_lines_of(max(inside, key=lambda node: _lines_of(node).start)))
    return [found]


def _called_outside(tree: ast.Module) -> Set[str]:
    """Names of what a source calls outside of functions and classes."""
    outside = [node for node in tree.body if not isinstance(node, ast.FunctionDef | ast.ClassDef)]
    return _named(node.func for statement in outside for node in ast.walk(statement) if isinstance(node, ast.Call))


def _named(expressions: Iterable[ast.expr]) -> Set[str]:
    """Names that some expressions are, calls of them, or attributes."""
    bare = (node.func if isinstance(node, ast.Call) else node for node in expressions)
    return {node.attr if isinstance(node, ast.Attribute) else node.id for node in bare if isinstance(node, ast.Attribute | ast.Name)}


def _lines_of(node: ast.stmt) -> range:
    """Lines of a statement, decorators included."""
    first = min((decorator.lineno for decorator in getattr(node, "decorator_list", [])), default=node.lineno)
    return range(first, (node.end_lineno or first) + 1)


class _Tracer:
    """Notes which lines of the sources below a folder are run; a function whose lines all were costs nothing more."""

    def __init__(self, folder: str) -> None:
        self._folder = folder
        self._codes: dict[int, tuple[CodeType, set[int]]] = {}
        self._left: dict[int, set[int]] = {}

    def begin(self) -> None:
        """Forget what was run, and note from here on."""
        self._left = {key: set(lines) for key, (_, lines) in self._codes.items()}
        threading.settrace(self._called)
        sys.settrace(self._called)

    def end(self) -> dict[str, set[int]]:
        """Note nothing any more. The lines that were run since `begin`, by file below the folder."""
        sys.settrace(None)
        threading.settrace(None)
        found: dict[str, set[int]] = {}
        for key, (code, lines) in self._codes.items():
            if run := lines - self._left[key]:
                found.setdefault(code.co_filename.removeprefix(self._folder), set()).update(run)
        return found

    def _called(self, frame: FrameType, *_: Any) -> Any:
        """A function is called: follow its lines if some are left."""
        code = frame.f_code
        left = self._left.get(id(code))
        if left is None:
            left = self._new(code)
        if not left:
            return None
        left.discard(frame.f_lineno)
        return self._line

    def _new(self, code: CodeType) -> set[int]:
        within = code.co_filename.startswith(self._folder)
        lines = {line for *_, line in code.co_lines() if line} if within else set()
        self._codes[id(code)] = code, lines  # held, so that no other gets its id
        return self._left.setdefault(id(code), set(lines))

    def _line(self, frame: FrameType, *_: Any) -> Any:
        left = self._left[id(frame.f_code)]
        left.discard(frame.f_lineno)
        frame.f_trace_lines = bool(left)
        return self._line


if __name__ == "__main__":
    tracer = _Tracer(f"{Path(sys.argv[1]).resolve()}/")
    serve(lambda cell: with_lines(cell, tracer.begin, tracer.end))
