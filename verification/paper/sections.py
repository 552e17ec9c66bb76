"""What a section of the paper's numerical part is: variants of a bundled scene, each run by one method or by both."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Literal, get_args

from isomortar.accuracy.discretisations import Discretisation, Elements, overrides, sweep_of
from isomortar.scene.scene import Scene

Method = Literal["monolithic", "paper"]
METHODS: tuple[Method, ...] = get_args(Method)
#: What makes a run one by the paper's own method.
PAPER_METHOD = (
    'solver.method="uzawa"',
    'solver.slip_sum="paper"',
    'solver.augmentation_norm="paper"',
    "solver.augmentation_tolerance=0.01",
    "solver.penalty_growth=1.0",
)


@dataclass(frozen=True)
class Variant:
    """A scene with one of its bodies in a discretisation of its own.

    Parameters
    ----------
    name : str
        Within its section.
    kind : str
        ``N3``, ``L2`` of the body that the section varies (`isomortar.accuracy.discretisations`).
    elements : tuple of int
        Of that body.
    title : str
        In one line, what it is there for.
    changes : tuple of str
        What else differs from the scene, as for ``isomortar run --set``.
    methods : tuple of {"monolithic", "paper"}
        How it is run: runs about tolerances, penalties, quadrature and load steps by the paper's method only.
    """

    name: str
    kind: str
    elements: Elements
    title: str
    changes: tuple[str, ...] = ()
    methods: tuple[Method, ...] = METHODS

    @property
    def lagrange(self) -> bool:
        """Whether a body is of Lagrange elements: such a run may fail, which is a result."""
        return self.kind[0] == "L" or any(".mesh.family=" in change for change in self.changes)


@dataclass(frozen=True)
class Quantity:
    """The curve that a section looks at: a component of the force on, or of the moment about the centre of, the support that moves."""

    name: str
    kind: Literal["force", "moment"]
    component: Literal["x", "y", "z"]

    @property
    def label(self) -> str:
        """With its unit, for an axis."""
        return f"{self.name} ({'force' if self.kind == 'force' else 'force · length'})"


@dataclass(frozen=True)
class Section:
    """Runs of one scene that are compared with each other.

    Parameters
    ----------
    scene : str
        Name of the bundled scene, and of the section.
    number : str
        Of the paper.
    title : str
    quantity : Quantity
    window : tuple of float
        Where curves are compared: shares of the last stage.
    reference : str
        Name of the run that others are compared with.
    series : dict of str to tuple of str
        Runs that differ in the order alone, lowest first: N (NURBS), L (Lagrange), and others that the statements ask for.
    instances : tuple of int
        Load steps that are drawn.
    variants : tuple of Variant
    changes : tuple of str
        What differs from the scene in all runs.
    """

    scene: str
    number: str
    title: str
    quantity: Quantity
    window: tuple[float, float]
    reference: str
    series: Mapping[str, tuple[str, ...]]
    instances: tuple[int, ...]
    variants: tuple[Variant, ...]
    changes: tuple[str, ...] = ()

    def variant(self, name: str) -> Variant:
        """The variant of a name; that of ``reference`` is the section's reference."""
        return next(variant for variant in self.variants if variant.name == (self.reference if name == "reference" else name))

    def names(self, entry: str) -> tuple[str, ...]:
        """Names of the runs that an entry stands for: a series, or one run; none where the section does not have it."""
        known = {variant.name for variant in self.variants} | {"reference"}
        return self.series.get(entry, (entry,) if entry in known else ())

    def overrides(self, variant: Variant, method: Method) -> tuple[str, ...]:
        """All that a variant changes of the scene, as for ``isomortar run --set``; what comes later counts."""
        return (
            *_discretised(self.scene, variant.kind, variant.elements),
            *self.changes,
            *(PAPER_METHOD if method == "paper" else ()),
            *variant.changes,
        )

    def load(self, variant: Variant, method: Method) -> Scene:
        """The scene of a variant by a method."""
        return Scene.load(self.scene, self.overrides(variant, method))

    def command(self, variant: Variant, method: Method) -> str:
        """What runs it alone, from a shell."""
        settings = " ".join(f"--set {shlex.quote(change)}" for change in self.overrides(variant, method))
        return f"isomortar run {self.scene} {settings} --output {self.scene}-{variant.name}-{method}.h5"


@cache
def _discretised(scene: str, kind: str, elements: Elements) -> tuple[str, ...]:
    loaded = Scene.load(scene)
    return tuple(overrides(loaded, sweep_of(loaded), Discretisation(kind, elements)))
