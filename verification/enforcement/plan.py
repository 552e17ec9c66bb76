"""What is compared: scenes computed with every way of enforcing contact, and once with the mortar method on finer meshes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from enforcement.contact import IN_CELLS
from enforcement.run import computed
from patch_tests.subcells import SUBCELLS

from isomortar.harness.study import Run
from isomortar.scene.scene import Scene

#: Overrides of a contact by the way it is enforced; `swapped` exchanges slave and master, in `two passes` each face is slave once.
WAYS: dict[str, tuple[str, ...]] = {
    "mortar": ("enforcement=mortar", "projection=closest"),
    "mortar, averaged": ("enforcement=mortar", "projection=averaged"),
    "mortar, swapped": ("enforcement=mortar", "projection=closest"),
    "mortar, two passes": ("enforcement=mortar", "projection=closest"),
    IN_CELLS: ("enforcement=mortar", "projection=closest", f"subcells={SUBCELLS}"),
    "mortar, elastic slip": ("enforcement=mortar", "projection=closest", "elastic_slip=1e-3"),  # bodies are about 1 in size
    "mortar, smooth": ("enforcement=mortar", "projection=closest", "smoothing=1e-3"),  # and so are pressures
    "dual": ("enforcement=dual", "projection=closest"),
    "dual, averaged": ("enforcement=dual", "projection=averaged"),
    "greville": ("enforcement=greville", "projection=closest"),
    "greville, averaged": ("enforcement=greville", "projection=averaged"),
    "demko": ("enforcement=demko", "projection=closest"),
    "demko, averaged": ("enforcement=demko", "projection=averaged"),
    "knots": ("enforcement=knots", "projection=closest"),
    "knots, averaged": ("enforcement=knots", "projection=averaged"),
    "kts": ("enforcement=kts", "projection=closest"),
    "kts, averaged": ("enforcement=kts", "projection=averaged"),
}
#: Ends of the names of those that a plane knows not.
_OF_TWO_FACES = ("averaged", "swapped", "two passes", "subcells")
MORTAR = next(iter(WAYS))
#: Multipliers of quadrature points are augmented, to the paper's tolerance: they go on growing where they are too many.
AUGMENTED = {"method": "uzawa", "augmentation_tolerance": 0.01, "max_augmentations": 200}
#: Multipliers of two passes are not unique: steps that do not converge are halved twice, and no more.
TWO_PASSES = {"max_cuts": 2}
REFERENCE = "reference"


@dataclass(frozen=True)
class Setup:
    """A bundled scene, coarser than it is.

    Parameters
    ----------
    name, scene, title : str
    changes, finer : tuple of str
        Overrides of its runs, and further ones of the reference.
    support : str
        The one whose curve is compared.
    quantity : {"force", "moment"}
    component : int
    order : int
        Of the slave, where it is one of a row of orders; 0: it is not.
    without : tuple of str
        Beginnings of the names of ways that are left out.
    """

    name: str
    scene: str
    title: str
    changes: tuple[str, ...]
    finer: tuple[str, ...]
    support: str
    quantity: str
    component: int
    order: int = 0
    without: tuple[str, ...] = ()

    @property
    def ways(self) -> tuple[str, ...]:
        """Those that there are: a plane is no slave, and has one normal; Demko's abscissae are those of splines."""
        contact = self._contact(Scene.load(self.scene))[1]
        return tuple(
            way
            for way in WAYS
            if (contact.master or not way.endswith(_OF_TWO_FACES))
            and not (self.kinks and way.startswith("demko"))
            and not way.startswith(self.without)
        )

    @property
    def kinks(self) -> bool:
        """Whether bodies are of Lagrange elements, so that a master has kinks."""
        return any("L" in body.mesh.family for body in Scene.load(self.scene, self.changes).tables.bodies.values())

    def load(self, way: str) -> Scene:
        """The scene as it is enforced that way, or as the reference."""
        scene = Scene.load(self.scene)
        name, contact = self._contact(scene)
        plain = WAYS[MORTAR if way == REFERENCE else way]
        overrides = [f"contacts.{name}.{entry}" for entry in plain if contact.master or not entry.startswith("projection")]
        if way.endswith("swapped"):
            overrides += [f"contacts.{name}.slave={list(contact.master)}", f"contacts.{name}.master={list(contact.slave)}"]
        if way.endswith("two passes"):
            passes = {name: (contact.slave, contact.master), "back": (contact.master, contact.slave)}
            alike = f"friction={contact.friction}, subcells=0, projection='closest'"
            tables = [f"{key}={{slave={list(slave)}, master={list(master)}, {alike}}}" for key, (slave, master) in passes.items()]
            overrides = [f"contacts={{{', '.join(tables)}}}"]
        settings = AUGMENTED if way.startswith("kts") else TWO_PASSES if way.endswith("two passes") else {}
        overrides += [f"solver.{key}={value}" for key, value in settings.items()]
        overrides += self.finer if way == REFERENCE else ()
        return Scene.load(self.scene, [*self.changes, *overrides])

    def _contact(self, scene: Scene):  # type: ignore[no-untyped-def]
        return next(iter(scene.tables.contacts.items()))


