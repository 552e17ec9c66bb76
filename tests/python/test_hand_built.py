"""Problems that are built in Python are refused as those of scene files are, before any work."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import get_args

import pytest
from told.wrong.contacts import PAIR

from isomortar._arrays import MaterialLaw
from isomortar.errors import InputError
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Face, Problem, Support
from isomortar.scene import Scene
from test_advice import rational


def _without_supports(problem: Problem) -> Problem:
    return replace(problem, supports=())


def _contradicting(problem: Problem) -> Problem:
    top = next(support for support in problem.supports if support.name == "top")
    still = Support("still", top.place, tuple(replace(motion, translate=(0.0, 0.0, 0.0)) for motion in top.motions))
    return replace(problem, supports=(*problem.supports, still))


def _looking_away(problem: Problem) -> Problem:
    return replace(problem, contacts=(replace(problem.contacts[0], slave=Face("upper", "w1")),))


def _twice(problem: Problem) -> Problem:
    return replace(problem, contacts=(*problem.contacts, replace(problem.contacts[0], name="again")))


def _limited_twice(problem: Problem) -> Problem:
    return replace(problem, contacts=(replace(problem.contacts[0], cohesion=0.3, traction_max=0.2),))


def _negative_cohesion(problem: Problem) -> Problem:
    return replace(problem, contacts=(replace(problem.contacts[0], cohesion=-0.3),))


def _in_another_unit(problem: Problem) -> Problem:
    bodies = [replace(body, patch=replace(body.patch, control_points=1e-90 * body.patch.control_points)) for body in problem.bodies]
    return replace(problem, bodies=tuple(bodies))


def _of_far_weights(problem: Problem) -> Problem:
    body = replace(rational(30.0), name="aside")
    held = Support("aside", Face("aside", "w1"), problem.supports[-1].motions)
    return replace(problem, bodies=(*problem.bodies, body), supports=(*problem.supports, held))


def _ring_of_a_box(problem: Problem) -> Problem:
    return replace(problem, bodies=(replace(problem.bodies[0], closed="u"), *problem.bodies[1:]))


def _with_settings(**settings: object) -> Callable[[Problem], Problem]:
    return lambda problem: replace(problem, settings=replace(problem.settings, **settings))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (_without_supports, "is free"),
        (_contradicting, "moves differently"),
        (_looking_away, "looks away|passed through"),
        (_twice, "the same faces"),
        (_limited_twice, "friction would have no say"),
        (_negative_cohesion, r"friction\.parameters: is -0\.3; allowed: numbers not below 0"),
        (_in_another_unit, "unit of length"),
        (_with_settings(method="newton"), "solver.method: is 'newton'; allowed: 'monolithic' or 'uzawa'"),
        (_with_settings(newton_tolerance=0.1), "solver.newton_tolerance: is 0.1; allowed: less than or equal to 0.001"),
        (
            _with_settings(measures=("haste",)),
            "solver.measures.0: is 'haste'; allowed: 'forgiving', 'margin'",
        ),
        (_ring_of_a_box, r"closed: is 'u', but the first and last control points along u differ \(by 0.8, or"),
        (_of_far_weights, r"mesh.quadrature = \[16, 16, 16\]"),
    ],
)
def test_what_a_scene_is_refused_for_a_problem_is(change: Callable[[Problem], Problem], said: str) -> None:
    sound = Scene.from_toml(PAIR).problem()
    Simulation(sound)
    with pytest.raises(InputError, match=said):
        Simulation(change(sound))


@pytest.mark.parametrize("scene", [PAIR, "press"])
@pytest.mark.parametrize("law", get_args(MaterialLaw))
def test_a_problem_without_stages_is_at_rest(scene: str, law: MaterialLaw) -> None:
    """As other programs are given one, to tell what they take to start."""
    given = (Scene.load(scene) if scene == "press" else Scene.from_toml(scene)).problem()
    bodies = tuple(replace(body, material=replace(body.material, law=law)) for body in given.bodies)
    supports = tuple(replace(support, motions=()) for support in given.supports)
    assert list(Simulation(replace(given, bodies=bodies, supports=supports, stages=())).run()) == []
