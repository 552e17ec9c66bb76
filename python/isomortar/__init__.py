"""Isogeometric frictional contact between deformable bodies in three dimensions.

>>> import isomortar
>>> scene = isomortar.Scene.load("press")
>>> with isomortar.run(scene, "press.h5") as results:  # doctest: +SKIP
...     force = results.curve("force", support="top", component="z")
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from isomortar.cli.progress import progress as progress
    from isomortar.driver import run as run
    from isomortar.errors import IsomortarError as IsomortarError
    from isomortar.errors import IsomortarWarning as IsomortarWarning
    from isomortar.march.simulation import Simulation as Simulation
    from isomortar.results.film import film as film
    from isomortar.results.paraview import export as export
    from isomortar.results.pictures import plot as plot
    from isomortar.results.reader import Results as Results
    from isomortar.results.view import view as view
    from isomortar.scene.scene import Scene as Scene
    from isomortar.solve.record import Observer as Observer

    __version__: str

_HOMES = {
    "IsomortarError": "errors",
    "IsomortarWarning": "errors",
    "Observer": "solve.record",
    "Results": "results.reader",
    "Scene": "scene.scene",
    "Simulation": "march.simulation",
    "export": "results.paraview",
    "film": "results.film",
    "plot": "results.pictures",
    "progress": "cli.progress",
    "run": "driver",
    "view": "results.view",
}

__all__ = [
    "IsomortarError",
    "IsomortarWarning",
    "Observer",
    "Results",
    "Scene",
    "Simulation",
    "export",
    "film",
    "plot",
    "progress",
    "run",
    "view",
]


def __getattr__(name: str) -> Any:
    """Import what is asked for: `import isomortar` alone stays quick, and reading a results file needs no Matplotlib."""
    if name == "__version__":
        return import_module("importlib.metadata").version("isomortar")
    if name not in _HOMES:
        raise AttributeError(f"module 'isomortar' has no attribute {name!r}")
    return getattr(import_module(f"isomortar.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
