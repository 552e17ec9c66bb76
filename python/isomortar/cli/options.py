"""Arguments and options that several commands take."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from isomortar.cli import completion

SceneArgument = Annotated[
    str, typer.Argument(metavar="SCENE", help="A scene file (.toml), or a bundled scene by its name.", autocompletion=completion.scenes)
]
Overrides = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Change one value of the scene; may be repeated.", autocompletion=completion.keys),
]
ResultsArgument = Annotated[Path, typer.Argument(metavar="RESULTS", help="Results file of `isomortar run`.")]
RunsOption = Annotated[int, typer.Option("-j", "--jobs", min=1, help="Runs at the same time; several disturb each other's cost.")]
