"""What is compared: the block, twist and iron on masters with kinks, by closest points and along averaged normals, and on smooth ones."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal, get_args

from paper import plans, quick
from paper.outcome import run_of
from paper.plans import AVERAGED, CLOSEST, DRAG, averaged, nurbs
from paper.sections import Section, Variant
from programs.run import computed

from isomortar.accuracy.discretisations import Elements
from isomortar.harness.study import Run
from isomortar.program.getfem import GetFEM

#: How feet are found: by closest points on masters with kinks, along averaged normals on them, and both on smooth ones.
Way = Literal["closest", "averaged", "smooth", "smooth, averaged"]
WAYS: tuple[Way, ...] = get_args(Way)
#: Every linear solve has a tangent of its own, as in the programs whose solves these are compared with.
OWN_TANGENTS = "solver.measures=['forgiving','margin','reversal','halving','extrapolation']"
#: Load steps after which the forces of the block are told: pressed, and slid.
INSTANTS = (5, 15)


def _section(section: Section, splines: Elements, quadratic: Elements, *further: Variant, changes: tuple[str, ...] = ()) -> Section:
    """A section with masters of N2, N3, L1 and of L2, which has elements of its own; `further` runs, and changes of all of them."""
    kinks = [
        found for order, elements in ((1, splines), (2, quadratic)) for found in (_closest(order, elements), averaged(order, elements))
    ]
    variants = (*nurbs(splines, 2, 3), *kinks, *further)
    return replace(section, reference="N2", variants=variants, changes=(*section.changes, OWN_TANGENTS, *changes))


def _closest(order: int, elements: Elements) -> Variant:
    return Variant(f"L{order}", f"L{order}", elements, f"L{order} by closest points", CLOSEST)


def _refined(*meshes: Elements) -> Iterator[Variant]:
    """L1 along averaged normals, and N2 along these too, on finer and finer masters; N2 by closest points, whose curvature jumps."""
    for number, mesh in enumerate(meshes):
        along = replace(averaged(1, mesh), name="N2-averaged", kind="N2", title="N2 along averaged normals")
        for variant in (averaged(1, mesh), *nurbs(mesh, 2), along)[0 if number else 2 :]:
            yield replace(variant, name=f"{variant.name}-{mesh[0]}x{mesh[1]}")


_BLOCK = Section(
    scene="block",
    number="",
    title="A block with sharp edges, slid along a larger one",
    quantity=DRAG,
    window=(0.0, 1.0),
    reference="N2",
    series={},
    instances=INSTANTS,
    variants=(),
)
FULL = (
    _section(_BLOCK, (8, 8, 4), (4, 4, 4)),
    _section(plans.TWIST, (5, 5, 3), (3, 3, 3)),
    _section(plans.IRON, (10, 5, 3), (5, 5, 3), *_refined((10, 5, 3), (20, 10, 3), (40, 20, 3))),
)
#: They try the machinery.
QUICK = (
    _section(_BLOCK, (4, 4, 1), (2, 2, 1), changes=("bodies.slave.mesh.elements=[2,2,1]", "stages.slide.motions.top.translate=[0.2,0,0]")),
    _section(quick.TWIST, (3, 3, 1), (2, 2, 1)),
    _section(quick.IRON, (5, 2, 2), (3, 2, 2), *_refined((5, 2, 2), (8, 4, 2))),
)


@dataclass(frozen=True)
class Planned:
    """A run of the study."""

    section: Section
    variant: Variant

    @property
    def name(self) -> str:
        """Its scene, and its master's elements along the face: ``iron L1 10 x 5``."""
        u, v, _ = self.variant.elements
        return f"{self.section.scene} {self.variant.kind} {u} x {v}"

    @property
    def way(self) -> Way:
        """How feet are found."""
        along_averaged = set(AVERAGED) <= set(self.variant.changes)
        if self.variant.lagrange:
            return "averaged" if along_averaged else "closest"
        return "smooth, averaged" if along_averaged else "smooth"

    @property
    def finer(self) -> bool:
        """Whether it is of the refinement alone."""
        return self.variant.name.endswith("x".join(map(str, self.variant.elements[:2])))

    @property
    def run(self) -> Run:
        """The scene under a name of its own, and what measures it."""
        return run_of(self.section, self.variant, "monolithic")


def planned(sections: tuple[Section, ...]) -> Iterator[Planned]:
    """All that isomortar runs, in this order."""
    for section in sections:
        for variant in section.variants:
            yield Planned(section, variant)


def beside(block: Section) -> Planned:
    """What another program computes of the block: its linear elements, on which it finds feet in its own way."""
    return Planned(block, replace(block.variant("L1"), changes=()))


def by_getfem(entry: Planned) -> Run:
    """The same scene by GetFEM."""
    scene = entry.section.load(entry.variant, "monolithic")
    return Run(f"{entry.section.scene}-{entry.variant.name}-{GetFEM.name}", scene, computed, {"program": GetFEM.name})
