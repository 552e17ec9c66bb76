"""Numbers of a green run are made references, and nothing else is."""

import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
from typer.testing import CliRunner

from harness_cases import MATCH
from isomortar.cli.commands import app
from isomortar.errors import InputError
from isomortar.harness import store
from isomortar.harness.collection import find
from isomortar.harness.references import Reference, write_reference


def test_blessing(root):
    family = next(root.glob("family_*"))
    family.joinpath("match.py").write_text(MATCH)
    options = ["--cases", str(root), "--results", "out", "--references", "references", "-j", "1"]
    command = ["bless", f"{family.name}/same", "--reason", "first", *options]
    assert CliRunner().invoke(app, command, input="n\n").exit_code == 1
    assert not Path("references").exists()
    assert CliRunner().invoke(app, [*command, "--yes"]).exit_code == 0
    reference = Reference(Path("references/kept"))
    assert reference.record["class"] == "self"
    assert {"who", "when", "reason", "kernel", "compiler"} <= reference.record.keys()
    assert CliRunner().invoke(app, ["verify", *options]).exit_code == 0
    family.joinpath("match.py").write_text(MATCH.replace("[1.0, 2.0]", "[1.0, 2.5]"))
    store._case_hash.cache_clear()
    shown = CliRunner().invoke(app, command, input="n\n")
    page = Path(f"out/bless-{family.name}-same.html")
    assert shown.output.index(str(page)) < shown.output.index("Make these the reference?")
    assert "Largest difference 0.5" in page.read_text()
    assert page.read_text().count("<svg") == 4
    with h5py.File("references/kept/data.h5", "a") as file:
        file["kind=N1/value"][0] = 1.5
    with pytest.raises(InputError, match="hash"):
        Reference(Path("references/kept"))


@pytest.mark.parametrize("measured", ['"error": 2.0', '"error": None', '"error": float("nan")'])
def test_only_a_green_run_is_blessed(root, measured):
    family = next(root.glob("family_*"))
    family.joinpath("match.py").write_text(MATCH.replace('"error": 0.0', measured))
    with pytest.raises(InputError, match="green"):
        CliRunner().invoke(
            app, ["bless", f"{family.name}/same", "--reason", "x", "--yes", "--cases", str(root), "-j", "1"], catch_exceptions=False
        )


@pytest.mark.parametrize("value", ["[float('nan'), 1.0]", "[]"])
def test_what_can_be_no_reference_is_not_blessed(root, value):
    family = next(root.glob("family_*"))
    family.joinpath("match.py").write_text(MATCH.replace("[1.0, 2.0]", value))
    command = ["bless", f"{family.name}/same", "--reason", "x", "--yes", "--cases", str(root), "--references", "references", "-j", "1"]
    with pytest.raises(InputError, match="no reference"):
        CliRunner().invoke(app, command, catch_exceptions=False)
    assert not Path("references").exists()


def test_over_refined_is_what_has_measured_its_uncertainty(root):
    family = next(root.glob("family_*"))
    family.joinpath("match.py").write_text(MATCH)
    command = ["bless", f"{family.name}/same", "--reason", "x", "--yes", "--class", "over-refined", "--cases", str(root), "-j", "1"]
    command += ["--references", "references"]
    with pytest.raises(InputError, match="'uncertainty', measured by the case"):
        CliRunner().invoke(app, command, catch_exceptions=False)
    assert not Path("references").exists()
    also = MATCH.replace('{"value": M', '{"uncertainty": Bound(at_most=1.0, reason="theory: so"), "value": M')
    family.joinpath("match.py").write_text(also.replace('"error": 0.0', '"error": 0.0, "uncertainty": 1e-3 if kind == "N1" else 1e-12'))
    store._case_hash.cache_clear()
    for name in [name for name in sys.modules if name.startswith("family_")]:
        del sys.modules[name]
    assert CliRunner().invoke(app, command, catch_exceptions=False).exit_code == 0
    kept = Reference(Path("references/kept"))
    assert kept.record["class"] == "over-refined"
    for cell in find(root, f"{family.name}/same").cells:
        assert kept.get(cell, "value").kind == "self"  # compared with the run that made it, it shows change alone
    assert [float(kept._expected[f"kind={kind}/value"].uncertainty) for kind in ("N1", "N2")] == [2e-3, 2e-9]  # the stated 1e-9 at least


@pytest.mark.parametrize("kind", ["exact", "other code"])
def test_what_is_worth_more_than_a_run_is_not_replaced(root, kind):
    family = next(root.glob("family_*"))
    family.joinpath("match.py").write_text(MATCH)
    record = {"title": "t", "class": kind, "origin": "o", "made": "m", "uncertainty": "u"}
    write_reference(Path("references/kept"), {"value": (np.array([1.0]), 0.1)}, record)
    command = ["bless", f"{family.name}/same", "--reason", "x", "--yes", "--cases", str(root), "--references", "references", "-j", "1"]
    with pytest.raises(InputError, match="does not replace"):
        CliRunner().invoke(app, command, catch_exceptions=False)


@pytest.mark.parametrize(("values", "uncertainty"), [([np.nan], 1.0), ([], 1.0), ([1.0], np.nan), ([1.0], -1.0)])
def test_bad_references_are_refused(tmp_path, values, uncertainty):
    record = {"title": "t", "class": "exact", "origin": "o", "made": "m", "uncertainty": "u"}
    with pytest.raises(InputError):
        write_reference(tmp_path / "r", {"value": (np.array(values), uncertainty)}, record)
    write_reference(tmp_path / "good", {"value": (np.array([1.0]), 0.1)}, record)
    with pytest.raises(InputError, match="class"):
        write_reference(tmp_path / "r", {"value": (np.array([1.0]), 0.1)}, {**record, "class": "believed"})
    with pytest.raises(InputError, match="made"):
        write_reference(tmp_path / "r", {"value": (np.array([1.0]), 0.1)}, {**record, "made": " "})
