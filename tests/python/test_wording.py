"""Words are compared with a reference line by line, numbers in them as numbers, and are blessed like numbers."""

import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from isomortar.cli.commands import app
from isomortar.harness import store
from isomortar.harness.references import Reference
from isomortar.harness.wording import reworded

OLD = "force (1.5, -3e-14, 2)\n3 warnings of v1\nthe end"
SAID = '''
from isomortar.harness import Matches, Words, case

@case(claim="As before.", bounds={"said": Matches("kept", "reference: as it was", allowance=1e-6)}, grid={"kind": ["N1", "N2"]})
def same(kind):
    return {"said": Words(f"a line of {kind}\\nforce 2.5")}
'''  # fmt: skip


@pytest.mark.parametrize(
    ("new", "told"),
    [
        (OLD, []),
        (OLD.replace("1.5", "1.5000001").replace("-3e-14", "2.2e-13"), []),
        (OLD.replace("1.5", "1.50001"), ["force ... was '(1.5, -3e-14, 2)', is '(1.50001, -3e-14, 2)'"]),
        (OLD.replace("3 w", "4 w"), [" ... was '3 warnings of v1', is '4 warnings of v1'"]),
        (OLD.replace("v1", "v0"), ["3 warnings of ... was 'v1', is 'v0'"]),
        (OLD.replace("(1.5", "(nan"), ["force ... was '(1.5, -3e-14, 2)', is '(nan, -3e-14, 2)'"]),
        (OLD.replace("(1.5", "(-1.5"), ["force ... was '(1.5, -3e-14, 2)', is '(-1.5, -3e-14, 2)'"]),
        (OLD + "\nmore", ["new: more"]),
        (OLD.replace("3 warnings of v1\n", ""), ["gone: 3 warnings of v1"]),
    ],
)
def test_what_is_not_as_it_was_is_told(new, told):
    assert reworded(OLD, new, 1e-6) == told


def test_words_are_blessed_and_held(root):
    family = next(root.glob("family_*"))
    family.joinpath("match.py").write_text(SAID)
    options = ["--cases", str(root), "--results", "out", "--references", "references", "-j", "1"]
    command = ["bless", f"{family.name}/same", "--reason", "first", *options]
    verify = ["verify", "--case", f"{family.name}/same", *options]
    assert "has no such dataset" in CliRunner().invoke(app, verify).output
    assert CliRunner().invoke(app, [*command, "--yes"]).exit_code == 0
    assert Reference(Path("references/kept")).dataset("kind=N1/said").text == "a line of N1\nforce 2.5"
    assert CliRunner().invoke(app, verify).exit_code == 0
    family.joinpath("match.py").write_text(SAID.replace("2.5", "2.6"))
    store._case_hash.cache_clear()
    for name in [name for name in sys.modules if name.startswith("family_")]:
        del sys.modules[name]
    failed = CliRunner().invoke(app, verify)
    assert failed.exit_code == 1
    assert "1 of 2 lines are others" in failed.output
    assert "force ... was '2.5', is '2.6'" in failed.output
    assert CliRunner().invoke(app, command, input="n\n").exit_code == 1
    page = Path(f"out/bless-{family.name}-same.html").read_text()
    assert page.count("1 lines are others") == 2
    assert "is &#39;2.6&#39;" in page
