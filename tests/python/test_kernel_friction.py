"""The return map of each law of friction, alone: control points whose trials are their multipliers, against many digits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import mpmath
import numpy as np
import pytest

from isomortar import _bindings
from isomortar._bindings import Control, FrictionArrays, FunctionArrays, Law, Response, SlaveArrays
from isomortar.errors import InputError, KernelError

NONE = FrictionArrays(0, np.zeros(0))
LAWS = {
    "coulomb": FrictionArrays(1, np.array([0.4])),
    "cohesion": FrictionArrays(2, np.array([0.4, 0.1, np.finfo(float).max])),
    "constant": FrictionArrays(2, np.array([0.0, 0.25, np.finfo(float).max])),
    "capped": FrictionArrays(2, np.array([0.4, 0.125, 0.5])),
}
#: What each bears under a pressure, of any kind of number.
RADIUS: dict[str, Callable[[Any], Any]] = {
    "coulomb": lambda p: mpmath.mpf(0.4) * p,
    "cohesion": lambda p: mpmath.mpf(0.1) + mpmath.mpf(0.4) * p,
    "constant": lambda p: mpmath.mpf(0.25) + 0 * p,
    "capped": lambda p: min(mpmath.mpf(0.125) + mpmath.mpf(0.4) * p, mpmath.mpf(0.5)),
}
#: Pressures at which they are looked at: on every branch of the law.
PRESSURES = {
    "coulomb": (1e-140, 0.3, 2.0, 1e140),
    "cohesion": (1e-140, 0.3, 1e140),
    "constant": (1e-140, 1e140),
    "capped": (1e-140, 0.9374, 0.9376, 1e140),
}
NAN = float("nan")


def answer(
    friction: FrictionArrays, pressure: Any, trial: Any, metric: Any = (1.0, 0.0, 1.0), radial: Any = None, **options: Any
) -> Response:
    """The law's answer at control points of a flat pair without gap; `radial`: the tractions that a slip makes these trials of."""
    pressure, trial, metric = np.atleast_1d(pressure).astype(float), np.atleast_2d(trial).astype(float), np.atleast_2d(metric)
    n = len(pressure)
    metric = np.ascontiguousarray(np.broadcast_to(metric, (n, 3)), dtype=float)
    nodes, one = np.arange(n, dtype=np.int32), np.ones(n)
    functions = FunctionArrays(nodes[None], np.ones((1, n)), n)
    slave = SlaveArrays(functions, functions, np.ones(1), nodes, np.zeros((1, 2, n)), 1)
    slip, traction = np.zeros((n, 2)), trial
    if radial is not None:
        traction = np.atleast_2d(radial).astype(float)
        slip = np.array([np.linalg.solve([[m[0], m[1]], [m[1], m[2]]], d) for m, d in zip(metric, trial - traction, strict=True)])
    control = Control(one, one, np.zeros(n), slip, metric, np.zeros((1, 3)))
    free, none = np.tile(np.eye(2), (n, 1, 1)), np.zeros(n, dtype=np.int32)
    law = Law(np.ones(2), friction, pressure, traction, False, np.ones(n, dtype=np.int32), free, none)
    return _bindings.augmented_multipliers(slave, control, replace(law, **options))


def many_digits(name: str) -> Callable[..., list[Any]]:
    """The slipping traction, of pressure, trial and metric, in as many digits as mpmath has."""

    def slipping(p: Any, t1: Any, t2: Any, m11: Any, m12: Any, m22: Any) -> list[Any]:
        length = mpmath.sqrt((m22 * t1**2 - 2 * m12 * t1 * t2 + m11 * t2**2) / (m11 * m22 - m12**2))
        return [RADIUS[name](p) / length * t for t in (t1, t2)]

    return slipping


