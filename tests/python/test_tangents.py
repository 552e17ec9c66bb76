"""The tangent against the extended-precision twin, and the check itself: it sees an error of 1e-6 in any part."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console
from tangents.blocks import PartBlocks

from isomortar import _twin
from isomortar.errors import InputError, KernelError
from isomortar.harness import tangents
from isomortar.harness.tangents import PairTangent, TangentReport, check_tangent, measure
from isomortar.harness.visits import Visit, visited_states
from isomortar.model.entities import Problem
from isomortar.model.solid import Solid
from isomortar.scene import Scene
from isomortar.solve.contact import Blocks, PairMechanics
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger

#: A bowl pressed onto the side of a ring and turned: curved, rational master, orders 1 to 3, stick and slip at once.
CURVED = """
format = 1
name = "curved"

[bodies.block]
geometry = { kind = "bowl", centre = [0.25, 0.02], half_width = 0.1, bottom = 0.46, rise = 0.02, top = 0.7 }
mesh = { order = [2, 3, 1], elements = [3, 2, 1] }

[bodies.ring]
geometry = { kind = "ring", centre = [0, 0, 0], inner = 0.3, outer = 0.5, width = 0.4 }
mesh = { order = [3, 1, 2], elements = [12, 1, 2] }

[contacts.interface]
slave = "block.w0"
master = "ring.v1"
friction = 0.4

[supports.top]
face = "block.w1"

[supports.hub]
face = "ring.v0"

[[stages]]
name = "press"
steps = 3
motions.top = { translate = [-0.04, 0, -0.1] }

[[stages]]
name = "turn"
steps = 2
motions.top = { translate = [0.02, 0.01, -0.01], rotate = 5 }
"""

STEP = 4


def curved(*overrides: str) -> Problem:
    return Scene.from_toml(CURVED, overrides=overrides).problem()


@pytest.fixture(scope="module")
def problem() -> Problem:
    return curved()


@pytest.fixture(scope="module")
def visits(problem: Problem) -> list[Visit]:
    return visited_states(problem, STEP)


def errors(report: TangentReport) -> dict[str, float]:
    return {row.part: row.error for row in report.rows}


@pytest.mark.parametrize("slip_sum", ["local", "paper"])
def test_curved_pair_with_friction(slip_sum: str) -> None:
    report = check_tangent(curved(f"solver.slip_sum={slip_sum}"), STEP, directions=2)
    assert report.passes, report
    assert len(report.active) == 3
    assert max(report.stick) > 0
    assert min(report.slip) > 0
    assert {"solid", "normal, geometric", "tangential, geometric", "stick", "slip", "whole", "symmetry"} <= set(errors(report))


def test_states_of_the_augmentations() -> None:
    report = check_tangent(curved("solver.method=uzawa", "solver.penalty_normal=10", "solver.penalty_tangential=1"), 2, directions=1)
    assert report.passes, report


def test_pair_without_friction() -> None:
    report = check_tangent(curved("contacts.interface.friction=0"), 3, directions=2)
    assert report.passes, report
    assert set(errors(report)) == {"solid", "normal, geometric", "normal, gap", "normal, pressure", "whole", "symmetry"}


def test_plane_has_no_geometric_part() -> None:
    changes = ["bodies.block.mesh.elements=[5,4,1]", "bodies.block.mesh.order=[2,3,2]", "contacts.floor.friction=0.1"]
    report = check_tangent(Scene.load("press", changes).problem(), 4, directions=1)
    assert report.passes, report
    assert {"stick", "slip"} <= set(errors(report))
    assert not {"normal, geometric", "tangential, geometric", "tangential, metric"} & set(errors(report))


def test_body_without_contact() -> None:
    text = """
        format = 1
        bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
        supports.base.face = "block.w0"
        supports.top.face = "block.w1"
        stages = [{ name = "pull", steps = 1, motions.top.translate = [0.2, 0, 0.3] }]
    """
    report = check_tangent(Scene.from_toml(text).problem(), directions=1)
    assert report.passes, report
    assert set(errors(report)) == {"solid", "whole", "symmetry"}


def test_far_from_the_origin() -> None:
    problem = curved()
    away = np.array([1e6, 7e5, -3e5])
    bodies = tuple(replace(b, patch=replace(b.patch, control_points=b.patch.control_points + away)) for b in problem.bodies)
    supports = tuple(replace(s, centre=tuple((away + s.centre).tolist())) for s in problem.supports)
    report = check_tangent(replace(problem, bodies=bodies, supports=supports), STEP, directions=1)
    assert report.passes


def test_a_contact_that_is_open_is_not_measured() -> None:
    """Its tangent has no part at such a state: nothing is known of it, whatever the solid's is."""
    report = check_tangent(curved("stages.0.motions.top.translate=[0,0,0.1]", "stages.1.motions.top.translate=[0,0,0]"), 2, directions=1)
    assert all(row.passes for row in report.rows)
    assert report.idle == ("interface",)
    assert not report.passes
    console = Console(width=200)
    with console.capture() as said:
        console.print(report)
    assert "contact 'interface'" in said.get()
    assert "NOT MEASURED" in said.get()


