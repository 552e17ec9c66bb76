"""The commands: each says what it does, and leaves the doing to the package."""

from __future__ import annotations

import json
from copy import copy
from pathlib import Path
from typing import Annotated

import typer
from typer.main import get_command_name
from typer.models import CommandInfo

import isomortar
from isomortar._process import loading, numpy_as_loaded
from isomortar.cli.bench import bench
from isomortar.cli.check import check, show
from isomortar.cli.doctor import doctor
from isomortar.cli.endings import FAILED
from isomortar.cli.info import info
from isomortar.cli.mutants import mutants
from isomortar.cli.options import Overrides, ResultsArgument, SceneArgument
from isomortar.cli.paper import paper
from isomortar.cli.report import report
from isomortar.cli.tables import print_whole
from isomortar.cli.trade import advise, trade
from isomortar.cli.verification import bless, verify
from isomortar.errors import InputError

app = typer.Typer(
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="markdown",
    context_settings={"help_option_names": ["-h", "--help"]},
)

#: Headings of the list of commands.
SCENES, ACCURACY, CHECKOUT = "Compute and look", "Is it right, and what does accuracy cost?", "In a checkout: is the program right?"


def _show_version(wanted: bool) -> None:
    if wanted:
        print(f"isomortar {isomortar.__version__}")
        raise typer.Exit


@app.callback()
def isomortar_command(
    version: Annotated[bool, typer.Option("--version", help="Show the version and exit.", callback=_show_version, is_eager=True)] = False,
) -> None:
    """Frictional contact between deformable NURBS bodies: a scene file in, results, curves and pictures out.

    First steps:

    - `isomortar scenes` lists the scenes that come with the program
    - `isomortar run press` computes one of them into results/press.h5
    - `isomortar plot results/press.h5` draws its curves and pictures

    Exit codes: 0 done, 1 failed, 2 bad input, 3 a fault of the program itself, 130 interrupted. `isomortar COMMAND --help` says more.
    """


@app.command(rich_help_panel=SCENES)
def run(
    scene: SceneArgument,
    overrides: Overrides = None,
    output: Annotated[
        Path | None, typer.Option(dir_okay=False, help="Results file.", show_default="results/NAME.h5, NAME being the scene's")
    ] = None,
    steps: Annotated[
        list[int] | None,
        typer.Option(
            metavar="NUMBER", min=1, help="Load steps more, in a stage of their own at the rate of the scene's last one; may be repeated."
        ),
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on after the last load step that the results file holds.")] = False,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Begin anew where the results file exists.")] = False,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Compute nothing: say what `isomortar check` says.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress; warnings and errors still show.")] = False,
    verbose: Annotated[
        bool,
        typer.Option("--verbose", "-v", help="Tell every iteration: residual, active constraints, what acted; and what each step took."),
    ] = False,
    log: Annotated[
        Path | None,
        typer.Option(dir_okay=False, help="A file to whose end all that --verbose tells is written, with the time of each line."),
    ] = None,
    cost: Annotated[bool, typer.Option("--cost", help="Say at the end what it cost: CPU seconds by phase, and what was done.")] = False,
) -> None:
    """Compute a scene.

    Every load step is on the disk when it is done (quick ones that take longer to write some together, for a tenth of the time): after
    Ctrl-C, a crash or a power cut `--resume` goes on from the last one, and the results file can be read meanwhile. An existing file is an
    error without `--resume` or `--overwrite`. A scene goes on as well that has stages more at its end, or a last stage of more load steps
    at the same rate (its motions and factors grow with it), to the numbers of a run from the start; nothing else in it may have changed.

    For example:

    - `isomortar run iron`
    - `isomortar run iron --resume`
    - `isomortar run iron --resume --steps 10` goes on for ten load steps more; `--steps 10 --steps 5` then for another five
    - `isomortar run press --resume --set stages.press.steps=10 --set stages.press.motions.top.translate=[0,0,-0.6]` lengthens a stage
    - `isomortar run my_scene.toml --output my_results.h5`
    - `isomortar run twist --set "bodies.master.mesh.order=[3,3,2]" --set contacts.interface.friction=0.5`
    - `isomortar run press --set stages.press.steps=10 --output fine.h5`
    - `isomortar run twist --cost`
    - `isomortar run iron --quiet --log iron.log` keeps every iteration in a file

    Progress and costs go to stderr, the name of the results file to stdout.
    """
    if resume and overwrite:
        raise InputError("--resume and --overwrite exclude each other: go on with the results file, or begin anew")
    if quiet and verbose:
        raise InputError("--quiet and --verbose exclude each other; with --quiet, --log FILE keeps what --verbose tells")
    with loading():
        with numpy_as_loaded():
            from isomortar._distributed import dismiss, refuse_idle
            from isomortar.cli.progress import progress
            from isomortar.driver import compute, results_path

        chosen = isomortar.Scene.load(scene, overrides or ()).with_more_steps(*(steps or ()))
        problem = chosen.problem()
    if dry_run:
        show(problem)
        return
    refuse_idle(problem.settings.engine)
    path = output or results_path(chosen)
    if log:
        _refuse_log(log, Path(scene), path)
    with progress(problem, quiet, verbose, log) as observer:
        try:
            results = compute(chosen, problem, path, observer, resume, overwrite)
        except BaseException as error:  # Ctrl-C and want of memory too
            observer.stopped(path, error)
            raise
        observer.finished(results.warnings)
    dismiss()
    with results:
        if cost:
            from rich.console import Console

            from isomortar.cli.cost import costs

            print_whole(Console(stderr=True), costs(results))
    print(path)