def slips(name: str, pressure: float, number: int) -> tuple[np.ndarray, np.ndarray]:
    """A trial one to a hundred times as long as what is borne, in a metric whose axes are 8 degrees apart and more, of any scale."""
    random = np.random.default_rng(number)
    angle, lengths = np.radians(random.uniform(8.0, 172.0)), 10.0 ** random.uniform(-3, 3, 2)
    metric = np.array([lengths[0] ** 2, lengths.prod() * np.cos(angle), lengths[1] ** 2])
    direction = random.standard_normal(2) * lengths * (1.0 if number % 3 else [0.0, 1.0])
    with mpmath.workdps(50):
        unit = many_digits(name)(mpmath.mpf(pressure), *map(mpmath.mpf, (*direction, *metric)))
    return 10.0 ** random.uniform(0.01, 2.0) * np.array(unit, dtype=float), metric


CASES = [(name, pressure, number) for name in LAWS for pressure in PRESSURES[name] for number in range(4)]


@pytest.mark.parametrize(("name", "pressure", "number"), CASES)
def test_a_slipping_traction_and_its_slopes(name: str, pressure: float, number: int) -> None:
    """Slopes by shares of what changes, over the traction."""
    trial, metric = slips(name, pressure, number)
    found = answer(LAWS[name], pressure, trial, metric)
    assert found.state[0] == 2
    at = [pressure, *trial, *metric]
    units = np.array([pressure, *[np.abs(trial).max()] * 2, *metric])
    with mpmath.workdps(60):
        exact = np.array(many_digits(name)(*map(mpmath.mpf, at)))
        size = abs(exact).max()

        def changed(k: int, a: int, share: Any) -> Any:
            return many_digits(name)(*(mpmath.mpf(x) + (share * mpmath.mpf(units[k]) if k == j else 0) for j, x in enumerate(at)))[a] / size

        wanted = np.array([[float(mpmath.diff(lambda e, k=k, a=a: changed(k, a, e), 0)) for a in range(2)] for k in range(6)])
        assert np.all(abs(found.traction[0] - exact) <= 1e-14 * size)
        ours = (found.traction_slope[0] / size * units[:, None]).astype(float)
    assert np.abs(ours - wanted).max() <= 1e-13 * np.abs(wanted).max()


@pytest.mark.parametrize("name", LAWS)
def test_what_is_returned_is_borne_and_stays(name: str) -> None:
    for pressure in PRESSURES[name]:
        for number in range(20):
            trial, metric = slips(name, pressure, number)
            once = answer(LAWS[name], pressure, trial, metric).traction
            twice = answer(LAWS[name], pressure, once, metric).traction
            assert np.all(np.abs(twice - once) <= 1e-13 * np.abs(once).max())
            shorter = answer(LAWS[name], pressure, 0.999 * once, metric)
            assert shorter.state[0] == 1
            assert np.array_equal(shorter.traction, 0.999 * once)


@pytest.mark.parametrize("name", LAWS)
def test_the_edge_of_the_disk_and_the_margin(name: str) -> None:
    """On the edge it sticks; above the margin it slips, and its traction is then longer than its trial."""
    pressure = 1.7
    radius = _bindings.friction_radius(LAWS[name], np.array([pressure]))[0]
    assert radius == pytest.approx(float(RADIUS[name](pressure)), rel=1e-15)
    for margin in (0.0, 1e-6, 0.25, 0.999):
        edge = radius * (1.0 - margin)
        above = np.nextafter(edge, np.inf)
        found = answer(LAWS[name], [pressure] * 3, [[edge, 0.0], [above, 0.0], [0.0, -above]], slip_margin=margin)
        assert found.state.tolist() == [1, 2, 2]
        np.testing.assert_array_equal(found.traction, [[edge, 0.0], [radius, 0.0], [0.0, -radius]])


@pytest.mark.parametrize("name", LAWS)
def test_no_trial_sticks_without_a_traction(name: str) -> None:
    for pressure in (5e-324, 1.0):
        found = answer(LAWS[name], pressure, [0.0, 0.0], (2.0, 0.9, 1.0))
        assert (found.state[0], *found.traction[0]) == (1, 0.0, 0.0)
        np.testing.assert_array_equal(found.traction_slope[0], [[0, 0], [1, 0], [0, 1], [0, 0], [0, 0], [0, 0]])