def test_visited_states_are_apart_and_end_in_the_converged_one(visits: list[Visit]) -> None:
    distances = [np.abs(visit.positions - visits[-1].positions).max() for visit in visits]
    assert distances[0] > 1e-6 > distances[1] > distances[2] == 0.0
    assert all(np.abs(visit.pairs[0].law.pressure).max() > 0 for visit in visits)
    assert not any(visit.pairs[0].law.forgiving or visit.pairs[0].law.slip_margin for visit in visits)


def test_mid_run_is_the_default() -> None:
    assert check_tangent(Scene.load("press", ["bodies.block.mesh.elements=[2,2,1]"]).problem(), directions=1).step == 3


def test_step_that_does_not_exist(problem: Problem) -> None:
    with pytest.raises(InputError, match="load step 6 does not exist; the scene has steps 1 to 5"):
        check_tangent(problem, 6)


def _scaled_rows(kind: int) -> Callable[[Blocks], Blocks]:
    def change(blocks: Blocks) -> Blocks:
        rows = blocks.rows.copy()
        rows[:, kind] *= 1.0 + 1e-6
        return replace(blocks, rows=rows)

    return change


def _scaled_multiplier(multiplier: int) -> Callable[[Blocks], Blocks]:
    def change(blocks: Blocks) -> Blocks:
        changes = blocks.changes.copy()
        changes[:, multiplier] *= 1.0 + 1e-6
        return replace(blocks, changes=changes)

    return change


def _one_block(blocks: Blocks) -> Blocks:
    geometric = blocks.geometric.copy()
    geometric[np.argmax(np.abs(geometric).sum(axis=(1, 2)))] *= 1.0 + 1e-6
    return replace(blocks, geometric=geometric)


def _no_geometric(blocks: Blocks) -> Blocks:
    return replace(blocks, geometric=np.zeros_like(blocks.geometric))


@pytest.mark.parametrize(
    ("change", "part"),
    [
        (_scaled_rows(0), "normal, gap"),
        (_scaled_rows(1), "tangential, projection"),
        (_scaled_rows(4), "tangential, slip increment"),
        (_scaled_rows(6), "tangential, metric"),
        (_scaled_multiplier(0), "normal, pressure"),
        (_scaled_multiplier(1), "stick"),
        (_scaled_multiplier(2), "slip"),
        (_one_block, "normal, geometric"),
        (_one_block, "tangential, geometric"),
        (_no_geometric, "normal, geometric"),
        (_no_geometric, "tangential, geometric"),
        (_no_geometric, "whole"),
    ],
)
def test_check_sees_a_wrong_part(
    problem: Problem, visits: list[Visit], monkeypatch: pytest.MonkeyPatch, change: Callable[[Blocks], Blocks], part: str
) -> None:
    right = PairMechanics.blocks
    monkeypatch.setattr(PairMechanics, "blocks", lambda *arguments: change(right(*arguments)))
    monkeypatch.setattr(_twin, "solid_difference", lambda *arguments: np.zeros_like(arguments[2]))  # slow, and not what is tested
    report = measure(problem, STEP, visits[:1], directions=1)
    assert not report.passes
    assert errors(report)[part] > 1e-11


def test_check_sees_a_wrong_solid(problem: Problem, visits: list[Visit], monkeypatch: pytest.MonkeyPatch) -> None:
    right = Solid.forces_and_tangent

    def wrong(self: Solid, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        forces, tangent = right(self, positions)
        tangent = tangent.copy()
        tangent[len(tangent) // 2, 0, 1] *= 1.0 + 1e-6
        return forces, tangent

    monkeypatch.setattr(Solid, "forces_and_tangent", wrong)
    report = errors(measure(problem, STEP, visits[:1], directions=1))
    assert report["solid"] > 1e-11
    assert report["symmetry"] > 1e-13


def test_state_between_stick_and_slip_has_no_tangent(problem: Problem, visits: list[Visit]) -> None:
    condensed = replace(problem, settings=replace(problem.settings, method="uzawa"))
    equilibrium = Equilibrium(condensed, Ledger())
    tangent = PairTangent(equilibrium.pairs[0], visits[-1].positions, visits[-1].pairs[0])
    flipped = np.where(tangent.response.state == 2, 1, tangent.response.state).astype(np.int32)
    tangent.response = replace(tangent.response, state=flipped)
    with pytest.raises(KernelError, match="branches switch"):
        tangent.twin(np.zeros_like(visits[-1].positions))


NAN = np.full((1, 3), np.nan)
ONE = np.ones((1, 3))


@pytest.mark.parametrize(("ours", "twin"), [(NAN, ONE), (ONE, NAN), (NAN, 0 * ONE), (ONE, 0 * ONE), (0 * ONE, ONE)])
def test_check_sees_what_is_no_number(ours: np.ndarray, twin: np.ndarray) -> None:
    for samples in ([(ONE, ONE), (ours, twin)], [(ours, twin), (ONE, ONE)]):
        row = tangents._part_error("solid", [("solid", *sample) for sample in samples])
        assert row is not None
        assert not row.passes
    blocks = PartBlocks("solid", np.stack([ONE, ours]), np.stack([ONE, twin]), 0.0)
    assert not blocks.errors.max() <= 1e-11