app.command(rich_help_panel=SCENES)(check)
app.command(rich_help_panel=SCENES)(info)


@app.command(rich_help_panel=SCENES)
def plot(
    results: ResultsArgument,
    output: Annotated[
        Path | None, typer.Option(file_okay=False, help="Folder of the figures.", show_default="RESULTS-plots, beside the file")
    ] = None,
    step: Annotated[int | None, typer.Option(help="Load step whose bodies and maps are drawn.", show_default="the last one")] = None,
    fields: Annotated[
        list[str] | None,
        typer.Option(
            "--field",
            metavar="FIELD",
            help="In colours: pressure, traction, slip or gap of contacts, stress, J or displacement of bodies; may be given again.",
            show_default="pressure",
        ),
    ] = None,
    only: Annotated[
        list[str] | None,
        typer.Option(metavar="WHAT", help="Draw these alone, curves, bodies or maps; may be given again.", show_default="all"),
    ] = None,
    formats: Annotated[
        list[str] | None,
        typer.Option(
            "--format",
            metavar="TYPE",
            help="Of curves and maps, png, pdf or svg; may be given again. Bodies are PNG.",
            show_default="png and pdf",
        ),
    ] = None,
    x: Annotated[
        str, typer.Option("--x", metavar="WHAT", help="What curves are drawn over: time, or the displacement or rotation of a support.")
    ] = "time",
) -> None:
    """Draw force curves, bodies, and maps of contact faces in colours by pressure or other fields, and print where they lie.

    Works while the computation is still running: it draws the load steps that are done.

    For example:

    - `isomortar plot results/iron.h5`
    - `isomortar plot results/iron.h5 --step 20 --only bodies --only maps --format svg`
    - `isomortar plot results/iron.h5 --field traction --field slip --field stress --only maps --only bodies`
    - `isomortar plot results/iron.h5 --x "displacement x of top"` (without x its size; a rotation is in degrees: `--x "rotation of top"`)
    """
    with isomortar.Results(results) as stored:
        curves = isomortar.Scene.from_toml(stored.scene_text).record.curves or ()
    folder = output or _beside(results, "plots")
    for path in isomortar.plot(results, folder, curves, step=step, fields=fields or (), only=only or (), formats=formats or (), x=x):
        print(path)


@app.command(rich_help_panel=SCENES)
def export(
    results: ResultsArgument,
    output: Annotated[
        Path | None, typer.Option(file_okay=False, help="Folder of the export.", show_default="RESULTS-paraview, beside the file")
    ] = None,
) -> None:
    """Write fields for ParaView (Bezier cells of the true order and weights), and print the file to open.

    For example: `isomortar export results/iron.h5`, then `paraview results/iron-paraview/iron.pvd`
    """
    print(isomortar.export(results, output or _beside(results, "paraview")))


