"""What is counted: numbers that are known beforehand, by hand, for flat masters and a small scene."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import isomortar
from isomortar import _bindings
from isomortar._bindings import BodyArrays, FaceArrays, MasterArrays, PlaneArrays, Projections, Response, SlaveArrays
from isomortar._codes import WORK
from isomortar.cli.cost import totals
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.march.simulation import Simulation
from isomortar.model.numbering import patch_arrays
from isomortar.scene import Scene
from isomortar.solve.condensed import CondensedSystem
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.record import Observer, StepResult
from isomortar.solve.system import CheckedSystem, LinearSystem
from isomortar.solve.timing import COUNTERS, Ledger

#: Points above a square of two by two elements of length 1, each in another element and next to a sample in that.
ABOVE = np.array([[0.3, 0.3, 0.2], [1.7, 0.2, 0.1], [0.3, 1.6, 0.4]])
BLOCK = ("bodies.slave.mesh.elements=[2,2,1]", "bodies.master.mesh.elements=[3,3,1]")
SMALL = ("bodies.slave.mesh.elements=[2,2,1]", "bodies.master.mesh.elements=[3,3,1]", "stages.press.steps=2", "stages.twist.steps=1")


class Flat:
    """A square master of two by two elements, three points above it, and what has been counted."""

    def __init__(self, kind: type[FaceArrays] | None, order: int = 1, points: np.ndarray = ABOVE) -> None:
        family = "N" if order > 1 else "L"
        patch = mesh(box((0.0, 0.0, -1.0), (2.0, 2.0, 0.0)), (family, family, family), (order, order, 1), (2, 2, 1))
        self.positions = np.ascontiguousarray(np.concatenate([patch.control_points, points]))
        arrays = patch_arrays(patch, np.arange(len(patch.weights), dtype=np.int32))
        self.master: MasterArrays = kind(arrays, 3, 1) if kind else PlaneArrays(*np.array([[0.0, 0, 0], [0, 0, 1], [1, 0, 0]]))
        count = len(points)
        self.slave = SlaveArrays.of_points(np.arange(count, dtype=np.int32) + np.int32(len(patch.weights)))
        self.slave.slopes[:] = np.array([[1.0], [0.0]])
        self.counts = np.zeros(len(WORK), dtype=np.int64)
        self._length = patch.directions[0].boundaries[-1]

    def project(self, starts: np.ndarray | None, with_friction: bool = True) -> Projections:
        """Feet of the points, from where they are on the square; None: from anywhere."""
        number = len(self.slave.area)
        origin = np.zeros((number, 2)) if starts is None else np.ascontiguousarray(starts * self._length / 2.0)
        had = np.full(number, int(starts is not None), dtype=np.int32)
        return _bindings.project_points(self.slave, self.master, self.positions, origin, had, with_friction, self.counts)

    def found(self) -> dict[str, int]:
        """What was counted since the last time, without zeros."""
        counts = {name: int(number) for name, number in zip(WORK, self.counts, strict=True) if number}
        self.counts[:] = 0
        return counts


def test_a_point_that_starts_at_its_foot_takes_one_evaluation_in_one_element() -> None:
    flat = Flat(FaceArrays)
    flat.project(ABOVE[:, :2])
    assert flat.found() == {"warm projections": 3, "elements searched": 3, "contact points": 3, "evaluations to order 2": 3}


@pytest.mark.parametrize("order", [1, 2])
def test_a_point_from_anywhere_takes_a_step_its_trial_and_its_end(order: int) -> None:
    """On a flat master Newton's step from the nearest sample, in the element of the foot, is exact."""
    flat = Flat(FaceArrays, order)
    flat.project(None)
    assert flat.found() == {"cold projections": 3, "elements searched": 3, "contact points": 3, "evaluations to order 2": 9}


def test_a_point_that_starts_beside_its_element_searches_two() -> None:
    """A step to the bound, its trial and the end there; and once more beyond it."""
    flat = Flat(FaceArrays, points=ABOVE[:1])
    flat.project(np.array([[1.5, 0.3]]))
    assert flat.found() == {"warm projections": 1, "elements searched": 2, "contact points": 1, "evaluations to order 2": 6}


@pytest.mark.parametrize(("with_friction", "of_forces"), [(False, 1), (True, 2)])
def test_passes_take_a_derivative_more_each(with_friction: bool, of_forces: int) -> None:
    """Pass one the first; forces the second with friction alone; but the two first are enough for all but slips."""
    flat = Flat(FaceArrays)
    feet = flat.project(ABOVE[:, :2], with_friction)
    flat.found()
    _bindings.control_quantities(flat.slave, flat.master, flat.positions, feet, with_friction, flat.counts)
    assert flat.found() == {"contact points": 3, "evaluations to order 1": 3}
    pressed = Response(
        np.ones(3), np.zeros((3, 2)), np.array([1, 0, 1], dtype=np.int32), np.zeros(3), np.zeros((3, 6, 2)), np.zeros((3, 2))
    )
    forces = np.zeros_like(flat.positions)
    _bindings.contact_forces(flat.slave, flat.master, flat.positions, feet, pressed, forces, with_friction, flat.counts)
    assert flat.found() == {"contact points": 2, f"evaluations to order {of_forces}": 2}


