"""Orders of accuracy: true ones are confirmed, and nothing else is."""

import numpy as np
import pytest
from scipy import stats

from isomortar.harness.orders import Convergence, estimate_order

H = np.array([0.5, 0.25, 0.125, 0.0625, 0.03125])
#: An error budget without other errors.
ALONE = {"quadrature": 1e-14}


@pytest.mark.parametrize("order", [1, 2, 3, 4, 6])
def test_a_power_is_confirmed(order):
    estimate = estimate_order(Convergence(H, 3.0 * H**order, ALONE), order)
    assert estimate.judgement == "confirmed"
    assert estimate.order == pytest.approx(order)
    assert estimate.low < order < estimate.high
    assert estimate.steps == pytest.approx([order] * 4)


def test_real_ratios_of_mesh_sizes_count():
    h = np.array([1.0, 0.6, 0.41, 0.3])
    assert estimate_order(Convergence(h, h**2, ALONE), 2).judgement == "confirmed"


def test_scatter_widens_the_interval_and_stays_confirmed_while_small():
    scatter = np.array([1.0, 1.03, 0.98, 1.02, 0.99])
    estimate = estimate_order(Convergence(H, scatter * H**3, ALONE), 3)
    assert estimate.judgement == "confirmed"
    assert 0.05 < estimate.high - estimate.order < 0.5


@pytest.mark.parametrize("expected", [2, 4])
def test_neighbouring_orders_are_not_confirmed(expected):
    assert estimate_order(Convergence(H, H**3, ALONE), expected).judgement == "pre-asymptotic"


def test_a_wide_interval_confirms_nothing():
    errors = np.array([1.0, 0.1, 0.09, 0.005, 0.0045])
    assert estimate_order(Convergence(H, errors, ALONE), 2).judgement in ("pre-asymptotic", "at the floor")


def test_the_published_slope_of_2_73_is_no_order_3():
    assert estimate_order(Convergence(H, H**2.73, ALONE), 3).judgement == "pre-asymptotic"


def test_an_order_that_is_being_lost_is_not_confirmed_by_its_mean():
    estimate = estimate_order(Convergence(H[:4], 2.0 ** -np.array([0, 2.9, 5.5, 7.8]), ALONE), 3)
    assert estimate.low < 3 < estimate.high
    assert estimate.judgement == "pre-asymptotic"
    assert "order 2.30 at last" in estimate.why


@pytest.mark.parametrize(("share", "judgement"), [(0.09, "confirmed"), (0.1, "at the floor"), (0.5, "at the floor")])
def test_other_errors_must_stay_below_a_tenth(share, judgement):
    others = {"augmentation": share * H[-1] ** 2, "quadrature": 0.01 * H**2}
    assert estimate_order(Convergence(H, H**2, others), 2).judgement == judgement


def test_other_errors_per_mesh():
    others = {"quadrature": 0.05 * H**2}
    assert estimate_order(Convergence(H, H**2, others), 2).judgement == "confirmed"
    others["quadrature"][-1] *= 3
    estimate = estimate_order(Convergence(H, H**2, others), 2)
    assert estimate.judgement == "at the floor"
    assert "quadrature" in estimate.why


@pytest.mark.parametrize(("mesh", "judgement"), [(0, "confirmed"), *((mesh, "at the floor") for mesh in (1, 2, 3, 4))])
def test_the_budget_is_kept_on_every_mesh_of_the_regression(mesh, judgement):
    quadrature = 0.05 * H**2
    quadrature[mesh] *= 3
    assert estimate_order(Convergence(H, H**2, {"quadrature": quadrature}), 2).judgement == judgement


def test_what_falls_too_slowly_all_along_is_at_no_floor():
    assert estimate_order(Convergence(H, H, ALONE), 3).judgement == "pre-asymptotic"


def test_what_stands_still_on_the_finest_mesh_alone_does_not_fall():
    estimate = estimate_order(Convergence(H, [1.0, 0.5, 0.25, 0.125, 0.125], ALONE), 2)
    assert (estimate.judgement, "on the finest mesh" in estimate.why) == ("diverging", True)


def test_a_floor_is_seen_without_a_budget():
    assert estimate_order(Convergence(H, H**4 + 2e-5, ALONE), 4).judgement == "at the floor"


@pytest.mark.parametrize("errors", [np.ones(5), 1 / H, H**2 * 0 + 1e-3, np.array([1, 0.5, 0.25, 0.3, 0.6])])
def test_errors_that_do_not_fall(errors):
    assert estimate_order(Convergence(H, errors, ALONE), 2).judgement in ("diverging", "at the floor")


@pytest.mark.parametrize(
    ("sizes", "errors", "others", "expected"),
    [
        (H[:3], H[:3] ** 2, ALONE, 2),  # three meshes
        ([], [], ALONE, 2),
        (H, H[:4], ALONE, 2),
        (H[:, None], H[:, None], ALONE, 2),
        (H, [1, 0.1, np.nan, 1e-3, 1e-4], ALONE, 2),
        (H, [1, 0.1, np.inf, 1e-3, 1e-4], ALONE, 2),
        (H, [1, 0.1, -1e-2, 1e-3, 1e-4], ALONE, 2),
        (H, -(H**2), ALONE, 2),
        (H, [1, 0.1, 1e-2, 1e-3, 0], ALONE, 2),
        ([0.5, 0.25, 0.3, 0.1, 0.05], H**2, ALONE, 2),  # meshes in no order
        (H[::-1], H[::-1] ** 2, ALONE, 2),  # finest first
        ([0.5, 0.5, 0.25, 0.1, 0.05], H**2, ALONE, 2),
        (1 + 1e-3 * H, H**2, ALONE, 2),  # ratios of one
        ([0.5, 0.25, 0.1, 0, -0.1], H**2, ALONE, 2),
        ([0.5, 0.25, np.nan, 0.06, 0.03], H**2, ALONE, 2),
        (H, H**2, {}, 2),
        (H, H**2, {"penalty": np.nan}, 2),
        (H, H**2, {"penalty": -1e-9}, 2),
        (H, H**2, {"penalty": [0, 0]}, 2),
        (H, H**2, {"quadrature": 0.0}, 2),  # nothing was tightened
        (H, H**2, {"augmentation": 0 * H, "quadrature": 1e-14}, 2),
        (H, H**2, ALONE, 0),
        (H, H**2, ALONE, np.nan),
        (H, ["a"] * 5, ALONE, 2),
        (H, None, ALONE, 2),
    ],
)
def test_what_is_no_sequence_is_invalid(sizes, errors, others, expected):
    estimate = estimate_order(Convergence(sizes, errors, others), expected)
    assert estimate.judgement == "invalid"
    assert estimate.why
    assert np.isnan(estimate.order)


@pytest.mark.parametrize("seed", range(5))
def test_order_and_interval_are_those_of_a_regression(seed: int) -> None:
    x = np.log(H[-4:])
    errors = np.exp(2.7 * x + 0.05 * np.random.default_rng(seed).standard_normal(4))
    line = stats.linregress(x, np.log(errors))
    half = max(stats.t.ppf(0.975, 2) * line.stderr, 0.05)
    estimate = estimate_order(Convergence(H[-4:], errors, {"quadrature": 1e-3 * errors}), 3)
    assert [estimate.order, estimate.low, estimate.high] == pytest.approx([line.slope, line.slope - half, line.slope + half], rel=1e-9)