@app.command(rich_help_panel=SCENES)
def film(
    results: ResultsArgument,
    output: Annotated[
        Path | None,
        typer.Option(dir_okay=False, help="A .gif, .webp or .mp4 file; .gif has 256 colours.", show_default="RESULTS.gif, beside the file"),
    ] = None,
    contact: Annotated[str | None, typer.Option(help="Whose pressure is in colour.", show_default="the first one's")] = None,
    every: Annotated[int, typer.Option(min=1, help="Show one load step in so many, and the last one.")] = 1,
    rate: Annotated[float, typer.Option(metavar="NUMBER", help="Pictures a second, 0.01 to 100.")] = 8.0,
) -> None:
    """Film the bodies and the contact pressure, load step after load step on one scale, and print where the film lies.

    For example: `isomortar film results/iron.h5 --every 2`
    """
    from rich.console import Console
    from rich.progress import Progress

    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as progress:
        bar = progress.add_task("pictures")
        path = isomortar.film(
            results,
            output or results.with_suffix(".gif"),
            contact=contact,
            every=every,
            rate=rate,
            tell=lambda done, total: progress.update(bar, completed=done, total=total),
        )
    print(path)


@app.command(rich_help_panel=SCENES)
def view(
    results: ResultsArgument,
    output: Annotated[Path | None, typer.Option(dir_okay=False, help="The page.", show_default="RESULTS.html, beside the file")] = None,
) -> None:
    """Write a page that shows the bodies, load step by load step, in colours by a field, and print where it lies.

    One file that any browser opens, without a network: pressure, traction, gap and status of contacts, displacement, stress and J of
    bodies; it turns, zooms, plays the load steps and tells values.

    For example: `isomortar view results/iron.h5`, then open results/iron.html
    """
    print(isomortar.view(results, output or results.with_suffix(".html")))


@app.command(rich_help_panel=ACCURACY)
def check_tangent(
    scene: SceneArgument,
    overrides: Overrides = None,
    step: Annotated[int | None, typer.Option(min=1, help="Load step.", show_default="mid-run")] = None,
) -> None:
    """Measure the tangent's error, part by part, at the states that Newton's method visits in a load step.

    The reference is the same kernel in extended precision. Runs the scene up to the step; exit code 1 where a part is above its bound.

    For example: `isomortar check-tangent iron --step 20`
    """
    from rich.console import Console

    from isomortar.harness.tangents import check_tangent

    report = check_tangent(isomortar.Scene.load(scene, overrides or ()).problem(), step)
    print_whole(Console(), report)
    raise typer.Exit(0 if report.passes else FAILED)


@app.command(rich_help_panel=SCENES)
def scenes() -> None:
    """List the bundled scenes."""
    from isomortar.scene import bundled_scenes

    names = bundled_scenes()
    for name in names:
        print(f"{name:<{max(map(len, names))}}  {isomortar.Scene.load(name).title}")


@app.command(rich_help_panel=SCENES)
def schema() -> None:
    """Print the JSON schema of scene files, for editors that complete and check TOML.

    For example: `isomortar schema > scene.schema.json`
    """
    from isomortar.scene import json_schema

    print(json.dumps(json_schema(), indent=2))


app.command(rich_help_panel=CHECKOUT)(verify)
app.command(rich_help_panel=CHECKOUT)(bless)
app.add_typer(report, name="report", rich_help_panel=CHECKOUT)
app.command(rich_help_panel=ACCURACY)(trade)
app.command(rich_help_panel=ACCURACY)(advise)
app.command(rich_help_panel=CHECKOUT)(paper)
app.command(rich_help_panel=CHECKOUT)(bench)
app.command(rich_help_panel=CHECKOUT)(mutants)
app.command(rich_help_panel=SCENES)(doctor)


def asked(words: list[str]) -> typer.Typer:
    """The command that the first word names, alone; all of them where it names none.

    To set each of them up takes a twentieth of a small run.
    """
    alone = copy(app)
    alone.registered_commands = [command for command in app.registered_commands if [_name(command)] == words[:1]]
    alone.registered_groups = []
    return alone if alone.registered_commands else app


def _name(command: CommandInfo) -> str:
    return command.name or get_command_name(command.callback.__name__) if command.callback else ""


def _refuse_log(log: Path, scene: Path, results: Path) -> None:
    """Of all files that a run names a log is one of its own: lines at the end of a scene make it none."""
    if log.is_file() and scene.is_file() and log.samefile(scene):
        raise InputError(f"{log} is the scene file of this run: name another one", "log")
    if log.absolute() == results.absolute():
        raise InputError(f"{log} is the results file of this run: name another one", "log")


def _beside(results: Path, kind: str) -> Path:
    return results.with_name(f"{results.stem}-{kind}")
