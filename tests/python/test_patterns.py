"""A pattern that lacks a block is an error: nothing is added to a neighbour, or to foreign memory."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy import sparse

from isomortar import _bindings
from isomortar._bindings import PatchArrays, Pattern, SlaveArrays
from isomortar.errors import InputError, KernelError
from isomortar.model.entities import Problem
from isomortar.model.pattern import pattern_of
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger

SCENE = """
format = 1
name = "pressed"
[bodies.upper]
geometry = { kind = "box", lower = [0.1, 0.2, 1], upper = [0.9, 0.8, 1.5] }
mesh = { order = [2, 1, 1], elements = [2, 3, 1] }
[bodies.lower]
geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
mesh = { order = [1, 2, 1], elements = [3, 2, 1] }
[contacts.pair]
slave = "upper.w0"
master = "lower.w1"
projection = "closest"
friction = 0.5
[supports.floor]
face = "lower.w0"
[supports.top]
face = "upper.w1"
[[stages]]
name = "press"
steps = 1
"""


#: What was added to each pattern, by its name.
Values = dict[str, np.ndarray]


@dataclass
class Assembly:
    """Kernel calls that add to patterns, each with the patterns by name."""

    problem: Problem
    summed: bool

    def __post_init__(self) -> None:
        self.equilibrium = Equilibrium(self.problem, Ledger())
        self.pair = self.equilibrium.pairs[0]
        self.positions = self.equilibrium.numbering.reference.copy()
        state = self.pair.initial(self.positions)
        self.kinematics = self.pair.kinematics(self.positions, state)
        n = len(state.pressure)
        law = self.pair.law(np.array([10.0, 1.0]), np.ones(n), np.full((n, 2), 0.1))
        self.law = replace(law, summed=self.summed)
        self.response = self.pair.respond(self.kinematics, self.law)
        patterns = self.pair.reach.update(self.kinematics.projections, self.response.state)
        self.patterns = {"rows": patterns.rows, "wide": patterns.wide, "tangent": patterns.tangent, "neighbours": self.pair.pair.neighbours}
        self.patterns["solid"] = self.equilibrium.solid.pattern
        assert np.all(self.response.state > 0)

    def solid(self, solid: Pattern) -> Values:
        body, numbering = self.problem.bodies[0], self.equilibrium.numbering
        values = np.zeros((len(solid.column), 3, 3))
        forces = np.zeros_like(self.positions)
        _bindings.add_body(numbering.body_arrays(body), body.material.arrays, self.positions, forces, solid, values)
        return {"solid": values}

    def blocks(self, rows: Pattern, tangent: Pattern) -> Values:
        values, geometric = np.zeros((len(rows.column), 10 if self.summed else 8, 3)), np.zeros((len(tangent.column), 3, 3))
        _bindings.contact_blocks(
            self.pair.pair.slave, self.pair.pair.master, self.positions, self.kinematics.projections, True, self.response, rows, values,
            tangent, geometric,
        )  # fmt: skip
        return {"rows": values, "tangent": geometric}

    def changes(self, rows: Pattern, wide: Pattern, neighbours: Pattern) -> Values:
        values = np.ones((len(rows.column), 10 if self.summed else 8, 3))
        args = self.kinematics.control, self.law, self.response, rows, values, neighbours, wide
        changes, _ = _bindings.multiplier_rows(self.pair.pair.slave, *args)
        return {"wide": changes, "neighbours": np.ones(len(neighbours.column))}

    def condensed(self, rows: Pattern, wide: Pattern, tangent: Pattern) -> Values:
        values, changes = np.ones((len(rows.column), 8, 3)), np.ones((len(wide.column), 3, 3))
        target = np.zeros((len(tangent.column), 3, 3))
        _bindings.condense_multipliers(self.response.state, rows, values, wide, changes, tangent, target)
        return {"tangent": target}


#: Calls, the patterns that they read, and those of them to which something is added.
CALLS: dict[str, tuple[Callable[..., Values], tuple[str, ...], tuple[str, ...]]] = {
    "solid": (Assembly.solid, ("solid",), ("solid",)),
    "blocks": (Assembly.blocks, ("rows", "tangent"), ("rows", "tangent")),
    "changes": (Assembly.changes, ("rows", "wide", "neighbours"), ("wide",)),
    "changes, summed": (Assembly.changes, ("rows", "wide", "neighbours"), ("wide", "neighbours")),
    "condensed": (Assembly.condensed, ("rows", "wide", "tangent"), ("tangent",)),
}


@pytest.fixture(scope="module")
def assemblies() -> dict[bool, Assembly]:
    problem = Scene.from_toml(SCENE).problem()
    settings = {summed: replace(problem.settings, method="uzawa", slip_sum="paper" if summed else "local") for summed in (False, True)}
    return {summed: Assembly(replace(problem, settings=chosen), summed) for summed, chosen in settings.items()}


def without(pattern: Pattern, entry: int) -> Pattern:
    start = pattern.start.copy()
    start[np.searchsorted(start, entry, side="right") :] -= 1
    return Pattern(start, np.delete(pattern.column, entry))


def cases() -> list[tuple[str, str]]:
    return [(call, added) for call, (_, _, targets) in CALLS.items() for added in targets]


@pytest.mark.parametrize("call", CALLS)
def test_whole_patterns_are_accepted(assemblies, call):
    function, names, _ = CALLS[call]
    assembly = assemblies["summed" in call]
    function(assembly, *(assembly.patterns[name] for name in names))


@pytest.mark.parametrize(("call", "added"), cases())
def test_a_missing_block_is_an_error_wherever_it_is(assemblies, call, added):
    function, names, _ = CALLS[call]
    assembly = assemblies["summed" in call]
    whole = {name: assembly.patterns[name] for name in names}
    used = function(assembly, **whole)[added].reshape(len(whole[added].column), -1).any(axis=1)
    assert used.any()
    for entry in np.random.default_rng(1).permutation(len(used))[:80]:
        row = int(np.searchsorted(whole[added].start, entry, side="right")) - 1
        with pytest.raises(KernelError, match=f"missing in row ({row}|-1) ") if used[entry] else suppress(KernelError):
            function(assembly, **whole | {added: without(whole[added], entry)})


@pytest.mark.parametrize("kinds", [1, 2, 8, 9])
def test_rows_without_the_slip_sum_are_refused_where_it_is_asked_for(assemblies, kinds):
    assembly = assemblies[True]
    rows = np.ones((len(assembly.patterns["rows"].column), kinds, 3))
    args = assembly.kinematics.control, assembly.law, assembly.response, assembly.patterns["rows"], rows
    with pytest.raises(InputError, match=rf"rows: has {kinds} kinds; allowed: 10"):
        _bindings.multiplier_rows(assembly.pair.pair.slave, *args, assembly.patterns["neighbours"], assembly.patterns["wide"])


def test_scatter_of_a_sound_pattern_is_that_of_a_dense_matrix(assemblies):
    """The rows on a full pattern hold the same numbers as on the sparse one, and zeros besides."""
    assembly = assemblies[False]
    rows, tangent = assembly.patterns["rows"], assembly.patterns["tangent"]
    n, m = len(rows.start) - 1, len(assembly.positions)
    full = pattern_of(sparse.csr_array(np.ones((n, m), dtype=np.int32)))
    values, dense = assembly.blocks(rows, tangent)["rows"], assembly.blocks(full, tangent)["rows"].reshape(n, m, -1)
    row = np.repeat(np.arange(n), np.diff(rows.start))
    assert np.array_equal(dense[row, rows.column], values.reshape(len(values), -1))
    dense[row, rows.column] = 0.0
    assert not dense.any()


@pytest.mark.parametrize("number", [2**31 - 1, 2**31 // 3])
def test_a_number_of_a_control_point_that_32_bits_do_not_count_is_refused(number: int) -> None:
    """The kernel counts from 1 and three unknowns a point: a column of 2^31 - 1 wrote in front of its memory."""
    far = np.array([number], dtype=np.int32)
    with pytest.raises(InputError, match="column"):
        Pattern(np.array([0, 1], dtype=np.int32), far)
    with pytest.raises(InputError, match="point"):
        SlaveArrays.of_points(far)
    point = np.arange(8, dtype=np.int32)
    point[3] = number
    one = np.ones(3, dtype=np.int32)
    with pytest.raises(InputError, match="point"):
        PatchArrays(one, one, 2 * one, np.tile([0.0, 0.0, 1.0, 1.0], 3), point, np.ones(8))
