"""What commands tell that compute nothing: of scenes, of results files, of the program and of themselves."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import h5py
import pytest

import isomortar
from command_lines import SMALL, Invoke, last, settings
from isomortar.results.files import sealed
from isomortar.results.writer import ResultsWriter
from isomortar.solve.record import StepResult


def test_listings(invoke: Invoke) -> None:
    code, out, _ = invoke("scenes")
    assert code == 0
    assert re.search(r"^iron +Ironing a deformable base$", out, re.MULTILINE)
    code, out, _ = invoke("schema")
    assert code == 0
    assert "bodies" in json.loads(out)["required"]
    assert invoke("--version")[1] == f"isomortar {isomortar.__version__}\n"


def test_a_scene_is_looked_at_before_it_is_computed(invoke: Invoke) -> None:
    """Its words, its numbers, what is doubtful of it, and what it would be refused for; no file is written."""
    code, out, err = invoke("check", "tire")
    assert (code, err) == (0, "")
    assert out.splitlines() == [
        "tire: 2160 unknowns, 100 load steps, about 0.037 GB of memory (within a factor of two)",
        "body tire: neo-hookean of Young's modulus 10 and Poisson's ratio 0.3, 1 x 0.25 x 1 in size; 32 x 4 x 4 elements of N2 x N1 x N1, "
        "0.0625 to 0.103 long, 925 control points, weights 0.854 to 1",
        "contact road: slave tire.v1, master a rigid plane; along the plane's normal, mortar, 3072 quadrature points; at the start they "
        "are about 0.001 apart",
        "support rim: prescribes x, y, z of tire.v0; goes 2.31 and turns by 270 degrees",
        "0 warnings, nothing computed",
    ]
    code, out, _ = invoke("check", "press", "--set", "contacts.floor.plane.point=[0,0,0.2]", "--json")
    found = json.loads(out)
    assert (code, found["unknowns"], found["contacts"][0]["apart"]) == (0, 4116, pytest.approx(-0.2, abs=1e-3))
    assert [warning.split(": ")[1][:23] for warning in found["warnings"]] == ["the bodies overlap by 0"]
    code, out, _ = invoke("check", "press", "--set", "contacts.floor.plane.point=[0,0,0.2]")
    assert out.splitlines()[-2].startswith("warning: contact 'floor': the bodies overlap by 0.2 at the start")
    assert out.splitlines()[-1] == "1 warning, nothing computed"
    code, out, err = invoke("check", "press", "--set", "materials.rubber.poisson=0.5")
    assert (code, out) == (2, "")
    assert err.startswith("isomortar: materials.rubber.poisson: is 0.5")
    assert not any(Path().iterdir())


def test_a_results_file_tells_what_it_holds(invoke: Invoke) -> None:
    """Half of a run and the whole of it; its numbers are those of the file."""
    short = [*settings(SMALL), "--set", "stages.press.steps=2"]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("isomortar.results.writer.ResultsWriter.recorded", _until(1))
        assert invoke("run", "press", *short, "--output", "half a run.h5")[0] == 3
    code, out, _ = invoke("info", "half a run.h5")
    assert code == 0
    assert out.splitlines()[1].startswith("1 of 2 load steps (press 1 of 2), 1 with their state; ")
    assert out.splitlines()[-1] == "not at its end: isomortar run SCENE --resume --output 'half a run.h5' goes on"
    assert invoke("run", "press", *short, "--output", "half a run.h5", "--resume")[0] == 0
    code, out, _ = invoke("info", "half a run.h5", "--json")
    found = json.loads(out)
    end = last("half a run.h5")
    assert (code, found["name"], found["recorded"], found["stages"]) == (0, "press", 2, {"press": [2, 2]})
    assert found["unknowns"] == json.loads(invoke("check", "press", *short, "--json")[1])["unknowns"]
    assert found["supports"] == [
        {
            "name": name,
            "force": list(reaction.force),
            "moment": list(reaction.moment),
            "displacement": list(reaction.displacement),
            "rotation": reaction.rotation,
        }
        for name, reaction in zip(("top",), end.reactions, strict=True)
    ]
    (contact,) = found["contacts"]
    assert (contact["name"], contact["active"], contact["slip"]) == ("floor", end.contacts[0].active, end.contacts[0].slip)
    assert contact["pressure"] == list(end.contacts[0].pressure_field)
    assert contact["penetration"] == max(end.contacts[0].gap)
    text = invoke("info", "half a run.h5")[1]
    assert f"contact floor: {contact['active']} of {contact['constraints']} constraints active" in text
    assert "not at its end" not in text
    with h5py.File("half a run.h5", "r+") as file:
        file["curves/cuts"][...], file["timings/total"][...] = [2, 1], [3.0, 4.5]
    Path("half a run.h5").write_bytes(sealed(Path("half a run.h5").read_bytes()))
    of_all = json.loads(invoke("info", "half a run.h5", "--json")[1])
    assert (of_all["cuts"], of_all["cpu_seconds"]) == (3, 7.5)
    assert invoke("info", "none.h5")[0] == 1
    assert "isomortar info 'half a run.h5' says what it holds" in invoke("check", "half a run.h5")[2]


def test_a_results_file_tells_of_loads(invoke: Invoke) -> None:
    text = """format = 1
    bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 2] }
    supports.bed.face = "block.w0"
    loads.own = { body = "block", weight = [0, 0, -0.25] }
    stages = [{ name = "settle", steps = 1 }]"""
    Path("own.toml").write_text(text)
    assert invoke("run", "own.toml", "--output", "own.h5", "--quiet")[0] == 0
    (line,) = [line for line in invoke("info", "own.h5")[1].splitlines() if line.startswith("load ")]
    assert line.startswith("load own: force (0, 0, -0.5), moment (-0.25, 0.25, 0)")
    (load,) = json.loads(invoke("info", "own.h5", "--json")[1])["loads"]
    assert (load["name"], load["force"]) == ("own", pytest.approx([0, 0, -0.5], abs=1e-15))


def test_a_results_file_tells_what_is_of_the_whole(invoke: Invoke) -> None:
    """Of a quarter with its forces; without symmetry nothing is said."""
    text = """format = 1
    bodies.block.geometry = { kind = "box", lower = [-1, -1, 0], upper = [1, 1, 2] }
    bodies.block.mesh = { order = 2, elements = 2 }
    supports.bed.face = "block.w0"
    loads.own = { body = "block", weight = [0, 0, -0.25] }
    stages = [{ name = "settle", steps = 1 }]"""
    Path("own.toml").write_text(text)
    said = "the part above the plane x = 0 and the plane y = 0 is computed, one of 4: forces and moments are the whole's, unknowns and "
    for name, more, told in (("whole", [], []), ("quarter", ["--set", "symmetry={ x = 0.0, y = 0.0 }"], [said + "constraints the part's"])):
        assert invoke("run", "own.toml", "--output", f"{name}.h5", "--quiet", *more)[0] == 0
        lines = invoke("info", f"{name}.h5")[1].splitlines()
        assert [line for line in lines if line.startswith("the part")] == told
        (load,) = (line for line in lines if line.startswith("load "))
        assert load.startswith("load own: force (0, 0, -2), ")
    assert json.loads(invoke("info", "quarter.h5", "--json")[1])["symmetry"] == ["the plane x = 0", "the plane y = 0"]


def test_pressures_are_told_per_area_at_rest(invoke: Invoke) -> None:
    """A block that widens freely under its load: pressure times area at rest is the force, and stress times the area that it has then."""
    text = """format = 1
    materials.rubber = { young = 5.0, poisson = 0.3 }
    bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 1, 1] }
    bodies.block.mesh = { order = 2, elements = 1 }
    contacts.floor = { slave = "block.w0", plane = {}, friction = 0 }
    supports.top = { face = "block.w1", components = ["z"] }
    supports.x = { face = "block.u0", components = ["x"] }
    supports.y = { face = "block.v0", components = ["y"] }
    stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.3] }]"""
    Path("block.toml").write_text(text)
    assert invoke("run", "block.toml", "--output", "block.h5", "--quiet")[0] == 0
    (line,) = [line for line in invoke("info", "block.h5")[1].splitlines() if line.startswith("contact ")]
    found = re.search(r"pressures (\S+) to (\S+) per area at rest", line)
    assert found
    force = last("block.h5").contacts[0].force_slave[2]
    assert [2.0 * float(pressure) for pressure in found.groups()] == pytest.approx([force] * 2, rel=1e-3)
    corner = last("block.h5").state.positions.max(axis=0)
    assert corner[0] * corner[1] > 1.2 * 2.0


def _until(last: int) -> Callable[[ResultsWriter, StepResult], None]:
    """Recording of load steps up to one; the next one is a fault of the program."""
    recorded = ResultsWriter.recorded

    def until(writer: ResultsWriter, result: StepResult) -> None:
        assert result.step <= last
        recorded(writer, result)

    return until


def test_the_doctor_tells_what_is_there_and_whether_it_is_right(invoke: Invoke, monkeypatch: pytest.MonkeyPatch) -> None:
    code, out, _ = invoke("doctor")
    assert code == 0
    assert all(word in out for word in (f"isomortar {isomortar.__version__} in ", "numpy ", "libumfpack", "GCC: (", "all is well"))
    assert [line[:5] for line in out.splitlines()[4:-1]] == ["right"] * 2
    monkeypatch.setattr("isomortar.cli.doctor.BALANCE", 0.0)
    code, out, _ = invoke("doctor")
    assert code == 1
    assert "WRONG  6 load steps of twist run and read back" in out
    assert out.splitlines()[-1].startswith("1 of these are wrong")


@pytest.mark.parametrize("command", ["run", "check", "info", "doctor", "plot", "export", "check-tangent", "schema"])
def test_help_shows_an_example(invoke: Invoke, command: str) -> None:
    code, out, _ = invoke(command, "--help")
    assert code == 0
    assert f"isomortar {command}" in out.partition("example")[2]