def test_a_plane_is_neither_searched_nor_evaluated() -> None:
    flat = Flat(None)
    feet = flat.project(None)
    _bindings.control_quantities(flat.slave, flat.master, flat.positions, feet, True, flat.counts)
    assert flat.found() == {"contact points": 6}


def test_averaged_normals_are_evaluated_at_all_nodes_by_each_pass() -> None:
    """On three by three linear elements: corners with one, edges with two, the others with four. Then a step at each foot, and its slip."""
    ledger = Ledger()
    equilibrium = Equilibrium(Scene.load("block", BLOCK).problem(), ledger)
    state, pair = equilibrium.initial_state(), equilibrium.pairs[0]
    points, at_nodes = len(pair.pair.slave.area), 4 * 1 + 8 * 2 + 4 * 4
    ledger.take()
    pair.kinematics(state.positions, state.contacts[0])
    counts = {name: number for name, number in ledger.take()[1].items() if number}
    assert counts == {
        "warm projections": points,
        "elements searched": points,
        "contact points": 2 * points,
        "evaluations to order 0": points,
        "evaluations to order 1": 2 * at_nodes + 3 * points,
    }


def test_counts_of_a_run_are_those_that_the_results_tell(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Entries of systems as their matrices have them, points as bodies and elements have them, bytes as the file has them."""
    entries: list[int] = []
    stressed: list[int] = []
    add_body = _bindings.add_body

    def noted(solve: Callable[..., np.ndarray]) -> Callable[..., np.ndarray]:
        def call(system: CheckedSystem, right: np.ndarray) -> np.ndarray:
            if isinstance(system, CondensedSystem):  # the bodies', and a dense block
                entries.append(len(system._bodies.pattern.indices) + system._added.size)
            elif isinstance(system, LinearSystem):
                entries.append(system.matrix().nnz)
            return solve(system, right)

        return call

    def visited(body: BodyArrays, *others: Any) -> float:
        smallest = add_body(body, *others)
        stressed.append(int(np.prod(body.gauss) * np.prod(body.patch.elements)))  # not where an element folds, which ends the visit
        return smallest

    for name in ("solve", "solve_again"):
        monkeypatch.setattr(CheckedSystem, name, noted(getattr(CheckedSystem, name)))
    monkeypatch.setattr(_bindings, "add_body", visited)
    monkeypatch.setattr("isomortar.told.during.long_elements.SUSPECT", np.inf)  # what is told of long elements is no load step's work
    scene, path = Scene.load("twist", SMALL), tmp_path / "small.h5"
    with isomortar.run(scene, path) as results:
        found, steps = totals(results), len(results.steps)
    with h5py.File(path) as file:
        written = list[int]()
        file["states"].visititems(lambda _, data: written.append(data.nbytes) if isinstance(data, h5py.Dataset) else None)
    assert found["history bytes"] == sum(written)
    assert found["system non-zeros"] == max(entries)
    assert found["solves"] == len(entries)
    assert steps == 3
    assert found["solid points"] == sum(stressed)
    assert found["factor non-zeros"] > 0


def test_every_count_is_explained_and_named() -> None:
    counters = next(iter(Simulation(Scene.load("twist", SMALL).problem()).run())).counters
    assert counters.keys() == COUNTERS.keys()
    assert set(WORK) <= COUNTERS.keys()


def test_tractions_are_not_in_the_file_of_a_contact_without_friction(tmp_path: Path) -> None:
    """Results give zeros for them, and all else as it was recorded."""
    scene, told = Scene.load("twist", (*SMALL, "contacts.interface.friction=0")), list[StepResult]()
    observer = Observer()
    observer.recorded = told.append  # type: ignore[method-assign]
    with isomortar.run(scene, tmp_path / "smooth.h5", observer) as results:
        found, history = results.step(3), results.contact("interface")
    with h5py.File(tmp_path / "smooth.h5") as file:
        assert sorted(file["states/contacts/interface"]) == ["gap", "pressure", "projected", "projection", "status"]
    assert history.traction.shape == (*history.pressure.shape, 2)
    assert history.traction_norm.shape == history.pressure.shape
    for one, other in zip(
        (*vars(found.state.contacts[0]).values(), *vars(found.contacts[0]).values()),
        (*vars(told[-1].state.contacts[0]).values(), *vars(told[-1].contacts[0]).values()),
        strict=True,
    ):
        np.testing.assert_array_equal(one, other)
