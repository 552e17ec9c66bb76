"""The sections of the paper: every scene builds, in full and quick, and control points are those that the paper counts."""

import shlex

import pytest
from paper.catalogue import chosen
from paper.findings import STATEMENTS
from paper.sections import METHODS, PAPER_METHOD, Section

from isomortar.errors import InputError
from isomortar.model.numbering import Numbering
from isomortar.scene import Scene

FULL = {section.scene: section for section in chosen((), False)}


def control_points(section: Section, name: str) -> list[int]:
    """Of each body, shared ones once."""
    problem = section.load(section.variant(name), "paper").problem()
    return [len(set(points.tolist())) for points in Numbering(problem).points.values()]


@pytest.mark.parametrize("quick", [False, True])
def test_every_scene_of_every_run_builds(quick):
    for section in chosen((), quick):
        for variant in section.variants:
            for method in variant.methods:
                problem = section.load(variant, method).problem()
                assert problem.settings.method == ("uzawa" if method == "paper" else "monolithic")
                assert problem.settings.slip_sum == ("paper" if method == "paper" else "local")


@pytest.mark.parametrize("quick", [False, True])
def test_names_are_found(quick):
    for section in chosen((), quick):
        names = [variant.name for variant in section.variants]
        assert len(set(names)) == len(names)
        assert {section.reference, *(name for series in section.series.values() for name in series)} <= set(names)
        assert section.names("reference") == ("reference",)
        assert section.variant("reference").name == section.reference
        assert section.names("N9") == ()
        steps = section.load(section.variants[0], "monolithic").problem().total_steps
        assert max(section.instances) <= steps


def test_control_points_of_the_dragging_study_are_the_papers():
    counts = {name: sum(control_points(FULL["iron"], name)) for name in ("N5", "A", "B")}
    assert counts == {"N5": 770, "A": 840, "B": 1015}


def test_control_points_that_studies_match():
    twist, tire, press = FULL["twist"], FULL["tire"], FULL["press"]
    assert control_points(twist, "coarse") == control_points(twist, "N2")
    assert control_points(twist, "slave-L1")[0] == control_points(twist, "slave-L2")[0] == 5 * 5 * 4
    assert len({tuple(control_points(press, f"L{p}")) for p in (1, 2, 3, 4)}) == 1
    assert [control_points(tire, f"L{p}")[0] for p in (1, 2, 4)] == [32 * 25] * 3
    assert [control_points(tire, f"N{p}")[0] for p in (2, 3, 4)] == [36 * 25, 40 * 25, 44 * 25]
    assert [control_points(tire, f"L{p}-matched")[0] for p in (1, 2, 4)] == [36 * 25, 40 * 25, 48 * 25]


def test_settings_of_the_papers_method():
    section = FULL["twist"]
    settings = section.load(section.variant("soft-tolerance"), "paper").problem().settings
    assert (settings.augmentation_norm, settings.penalty_growth, settings.augmentation_tolerance) == ("paper", 1.0, 0.001)
    assert (settings.penalty_normal, settings.penalty_tangential) == (10.0, 1.0)
    assert section.load(section.variant("N2"), "paper").problem().settings.augmentation_tolerance == 0.01
    assert [stage.steps for stage in section.load(section.variant("more-steps"), "paper").problem().stages] == [15, 60]
    assert section.load(section.variant("ten-points"), "paper").problem().contacts[0].quadrature == (10, 10)


def test_a_command_runs_the_same_scene_alone():
    section = FULL["iron"]
    words = shlex.split(section.command(section.variant("slave-L2"), "paper"))
    changes = [words[n + 1] for n, word in enumerate(words) if word == "--set"]
    assert words[:3] == ["isomortar", "run", "iron"]
    assert set(PAPER_METHOD) <= set(changes)
    assert Scene.load("iron", changes).to_toml() == section.load(section.variant("slave-L2"), "paper").to_toml()


def test_lagrange_runs_are_told():
    section = FULL["iron"]
    assert [variant.name for variant in section.variants if variant.lagrange] == [
        "L1",
        "L2",
        "L1-averaged",
        "L2-averaged",
        "slave-L1",
        "slave-L2",
    ]


def test_studies_are_chosen_by_name():
    assert [section.scene for section in chosen(["iron", "press"], False)] == ["press", "iron"]
    with pytest.raises(InputError, match="allowed: press, twist, iron, tire"):
        chosen(["pres"], False)


def test_every_statement_has_its_runs_a_limit_and_a_reason():
    for statement in STATEMENTS:
        assert statement.concerns(tuple(FULL.values())), statement.text
        assert (statement.at_most is None) != (statement.at_least is None), statement.text
        assert statement.reason.startswith(("“", "grey zones")), statement.text
        assert set(statement.methods) <= set(METHODS)
        pairs = [(FULL[scene], entry) for scene, entry in (key.split("-", 1) for key in statement.needs)]
        planned = [set(section.variant(name).methods) for section, entry in pairs for name in section.names(entry)]
        assert all(set(statement.methods) <= methods for methods in planned), f"judged by fewer methods than it says: {statement.text}"
    assert len({statement.text for statement in STATEMENTS}) == len(STATEMENTS)


def test_a_study_alone_leaves_the_statements_about_others_out():
    sections = {statement.section for statement in STATEMENTS if statement.concerns((FULL["press"],))}
    assert sections == {"4.2"}
