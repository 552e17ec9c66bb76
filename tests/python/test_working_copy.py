"""A working copy finds its package, and builds it first where a source has changed."""

import importlib.util
import os
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

TOOL = Path(__file__).parents[2] / "tools" / "working_copy.py"


@pytest.fixture
def copy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The tool in a working copy of two sources, whose builds are counted."""
    monkeypatch.setattr(sys, "meta_path", [*sys.meta_path])
    spec = importlib.util.spec_from_file_location("working_copy", TOOL)
    assert spec is not None
    assert spec.loader is not None
    tool = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tool)
    package, build = tmp_path / "python" / "isomortar", tmp_path / "build"
    package.mkdir(parents=True)
    build.mkdir()
    (package / "__init__.py").touch()
    for name, when in (("one.py", 1), ("other.py", 2)):
        (package / name).touch()
        os.utime(package / name, ns=(when, when))
    (tmp_path / "meson.build").touch()
    for name, value in {"ROOT": tmp_path, "BUILD": build, "FOLDERS": ("python",), "FILES": ("meson.build",)}.items():
        monkeypatch.setattr(tool, name, value)
    monkeypatch.setattr(tool, "built", [], raising=False)
    monkeypatch.setattr(tool, "build", lambda: tool.built.append(1))
    return tool


def exchange(root: Path) -> None:
    """Let two files take each other's place, and keep their times."""
    one, other, aside = (root / "python" / "isomortar" / name for name in ("one.py", "other.py", "aside.py"))
    for old, new in ((one, aside), (other, one), (aside, other)):
        old.rename(new)


def found(copy: ModuleType) -> list[str] | None:
    """Where the package's modules are looked for."""
    spec = copy.WorkingCopy().find_spec("isomortar")
    return spec and spec.submodule_search_locations


def test_python_is_where_it_lies_and_the_kernel_where_it_is_built(copy: ModuleType, tmp_path: Path) -> None:
    assert found(copy) == [str(tmp_path / "python" / "isomortar"), str(tmp_path / "build" / "fortran")]
    assert copy.WorkingCopy().find_spec("isomortar.errors") is None
    assert copy.WorkingCopy().find_spec("numpy") is None


@pytest.mark.parametrize(
    ("change", "builds"),
    [
        (lambda _: None, 0),
        (lambda root: os.utime(root / "python" / "isomortar" / "__init__.py", ns=(0, 1)), 1),
        (lambda root: (root / "python" / "isomortar" / "new.py").touch(), 1),
        (lambda root: os.utime(root / "meson.build"), 1),
        (exchange, 1),
        (lambda root: (root / "python" / "isomortar" / ".#errors.py").symlink_to("user@host"), 1),
        (lambda root: (root / "build" / "sources").unlink(), 1),
        (lambda root: (root / "python" / "isomortar" / "__pycache__").mkdir(), 0),
    ],
    ids=[
        "nothing",
        "an older file",
        "a new file",
        "the build's own",
        "two exchanged",
        "an editor's mark",
        "the build is gone",
        "compiled by Python",
    ],
)
def test_it_is_built_again_where_a_source_has_changed(
    copy: ModuleType, tmp_path: Path, change: Callable[[Path], object], builds: int
) -> None:
    found(copy)
    change(tmp_path)
    found(copy)
    found(copy)
    assert len(copy.built) == 1 + builds


def test_files_that_go_while_they_are_looked_at_have_changed(copy: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    def gone(_: Path) -> list[tuple[str, int, int]]:
        raise FileNotFoundError

    found(copy)
    with monkeypatch.context() as busy:
        busy.setattr(copy, "states", gone)
        assert found(copy)
        assert found(copy)
    found(copy)
    found(copy)
    assert len(copy.built) == 4


def test_what_cannot_be_built_is_tried_again(copy: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse() -> None:
        raise ImportError("rebuilding failed")

    with monkeypatch.context() as broken:
        broken.setattr(copy, "build", refuse)
        with pytest.raises(ImportError, match="rebuilding failed"):
            found(copy)
    assert found(copy)
    assert copy.built == [1]


def test_a_build_that_imports_the_package_is_no_reason_to_build(copy: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MESONPY_EDITABLE_SKIP", str(copy.BUILD))
    assert found(copy) is None
    assert not copy.built
