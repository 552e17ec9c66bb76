"""What the paper's statements measure, on curves and fields made by hand, and how they are judged."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from paper import measures
from paper.catalogue import chosen
from paper.findings import STATEMENTS
from paper.outcome import Outcome, Outcomes
from paper.page import Report
from paper.sections import METHODS
from paper.settled import Settled, settled_curves
from paper.statements import Evidence, Statement, ratio, successive

from isomortar.harness.statement import NotMeasuredError

SECTIONS = {section.scene: section for section in chosen((), False)}
IRON = SECTIONS["iron"]
PRESSED, DRAGGED = 10, 40


def outcome(name: str, values, method="monolithic", failure="", lost=False, **numbers) -> Outcome:
    """A run of the dragging section whose force along x is `values` in the drag and zero before."""
    n = len(values)
    force = np.zeros((PRESSED + n, 3))
    force[PRESSED:, 0] = values
    plain = {
        "step": np.arange(1, PRESSED + n + 1).tolist(),
        "time": np.arange(1.0, PRESSED + n + 1).tolist(),
        "stage": [0.0] * PRESSED + [1.0] * n,
        "share": [*(np.arange(1, PRESSED + 1) / PRESSED), *(np.arange(1, n + 1) / DRAGGED)],
        "force": force.tolist(),
        "moment": np.zeros_like(force).tolist(),
        "pressure": [[0.0, 1.0]] * (PRESSED + n),
        "cuts": 0.0,
        "augmentations": 1.0,
        "control_points": 770.0,
    }
    return Outcome(IRON, IRON.variant(name), method, Path("none.h5"), failure, lost, plain | numbers)


STEPS = np.arange(1, DRAGGED + 1)


def test_the_window_is_a_share_of_the_last_stage():
    run = outcome("N2", STEPS.astype(float))
    assert run.array("step")[run.window].tolist() == list(range(20, 51))
    assert measures.mean(run) == 25.0
    assert run.total_steps == 50


def test_second_difference_of_a_parabola_and_of_a_zigzag():
    assert measures.rms_second_difference(outcome("N2", 0.5 * STEPS**2.0)) == pytest.approx(1.0, rel=1e-12)
    assert measures.rms_second_difference(outcome("N2", 3.0 * STEPS)) == pytest.approx(0.0, abs=1e-12)
    assert measures.rms_second_difference(outcome("N2", (-1.0) ** STEPS)) == pytest.approx(4.0, rel=1e-12)


def test_deviation_of_known_curves_and_over_other_load_steps():
    one, two = outcome("N2", np.full(DRAGGED, 1.0)), outcome("N3", np.full(DRAGGED, 1.1))
    assert measures.deviation(two, one) == pytest.approx(0.1, rel=1e-12)
    line = outcome("N2", STEPS / DRAGGED)
    coarse = replace(
        line, numbers={**line.numbers, **{k: line.numbers[k][:11] + line.numbers[k][11::2] for k in ("share", "stage", "force")}}
    )
    assert measures.deviation(coarse, line) == pytest.approx(0.0, abs=1e-12)


def test_distance_from_an_over_refined_curve():
    settled = Settled(np.concatenate([np.full(PRESSED, 7.0), np.full(DRAGGED, 2.0)]), 0.001)
    assert settled.distance(outcome("N2", np.full(DRAGGED, 2.1))) == pytest.approx(0.05, rel=1e-12)
    assert settled.distance(outcome("N2", np.full(DRAGGED, 2.1), failure="it folded")) is None
    assert Settled(np.ones(5), 0.001).distance(outcome("N2", np.full(DRAGGED, 2.1))) is None


def test_stored_curves_are_of_the_studies_and_settled_far_below_what_is_compared():
    found = settled_curves(Path(__file__).parents[2] / "reference_data")
    assert set(found) == set(SECTIONS) - {"iron"}
    for scene, settled in found.items():
        section = SECTIONS[scene]
        assert len(settled.curve) == section.load(section.variants[0], "monolithic").problem().total_steps
        assert 0 < settled.uncertainty <= 0.02


def test_without_references_there_are_no_settled_curves(tmp_path):
    assert settled_curves(tmp_path) == {}


def test_ripple_is_what_a_cubic_does_not_follow():
    cubic = 1e-4 * (STEPS - 20.0) ** 3 + STEPS
    assert measures.ripple(outcome("N2", cubic)) == pytest.approx(0.0, abs=1e-10)
    wave = 0.1 * np.sin(2 * np.pi * 7 * np.arange(DRAGGED) / 31)
    assert measures.ripple(outcome("N2", cubic + wave)) == pytest.approx(0.1 / math.sqrt(2), rel=0.02)
    assert measures.cycles(outcome("N2", cubic + wave)) == 7


def test_negative_pressure_over_the_peak():
    assert measures.negative_share(outcome("N2", STEPS, pressure=[[0.0, 4.0], [-1.0, 2.0]])) == 0.25
    assert measures.negative_share(outcome("N2", STEPS, pressure=[[0.5, 4.0]])) == 0.0


def test_variation_of_a_hump_and_of_waves_on_it():
    x = np.linspace(0.0, 1.0, 65)
    hump = np.sin(np.pi * x)[:, None] * np.sin(np.pi * x)[None, :]
    assert measures.excess_variation(hump, hump) == 0.0
    assert measures.excess_variation(3 * hump, hump) == pytest.approx(2.0, rel=1e-12)
    assert measures.excess_variation(np.where(hump > 0.5, 0.5, hump), hump) < 0.0
    assert measures.excess_variation(hump + 0.1 * np.sin(40 * np.pi * x)[None, :], hump) > 0.5
    assert measures.excess_variation([[0.0, 1.0], [0.0, 1.0]], [[0.0, 2.0], [0.0, 2.0]]) == -0.5


def test_field_deviation_weighs_with_areas():
    assert measures.field_deviation([[1.0, 2.0]], [[1.0, 1.0]], [3.0, 1.0]) == 0.5


def evidence(*outcomes: Outcome, method="monolithic") -> Evidence:
    return Evidence(Outcomes((IRON,), outcomes), method)


def smoother() -> Statement:
    return next(s for s in STATEMENTS if s.text.startswith("The dragging force gets smoother"))


def dragged(**amplitudes: float) -> list[Outcome]:
    return [outcome(name, 1 + a * (-1.0) ** STEPS, method) for name, a in amplitudes.items() for method in ("monolithic", "paper")]


def test_a_statement_holds_or_does_not_and_says_by_how_much():
    judged = smoother().judge(Outcomes((IRON,), tuple(dragged(N2=0.4, N3=0.2, N4=0.1, N5=0.05))))
    assert judged.state == "holds"
    assert judged.verdicts[0].values == pytest.approx({"N3 / N2": 0.5, "N4 / N3": 0.5, "N5 / N4": 0.5})
    judged = smoother().judge(Outcomes((IRON,), tuple(dragged(N2=0.4, N3=0.2, N4=0.3, N5=0.05))))
    assert judged.state == "does not hold"
    assert [v.state for v in judged.verdicts] == ["does not hold"] * 2


def test_a_statement_without_one_of_its_runs_is_not_measured():
    runs = dragged(N2=0.4, N3=0.2, N4=0.1, N5=0.05)
    runs[2] = replace(runs[2], failure="load step 43 does not converge")
    judged = smoother().judge(Outcomes((IRON,), tuple(runs)))
    assert [v.state for v in judged.verdicts] == ["not measured", "holds"]
    assert judged.state == "partly measured"  # by one of the two methods
    runs = [replace(run, failure="load step 43 does not converge") if run.variant.name == "N3" else run for run in runs]
    judged = smoother().judge(Outcomes((IRON,), tuple(runs)))
    assert judged.state == "not measured"
    assert judged.verdicts[0].why == "iron-N3 failed: load step 43 does not converge"


def test_numbers_that_are_not_finite_are_not_measured():
    runs = dragged(N2=0.4, N3=math.nan, N4=0.1, N5=0.05)
    judged = smoother().judge(Outcomes((IRON,), tuple(runs)))
    assert judged.state == "not measured"
    assert "N3 / N2" in judged.verdicts[0].why
    runs = dragged(N2=0.4, N3=0.2, N4=0.1, N5=0.05)
    one = [outcome("N3", math.nan * STEPS, "paper") if (r.variant.name, r.method) == ("N3", "paper") else r for r in runs]
    assert smoother().judge(Outcomes((IRON,), tuple(one))).state == "partly measured"  # its runs came to their end


def rises() -> Statement:
    """Of Lagrange elements, of which some may fail."""
    return Statement(
        "4.4", "It rises.", ("iron-Lagrange",), lambda runs: successive(runs.series("iron-Lagrange"), measures.mean), "", "", at_least=1.0
    )


@pytest.mark.parametrize(("last", "state"), [(4.0, "partly measured"), (1.0, "does not hold")])
def test_a_series_of_which_some_failed_does_not_hold_but_may_be_broken(last, state):
    levels = dict(zip(IRON.series["Lagrange"], (1.0, 2.0, 3.0, last), strict=True))
    runs = [outcome(name, np.full(DRAGGED, v), method) for name, v in levels.items() for method in ("monolithic", "paper")]
    assert rises().judge(Outcomes((IRON,), tuple(runs))).state == ("holds" if last == 4.0 else state)
    runs = [replace(run, failure="load step 43 does not converge") if run.variant.name == "L2" else run for run in runs]
    judged = rises().judge(Outcomes((IRON,), tuple(runs)))
    assert judged.state == state
    assert judged.verdicts[0].values.keys() == {"slave-L1 / L1", "slave-L2 / slave-L1"}
    assert judged.verdicts[0].why == "without iron-L2, which failed: load step 43 does not converge"


def test_what_holds_by_one_method_and_partly_by_the_other_is_partly_measured():
    runs = [outcome(n, np.full(DRAGGED, 1.0 + k), m) for k, n in enumerate(IRON.series["Lagrange"]) for m in ("monolithic", "paper")]
    runs[0] = replace(runs[0], failure="load step 43 does not converge")
    judged = rises().judge(Outcomes((IRON,), tuple(runs)))
    assert [v.state for v in judged.verdicts] == ["partly measured", "holds"]
    assert judged.state == "partly measured"


@pytest.mark.parametrize(
    ("failure", "lost", "state"),
    [
        ("load step 43 does not converge", False, "holds"),
        ("the process was ended by SIGKILL", True, "not measured"),
        ("", False, "does not hold"),
    ],
)
def test_only_a_run_that_does_not_converge_needs_a_treatment(failure, lost, state):
    """A crash, a lack of time or of memory is the machine's, no finding of the paper."""
    twist = SECTIONS["twist"]
    statement = next(s for s in STATEMENTS if "need a special treatment" in s.text)
    short = {name: value[: 35 if failure else None] for name, value in outcome("N2", STEPS).numbers.items() if isinstance(value, list)}
    runs = [
        Outcome(twist, twist.variant(name), method, Path("none.h5"), failure, lost, short) for name in ("L1", "L2") for method in METHODS
    ]
    judged = statement.judge(Outcomes((twist,), tuple(runs)))
    assert judged.state == state
    report = Report(Outcomes((twist,), tuple(runs)), (judged,), 0, False, None, {})
    assert report.complete is not lost