def test_a_disk_of_radius_zero_bears_nothing() -> None:
    """Under the least pressure mu p is not a number above zero any more."""
    found = answer(LAWS["coulomb"], 5e-324, [1.0, -2.0], (2.0, 0.9, 1.0))
    assert (found.state[0], *found.traction[0]) == (2, 0.0, 0.0)
    assert np.isfinite(found.traction_slope).all()


@pytest.mark.parametrize("name", LAWS)
def test_where_it_is_open_there_is_no_traction(name: str) -> None:
    found = answer(LAWS[name], [0.0, -1.0], [[1.0, 2.0], [1e-3, 0.0]])
    assert not found.state.any()
    assert not found.traction.any()
    assert not found.traction_slope.any()
    assert not _bindings.friction_radius(LAWS[name], np.array([0.0, -0.0, -1.0])).any()


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("place", range(6))
def test_what_is_not_a_number_does_not_stick(name: str, place: int) -> None:
    at = [1.0, 0.2, 0.1, 2.0, 0.5, 1.0]
    at[place] = NAN
    found = answer(LAWS[name], at[0], at[1:3], at[3:])
    assert found.state[0] == 2
    assert np.isnan(found.traction).all()
    assert np.isnan(_bindings.friction_radius(LAWS[name], np.array([NAN]))).all()


@pytest.mark.parametrize("name", LAWS)
def test_a_forgiving_slope_is_the_exact_one_where_the_traction_is_the_answer(name: str) -> None:
    trial, metric = slips(name, 0.8, 1)
    exact = answer(LAWS[name], 0.8, trial, metric)
    there = answer(LAWS[name], 0.8, trial, metric, radial=exact.traction, forgiving=True)
    np.testing.assert_allclose(there.traction_slope, exact.traction_slope, rtol=1e-9, atol=1e-9 * np.abs(exact.traction_slope).max())
    inside = answer(LAWS[name], 0.8, trial, metric, radial=0.5 * exact.traction, forgiving=True)
    beyond = answer(LAWS[name], 0.8, trial, metric, radial=3.0 * exact.traction, forgiving=True)
    np.testing.assert_allclose(beyond.traction_slope, there.traction_slope, rtol=1e-9, atol=1e-9 * np.abs(exact.traction_slope).max())
    turned = exact.traction_slope[0, 1:3] - inside.traction_slope[0, 1:3]
    stuck = np.eye(2) * np.linalg.norm(exact.traction) / np.linalg.norm(trial)
    np.testing.assert_allclose(turned, 0.5 * (exact.traction_slope[0, 1:3] - stuck), rtol=1e-8, atol=1e-9 * np.abs(stuck).max())


def test_the_kink_below_the_largest_traction() -> None:
    """Where both limits are the same the slope is that of the pressures below; it is nothing above."""
    kink, off = 0.75, 2.0**-51  # 0.125 + 0.5 * 0.75 = 0.5, to the last bit
    law = FrictionArrays(2, np.array([0.5, 0.125, 0.5]))
    found = answer(law, [kink - off, kink, kink + off], [[0.0, 9.0]] * 3)
    assert found.traction[:, 1].tolist() == [0.5 - 0.5 * off, 0.5, 0.5]
    assert found.traction_slope[:, 0, 1].tolist() == [0.5, 0.5, 0.0]


def test_without_friction_there_is_no_traction() -> None:
    found = answer(NONE, 1.0, [3.0, 4.0])
    assert (found.state[0], *found.traction[0]) == (1, 0.0, 0.0)
    assert not _bindings.friction_radius(NONE, np.array([1.0, NAN])).any()


def test_a_law_with_another_number_of_parameters_is_refused() -> None:
    for friction in (FrictionArrays(0, np.ones(1)), *(replace(law, parameters=np.ones(7)) for law in LAWS.values())):
        with pytest.raises(KernelError, match="no law of material or friction has that number"):
            answer(friction, 1.0, [0.1, 0.0])
        with pytest.raises(KernelError, match="no law of material or friction has that number"):
            _bindings.friction_radius(friction, np.ones(1))
    with pytest.raises(InputError, match=r"friction\.law"):
        FrictionArrays(3, np.zeros(0))
    with pytest.raises(InputError, match=r"friction\.parameters"):
        FrictionArrays(1, np.array([-0.1]))
