"""What is compared: bundled scenes that all programs can express, on coarse and on fine elements, by each of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

from programs.run import PROGRAMS, computed

from isomortar.accuracy.discretisations import Elements, parse_kind
from isomortar.harness.study import Run
from isomortar.scene.scene import Scene

Mesh = Literal["coarse", "fine"]
#: How many times the coarse elements each mesh has along every direction.
MESHES: dict[Mesh, int] = {"coarse": 1, "fine": 2}


@dataclass(frozen=True)
class Setup:
    """A bundled scene, pressed in its first stage and dragged along x in its second, as all programs can express it.

    Parameters
    ----------
    scene, title : str
    changes : tuple of str
        Overrides besides those of the meshes.
    elements : dict of str to pair of Elements
        Those of slave and master on the coarse mesh, by kind. Only isomortar has NURBS.
    """

    scene: str
    title: str
    changes: tuple[str, ...]
    elements: Mapping[str, tuple[Elements, Elements]]

    def load(self, kind: str, mesh: Mesh) -> Scene:
        """The scene with elements of a kind."""
        family, order = parse_kind(kind)
        shape = f'family="{family}", order={[order] * 3}'
        meshes = [
            f"bodies.{body}.mesh={{{shape}, elements={list(elements)}}}"
            for body, elements in zip(("slave", "master"), self.counts(kind, mesh), strict=True)
        ]
        return Scene.load(self.scene, [*self.changes, *meshes])

    def counts(self, kind: str, mesh: Mesh) -> list[Elements]:
        """Elements of slave and master by direction."""
        times = MESHES[mesh]
        return [(times * u, times * v, times * w) for u, v, w in self.elements[kind]]


#: CalculiX has no other law for large strain.
_LAW = "materials.rubber.law=neo-hookean-j"
SETUPS = (
    Setup(
        scene="block",
        title="A block with sharp edges, pressed and slid along a larger one",
        changes=(_LAW,),
        elements={"L1": ((3, 3, 2), (4, 4, 2)), "L2": ((2, 2, 1), (2, 2, 1)), "N2": ((3, 3, 2), (4, 4, 2))},
    ),
    Setup(
        scene="iron",
        title="A bowl, pressed and dragged along a base",
        changes=(_LAW, "stages.press.steps=3", "stages.drag.steps=6", "stages.drag.motions.top.translate=[0.36,0,0]"),
        elements={"L1": ((3, 3, 2), (8, 4, 2)), "L2": ((2, 2, 1), (4, 2, 1)), "N2": ((3, 3, 2), (8, 4, 2))},
    ),
)


@dataclass(frozen=True)
class Planned:
    """A run of the study."""

    setup: Setup
    kind: str
    mesh: Mesh
    program: str

    @property
    def elements(self) -> list[Elements]:
        """Of slave and master by direction."""
        return self.setup.counts(self.kind, self.mesh)

    @property
    def run(self) -> Run:
        """The scene under a name of its own, and what measures it."""
        name = "-".join((self.setup.scene, self.kind, self.mesh, self.program))
        return Run(name, self.setup.load(self.kind, self.mesh), computed, {"program": self.program})


def programs_of(kind: str) -> tuple[str, ...]:
    """Programs that have elements of a kind."""
    return tuple(PROGRAMS)[: 1 if kind.startswith("N") else None]


def planned(setups: tuple[Setup, ...]) -> Iterator[Planned]:
    """All that is run, in this order."""
    for setup in setups:
        for kind in setup.elements:
            for mesh in MESHES:
                for program in programs_of(kind):
                    yield Planned(setup, kind, mesh, program)