#: It takes as long as the scene by all other ways: one scene tells of it.
_DEAR = ("kts, averaged",)
#: Load steps, and how often one is halved before a run ends: some do, and looking for their end is what they cost.
_SLID = ("stages.press.steps=3", "stages.slide.steps=6", "solver.max_cuts=4")


def _splines(slave: str, master: str) -> tuple[str, str]:
    """Overrides that make both bodies of the block of quadratic NURBS."""
    shape = 'family="N", order=[2,2,2]'
    return f"bodies.slave.mesh={{{shape}, elements={slave}}}", f"bodies.master.mesh={{{shape}, elements={master}}}"


SETUPS = (
    Setup(
        "press", "press", "A bowl, pressed on a plane",
        ("bodies.block.mesh.elements=[6,6,3]",), ("bodies.block.mesh.elements=[12,12,6]",), "top", "force", 2,
    ),
    Setup(
        "twist", "twist", "A bowl, pressed on a block and turned",
        ("stages.press.steps=5", "stages.twist.steps=15", "stages.twist.motions.top.rotate=67.5"),
        ("bodies.slave.mesh.elements=[6,6,3]", "bodies.master.mesh.elements=[10,10,3]"), "top", "moment", 2,
    ),
    Setup(
        "iron", "iron", "A bowl, pressed on a base and dragged",
        ("stages.press.steps=5", "stages.drag.steps=12", "stages.drag.motions.top.translate=[0.54,0,0]"),
        ("bodies.slave.mesh.elements=[10,10,3]", "bodies.master.mesh.elements=[20,10,3]"), "top", "force", 0, without=_DEAR,
    ),
    Setup(
        "tire", "tire", "A ring, pressed on a plane and rolled",
        (
            "bodies.tire.mesh.elements=[16,2,2]", "stages.press.steps=4", "stages.roll.steps=10",
            "stages.roll.motions.rim={translate=[0.24609142453120045,0,0],rotate=30.0}",
        ),
        ("bodies.tire.mesh.elements=[32,4,2]",), "rim", "force", 0,
    ),
    Setup(
        "block L1", "block", "A block with sharp edges, slid along a larger one; linear elements, whose master has kinks",
        _SLID, _splines("[8,8,4]", "[10,10,4]"), "top", "force", 0, without=_DEAR,
    ),
    Setup(
        "block N2", "block", "The same block; quadratic splines",
        (*_SLID, *_splines("[5,5,3]", "[8,8,4]")), _splines("[8,8,4]", "[10,10,4]"), "top", "force", 0, without=_DEAR,
    ),
)  # fmt: skip


#: Changes of the mortar method whose cost is not one of the order.
_AT_ONE_ORDER = ("mortar, swapped", "mortar, two passes", "mortar, elastic slip", "mortar, smooth")


def _pressed(kind: str) -> Setup:
    """The bowl on a plane, of one of the orders; all have one reference."""
    family, order = kind[0], int(kind[1])
    shape = f"bodies.block.mesh={{family='{family}', order=[{order},{order},2], elements=[5,5,2]}}"
    finer = "bodies.block.mesh={family='N', order=[3,3,2], elements=[10,10,4]}"
    return Setup(
        f"press {kind}", "press", "A bowl, pressed on a plane", (shape, "stages.press.steps=3"), (finer,), "top", "force", 2,
        order, _AT_ONE_ORDER,
    )  # fmt: skip


def _turned(kind: str) -> Setup:
    """The bowl on a block, both of one of the orders; all have one reference. Order five takes as long as all others."""
    order = int(kind[1])
    changes = (
        *(f"bodies.{body}.mesh.order=[{order},{order},2]" for body in ("slave", "master")),
        "bodies.slave.mesh.elements=[3,3,2]", "bodies.master.mesh.elements=[4,4,2]",
        "stages.press.steps=3", "stages.twist.steps=5", "stages.twist.motions.top.rotate=22.5",
    )  # fmt: skip
    finer = (
        *(f"bodies.{body}.mesh.order=[3,3,2]" for body in ("slave", "master")),
        "bodies.slave.mesh.elements=[6,6,3]", "bodies.master.mesh.elements=[8,8,3]",
    )  # fmt: skip
    return Setup(
        f"twist {kind}", "twist", "A bowl, pressed on a block and turned", changes, finer, "top", "moment", 2,
        order, (*_AT_ONE_ORDER, "kts"),
    )  # fmt: skip


#: Scenes by order; those of order 1 are of Lagrange elements, as no spline of it is round.
BY_ORDER = (*map(_pressed, ("L1", "N2", "N3", "N4", "N5")), *map(_turned, ("N2", "N3", "N4")))


@dataclass(frozen=True)
class Planned:
    """A run of the study."""

    setup: Setup
    way: str

    @property
    def run(self) -> Run:
        """The scene under a name of its own, and what measures it."""
        return Run(f"{self.setup.name}-{self.way.replace(', ', '-')}", self.setup.load(self.way), computed)


def planned(setups: tuple[Setup, ...]) -> Iterator[Planned]:
    """All that is run, in this order; the reference of a scene first."""
    for setup in setups:
        for way in (REFERENCE, *setup.ways):
            yield Planned(setup, way)
