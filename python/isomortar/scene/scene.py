"""A scene: what a scene file says, and the problem that it describes."""

from __future__ import annotations

import copy
import itertools
import os
from pathlib import Path
from typing import Any, Literal

from pydantic import ValidationError

from isomortar._arguments import kind, place
from isomortar.model.checks import check
from isomortar.model.entities import Problem
from isomortar.model.messages import input_error
from isomortar.scene.build import build, coarse_patch
from isomortar.scene.geometry_file import patch_table
from isomortar.scene.schema import CurveTable, RecordTable, SceneTable, StageTable
from isomortar.scene.source import SceneChanges, apply_overrides, parse, read_source
from isomortar.scene.toml_text import dump


class Scene:
    """A validated scene.

    Use `Scene.load` (file or bundled scene) or `Scene.from_toml` (text).

    Parameters
    ----------
    text : str
        TOML text of the scene file.
    name : str
        Short name where the text gives none.
    folder : Path
        Where its geometry files lie.
    overrides : iterable of str, or mapping of str to value
        ``KEY=VALUE`` each, or values by path, see `isomortar.scene.source.apply_overrides`.
    source : str, optional
        Path of the file, by which the text is named where it is no TOML; absent: the name.

    Attributes
    ----------
    name, title : str
    tables : SceneTable
        The content, with defaults.

    Raises
    ------
    InputError
        Not TOML, unknown keys, impossible values; `field` is the dotted path of the key.
    """

    def __init__(self, text: str, name: str, folder: Path, overrides: SceneChanges = (), source: str = "") -> None:
        kind("text", text, str)
        self._text, self._folder = text, folder
        self._data = parse(text, source or name)
        apply_overrides(self._data, overrides)
        try:
            self.tables = SceneTable.model_validate(self._data)
        except ValidationError as error:
            raise input_error(error, self._data) from error
        self.name = self.tables.name or name
        self.title = self.tables.title

    @classmethod
    def load(cls, source: str | Path, overrides: SceneChanges = ()) -> Scene:
        """A scene from a file, or a bundled one by its name.

        Parameters
        ----------
        source : str or Path
            Path of a scene file, or a name of `bundled_scenes`.
        overrides : iterable of str, or mapping of str to value
            Overrides of single values: ``bodies.master.mesh.order=[3, 2, 2]``, or ``{"bodies.master.mesh.order": [3, 2, 2]}``.
        """
        kind("source", source, str, os.PathLike)
        return cls(*read_source(os.fspath(source)), overrides, os.fspath(source))

    @classmethod
    def from_toml(cls, text: str, folder: str | Path = ".", overrides: SceneChanges = ()) -> Scene:
        """A scene from the text of a scene file; `folder` is where its geometry files lie."""
        return cls(text, "scene", place("folder", folder), overrides)

    def with_more_steps(self, *counts: int) -> Scene:
        """The scene with a stage more for each count: so many load steps at the rate of its last stage; loads and forces stay as they are.

        A run that is resumed with it goes on where the scene ended.
        """
        data = copy.deepcopy(self._data)
        for count in counts:
            further = _further(self.tables.stages[-1], count, [stage["name"] for stage in data["stages"]])
            for support in data.get("supports", {}).values():
                if self.tables.stages[-1].name in support.get("stages", ()):
                    support["stages"].append(further["name"])
            data["stages"].append(further)
        return Scene(dump(data), self.name, self._folder) if counts else self

    def __repr__(self) -> str:
        tables = self.tables
        parts = [f"{what} {', '.join(names)}" for what, names in (("bodies", [*tables.bodies]), ("contacts", [*tables.contacts])) if names]
        stages = ", ".join(f"{stage.name} ({stage.steps} load steps)" for stage in tables.stages)
        return f"<Scene {self.name}: {'; '.join([*parts, f'stages {stages}'])}>"

    def problem(self) -> Problem:
        """The problem that the scene describes, checked as far as it can be before any work.

        Raises
        ------
        InputError
            References to what does not exist, impossible geometry, a body that nothing holds, contradicting supports.
        """
        problem = build(self.tables, self.name, self._folder)
        check(problem)
        return problem

    def whole(self) -> Problem:
        """The same before symmetry has halved it, unchecked."""
        return build(self.tables.model_copy(update={"symmetry": {}}), self.name, self._folder)

    @property
    def record(self) -> RecordTable:
        """What results are to keep."""
        return self.tables.record

    def curves(self) -> tuple[CurveTable, ...]:
        """The scene's own curves, else force and moment of every support that moves, and how far a force moves it, by component."""
        if self.record.curves is not None:
            return tuple(self.record.curves)
        stages, supports = self.tables.stages, self.tables.supports
        pressed = [name for name, support in supports.items() if support.by_force]
        moving = [s for s in supports if s in pressed or any(s in stage.motions and stage.motions[s].moves for stage in stages)]
        quantities: tuple[Literal["force", "moment", "displacement"], ...] = ("force", "moment", "displacement")
        return tuple(
            CurveTable(name=f"{name} {quantity} {component}", support=name, quantity=quantity, component=component)
            for name in moving
            for quantity in quantities[: 3 if name in pressed else 2]
            for component in ("x", "y", "z")
        )

    def to_toml(self) -> str:
        """Text of a scene file that needs no other file: overrides applied, name given, geometry files written out.

        The scene's own text where that says it all already.
        """
        data: dict[str, Any] = copy.deepcopy(self._data)
        data["name"] = self.name
        for name, table in self.tables.bodies.items():
            if table.file is not None:
                del data["bodies"][name]["file"]
                data["bodies"][name]["patch"] = patch_table(coarse_patch(name, table, self._folder))
        return self._text if data == parse(self._text, self.name) else dump(data)


def _further(stage: StageTable, count: int, names: list[str]) -> dict[str, Any]:
    """A stage that goes on like another one for some load steps, by a name that is not taken."""
    share = count / stage.steps
    motions = {
        support: {"translate": [share * way for way in motion.translate], "rotate": share * motion.rotate}
        for support, motion in stage.motions.items()
    }
    name = next(name for number in itertools.count(2) if (name := f"{stage.name}-{number}") not in names)
    return {"name": name, "steps": count, "motions": motions}