@pytest.mark.parametrize("statement", STATEMENTS, ids=lambda s: s.text[:40])
def test_no_statement_is_measured_on_what_a_machine_lost(statement):
    """Whatever a statement does with runs that fail: one that crashed or ran out of time says nothing, so that none of it is judged."""
    sections = tuple(SECTIONS.values())
    crashed = [
        Outcome(section, variant, method, Path("none.h5"), "the process was ended by SIGKILL", True, {})
        for section in sections for variant in section.variants for method in variant.methods
    ]  # fmt: skip
    assert statement.judge(Outcomes(sections, tuple(crashed))).state == "not measured"


def test_of_lagrange_elements_those_that_ended_count_if_there_are_two():
    runs = [outcome(n, np.full(DRAGGED, 1.0)) for n in ("L1", "L2", "slave-L1", "slave-L2")]
    runs[0] = replace(runs[0], failure="no")
    assert [o.variant.name for o in evidence(*runs).series("iron-Lagrange")] == ["L2", "slave-L1", "slave-L2"]
    failed = [replace(run, failure="no") for run in runs[:3]]
    with pytest.raises(NotMeasuredError, match="iron-L1 failed: no; iron-L2 failed: no"):
        evidence(*failed, runs[3]).series("iron-Lagrange")


def test_quotients():
    runs = [outcome(name, np.full(DRAGGED, value)) for name, value in (("N2", 1.0), ("N3", 3.0), ("N4", 6.0))]
    assert successive(runs, measures.mean) == {"N3 / N2": 3.0, "N4 / N3": 2.0}
    assert ratio(runs[0], runs[2], measures.mean) == {"N2 / N4": pytest.approx(1 / 6)}
    assert ratio(runs[0], runs[2], measures.ripple).keys() == {"N2 / N4"}
    zero = outcome("N2", np.zeros(DRAGGED))
    assert math.isnan(ratio(zero, zero, measures.mean)["N2 / N2"])
    assert ratio(runs[0], zero, measures.mean)["N2 / N2"] == math.inf


def report(*outcomes: Outcome, judgements=()) -> Report:
    return Report(Outcomes((IRON,), outcomes), tuple(judgements), 0, False, None, {})


def test_complete_is_a_report_without_a_failed_nurbs_run_or_a_gap_in_the_table():
    failed = replace(outcome("L1", STEPS), failure="no")
    assert report(outcome("N2", STEPS), failed).complete
    assert not report(outcome("N2", STEPS), replace(failed, lost=True)).complete
    assert not report(replace(outcome("N2", STEPS), failure="no"), failed).complete
    runs = [replace(run, failure="no") if run.variant.name == "N3" else run for run in dragged(N2=0.4, N3=0.2, N4=0.1, N5=0.05)]
    assert not report(judgements=[smoother().judge(Outcomes((IRON,), tuple(runs)))]).complete
