"""Runs at the extremes: every way in which a run can end is told from the others, by programs made to end so."""

import math
import os
import sys
import textwrap

import pytest
from extremes.endings import Ending, digits, endings, judge
from extremes.trials import Trial, program, run

from isomortar.harness.cases import Bound, Shown, Words, case
from isomortar.harness.compare import judge as verdicts
from isomortar.harness.measurement import Measurement, measure, stored

#: Begins like the program: reads where its results are to go; `keep` leaves that many load steps there.
_PREAMBLE = """
import h5py, os, signal, sys, time
def keep(steps, force=1.0):
    with h5py.File(sys.argv[sys.argv.index("--output") + 1], "w") as file:
        file["curves/step"] = list(range(1, steps + 1))
        file["curves/supports/top/force"] = [[0.0, 0.0, force]] * steps
def say(text):
    print(text, file=sys.stderr)
"""
ENDINGS = {
    "right": ("keep(2)", Ending.RIGHT),
    "not finite": ("keep(2, float('nan'))", Ending.WRONG),
    "no results": ("pass", Ending.WRONG),
    "off without a word": ("keep(2, 1.01)", Ending.WRONG),
    "off, warned of something else": ("keep(2, 1.01); say('warning: it rains')", Ending.WRONG),
    "off with a warning": ("keep(2, 1.01); say('warning: poisson is close to 0.5')", Ending.WARNED),
    "refused": ("say('isomortar: materials.m.poisson: is too close to 0.5'); sys.exit(2)", Ending.REFUSED),
    "refused for another cause": ("say('isomortar: bodies.b.mesh: no'); sys.exit(2)", Ending.WRONG),
    "refused after work": ("keep(1); say('isomortar: poisson is too close to 0.5'); sys.exit(2)", Ending.WRONG),
    "stopped": ("keep(2); say('isomortar: load step 3 does not converge: poisson locks'); sys.exit(1)", Ending.STOPPED),
    "stopped at once": ("say('isomortar: load step 1 does not converge: poisson locks'); sys.exit(1)", Ending.STOPPED),
    "stopped, steps lost": ("keep(1); say('isomortar: load step 3 does not converge: poisson locks'); sys.exit(1)", Ending.WRONG),
    "stopped for another cause": ("say('isomortar: load step 1 does not converge: it rains'); sys.exit(1)", Ending.WRONG),
    "stopped without a word": ("sys.exit(1)", Ending.WRONG),
    "traceback": ("raise ValueError('poisson')", Ending.WRONG),
    "crash": ("say('poisson'); os.kill(os.getpid(), signal.SIGSEGV)", Ending.WRONG),
    "waits for ever": ("say('poisson'); time.sleep(60)", Ending.WRONG),
    "computes for ever": ("say('poisson')\nwhile True: pass", Ending.WRONG),
    "out of memory": ("bytearray(1 << 34)", Ending.WRONG),
    "another exit code": ("say('isomortar: poisson'); sys.exit(3)", Ending.WRONG),
}


def _found(done: Trial) -> float:
    return digits(done.force("top"), [[0.0, 0.0, 1.0]] * 2) if done.steps else math.nan


@pytest.mark.parametrize("name", ENDINGS)
def test_every_ending_is_told(name, tmp_path):
    words, ending = ENDINGS[name]
    script = tmp_path / "program.py"
    script.write_text(textwrap.dedent(_PREAMBLE) + words)
    with program([sys.executable, str(script)]):
        measured = judge(run(f"# {name}", seconds=1 if "for ever" in name else 20), _found, needed=6.0, causes=["poisson"])
    assert Ending(measured["ending"]) is ending, measured["words"]
    assert bool(measured["words"].text) == (ending is not Ending.RIGHT)


def test_without_a_cause_it_has_to_be_right():
    assert judge(Trial(2, "isomortar: no"), _found, needed=6.0)["ending"] == Ending.WRONG
    assert judge(Trial(1, "isomortar: load step 1: no"), _found, needed=6.0)["ending"] == Ending.WRONG


def test_the_program_that_runs_is_this_one():
    refused = run("format = 1")
    assert refused.code == 2
    assert "isomortar: " in refused.said
    assert os.environ.get("OMP_NUM_THREADS") or refused.steps is None


@pytest.mark.parametrize(
    ("values", "right", "expected"),
    [
        ([1.0], [1.0], 16.0),
        ([1.001], [1.0], 3.0),
        ([1e300, 0.0], [1e300, 1e297], 3.0),
        ([math.nan], [1.0], math.nan),
        ([1.0], [1.0, 2.0], math.nan),
    ],
)
def test_digits_of_the_largest_error(values, right, expected):
    assert digits(values, right) == pytest.approx(expected, abs=1e-6, nan_ok=True)


@pytest.mark.parametrize(("ending", "inside", "outside"), [(4.0, True, True), (3.0, False, True), (1.0, False, True), (0.0, False, False)])
def test_only_right_passes_where_that_is_claimed(ending, inside, outside):
    for right, passes in ((True, inside), (False, outside)):
        made = case(claim="So.", bounds=endings(right))(lambda: None)
        measurement = Measurement("measured", {"ending": ending, "digits": 0.0, "words": stored(Words("so it is"))})
        checks = verdicts(made.cells[0], measurement, lambda *_: None)
        assert all(check.state == "passed" for check in checks) is passes


def test_words_are_shown_and_claim_nothing():
    def said() -> dict[str, object]:
        return {"words": Words("so it is"), "number": Words("five")}

    claims = {"words": Shown("to see"), "number": Bound(at_most=5.0, reason="theory: so")}
    made = case(claim="So.", bounds=claims)(said)
    checks = verdicts(made.cells[0], measure(made.cells[0]), lambda *_: None)
    assert [(check.state, check.found) for check in checks] == [("passed", "so it is"), ("failed", "words, not numbers")]
