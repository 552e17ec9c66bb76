"""What is said of a results file that is asked for what it does not hold, or is none: words that tell what there is, and what to do."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import h5py
from output.records import SCENE, load_steps, recorded

from isomortar import Results, Scene, film, plot, view
from isomortar.errors import IsomortarError
from isomortar.harness import Bound, case
from isomortar.results.files import sealed
from isomortar.results.writer import ResultsWriter

#: An action that is refused, and words of what is said.
Asked = tuple[Callable[[], object], str]


def of_a_file(run: Path, results: Results) -> list[Asked]:
    """Of one that keeps the state of its last load step alone."""
    return [
        (lambda: results.step(9), "run.h5; it holds steps 1 to 5"),
        (lambda: results.step(1), "run.h5 kept no state of load step 1 (states = 'last'); it has the curves of all steps"),
        (lambda: results.curve("weight"), "there are: step, time, newton_order, substeps, cuts, next_increment"),
        (lambda: results.curve("force"), "there is no curve 'force' here; name what it is of, by support= or load=; there are: step, time"),
        (lambda: results.curve("slip", load="press"), "there is no curve 'slip' here; name what it is of, by contact=; there are: force"),
        (lambda: results.curve("gap", contact="under"), "there is no curve 'gap' here; there are: force_slave, force_master, moment_slave"),
        (lambda: results.curve("force", support="roof"), "there is no support 'roof'; there are: ground, rim, push, top"),
        (lambda: results.curve("force", contact="roof"), "there is no contact 'roof'; there are: under, over"),
        (lambda: results.curve("force", load="roof"), "there is no load 'roof'; there are: press, weight"),
        (lambda: results.contact("roof"), "there is no contact 'roof'; there are: under, over"),
        (lambda: results.curve("force", support="rim", load="press"), "a curve is of one of support, load: name that alone"),
        (lambda: results.curve("time", component="x"), "curve 'time' has no components"),
        (lambda: results.curve("force", support="rim", component="xy"), "component is 'xy'; allowed: 'x', 'y' or 'z'"),  # type: ignore[arg-type]
        (lambda: view(run, run), "output: is 'run.h5'; allowed: a name that ends in .html"),
        (lambda: results.curve("pressure_field", contact="under", component="x"), "curve 'pressure_field' has no components"),
        (lambda: plot(run, run.parent / "drawn", fields=["colour"]), "is 'colour'; allowed: pressure, traction, slip, gap, stress, J"),
        (lambda: plot(run, run.parent / "drawn", only=["films"]), "only: is 'films'; allowed: curves, bodies, maps"),
        (lambda: plot(run, run.parent / "drawn", formats=["gif"]), "format: is 'gif'; allowed: png, pdf, svg"),
        (lambda: plot(run, run.parent / "drawn", fields=["slip"], only=["maps"]), "slip"),
        (lambda: plot(run, run.parent / "drawn", x="strain"), "strain"),
        (lambda: film(run, run.parent / "run.gif"), "holds 1 state of a load step, and a film needs two"),
        (lambda: film(run, run.parent / "run.avi"), "is 'run.avi'; allowed: a name that ends in .gif or .webp or .mp4"),
        (lambda: film(run, run.parent / "run.gif", every=0), "every: is 0; allowed: a whole number from 1 to 1000000"),
        (lambda: film(run, run.parent / "run.gif", every=1.5), "every: is 1.5; allowed: a whole number"),  # type: ignore[arg-type]
        (lambda: film(run, run.parent / "run.gif", rate=101.0), "rate: is 101.0; allowed: a number from 0.01 to 100"),
        (lambda: film(run, run.parent / "run.gif", rate="8"), "rate: is '8'; allowed: a number"),  # type: ignore[arg-type]
        (lambda: Results(run.parent), "is a folder: name the results file in it"),
        (lambda: Results(run.parent / "none.h5"), "none.h5 does not exist: run the scene first"),
        (lambda: Results(run.parent / "cut.h5"), "cut.h5 is damaged"),
        (lambda: Results(run.parent / "text.h5"), "text.h5 is no results file of isomortar"),
        (lambda: Results(run.parent / "waves.h5"), "waves.h5 is sealed as results of isomortar are, but holds something else"),
        (lambda: plot(run.parent / "empty.h5", run.parent / "drawn"), "empty.h5 holds no load step yet: nothing to draw"),
        (lambda: view(run.parent / "empty.h5", run.parent / "view.html"), "empty.h5 holds no load step yet"),
        (lambda: Results(run.parent / "empty.h5").contact("under"), "empty.h5 holds no load step yet"),
    ]


def of_a_writer(run: Path) -> list[Asked]:
    """Of one for another scene, or for a file that is there."""
    problem = Scene.from_toml(SCENE).problem()
    softer = Scene.from_toml(SCENE, overrides=["contacts.under.friction=0.4"]).problem()
    shorter = replace(
        problem,
        stages=problem.stages[:1],
        supports=tuple(replace(s, motions=s.motions[:1], factors=s.factors[:1]) for s in problem.supports),
        loads=tuple(replace(load, factors=load.factors[:1]) for load in problem.loads),
    )
    return [
        (lambda: ResultsWriter(run, problem, SCENE, "0"), "run.h5 exists already: resume it, overwrite it, or name another results file"),
        (lambda: ResultsWriter(run, softer, SCENE, "0", resume=True), "contacts.under.friction: 0.3 in the file, 0.4 in the scene"),
        (lambda: ResultsWriter(run, shorter, SCENE, "0", resume=True), "turn"),
    ]


def otherwise(asked: Asked) -> bool:
    """Whether something else is said, or nothing."""
    action, words = asked
    try:
        action()
    except IsomortarError as error:
        return words not in str(error)
    return True


@case(
    claim="A results file that is asked for what it does not hold says what there is; what is no results file, and another scene's, is "
    "said to be that, by its name.",
    tier="gate",
    bounds={
        "others": Bound(0.0, 0.0, "definition: of which something else is said, or nothing"),
        "asked": Bound(at_least=25.0, reason="definition: or nothing is tried"),
    },
)
def asked() -> dict[str, float]:
    """How many."""
    problem = Scene.from_toml(SCENE).problem()
    with tempfile.TemporaryDirectory() as folder:
        run = Path(folder) / "run.h5"
        recorded(run, problem, load_steps(problem), "last")
        ResultsWriter(run.with_name("empty.h5"), problem, SCENE, "0")
        run.with_name("cut.h5").write_bytes(run.read_bytes()[:-1])
        run.with_name("text.h5").write_text("curves", encoding="utf-8")
        run.with_name("waves.h5").write_bytes(run.read_bytes())
        with h5py.File(run.with_name("waves.h5"), "a") as file:
            file.attrs["format"] = "waves"
        run.with_name("waves.h5").write_bytes(sealed(run.with_name("waves.h5").read_bytes()))
        with Results(run) as results:
            tried = [*of_a_file(run, results), *of_a_writer(run)]
            others = [words for action, words in tried if otherwise((action, words))]
    return {"others": float(len(others)), "asked": float(len(tried))}
