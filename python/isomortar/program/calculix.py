"""CalculiX as a program: hexahedra of order 1 and 2, contact by a penalty, Newton's method. Its input and output files are text."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model.entities import Body, Contact, Face, Material, Problem
from isomortar.model.loads import Loads
from isomortar.model.numbering import Numbering
from isomortar.program.declaration import NotInstalledError, Outcome, ended, load_step
from isomortar.program.lagrange import LagrangeProblem
from isomortar.program.process import Ending, Finished, run

LAWS = ("neo-hookean-j", "linear-elastic")
#: Elements by order, and places of their nodes along the three directions: corners first, then the middles of the edges.
_CORNERS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
_EDGES = [
    (1, 0, 0),
    (2, 1, 0),
    (1, 2, 0),
    (0, 1, 0),
    (1, 0, 2),
    (2, 1, 2),
    (1, 2, 2),
    (0, 1, 2),
    (0, 0, 1),
    (2, 0, 1),
    (2, 2, 1),
    (0, 2, 1),
]
ELEMENTS = {1: ("C3D8", np.array(_CORNERS) // 2), 2: ("C3D20", np.array(_CORNERS + _EDGES))}
_FACES = {"w0": "S1", "w1": "S2", "v0": "S3", "u1": "S4", "v1": "S5", "u0": "S6"}
#: A table of the .dat file: what it holds, then a line a node.
_TABLE = re.compile(r"^ (forces|displacements) \(.*\) for set \S+ and time.*\n\n((?: +\d+(?: +\S+){3}\n)+)", re.MULTILINE)
#: What it says of a mistake, on its standard output.
_ERROR = re.compile(r"\*ERROR.*(?:\n {2,}\S.*)*")
#: Share of a pressure's forces below which a support is along the face, not against it: round-off.
_ALONG = 1e-12
#: What CalculiX says where a load step does not converge.
_GAVE_UP = re.compile(r"increment size\s+smaller than minimum|too many cutbacks|solution seems to diverge", re.IGNORECASE)


class CalculiX:
    """CalculiX, from its input deck, with one thread.

    Order 1 is C3D8, with two Gauss points a direction. Order 2 is C3D20, with three: it has no nodes within faces and elements, so that
    its functions are others than those of 27 nodes. Where all bodies have small strain the steps are geometrically linear,
    and pressures stay as they are on the reference. Contact is surface to surface with a linear pressure-overclosure, friction with an
    elastic stick slope: neither is exact.

    Parameters
    ----------
    pressure_slope, stick_slope : float, optional
        Pressure per overclosure, and traction per slip while a point sticks, force per volume; default: 500 and 50 times the largest
        Young's modulus over the smallest extent of a body.
    """

    name = "CalculiX"

    def __init__(self, pressure_slope: float | None = None, stick_slope: float | None = None) -> None:
        self._slopes = pressure_slope, stick_slope

    def run(self, problem: Problem) -> Outcome:
        """Compute all load steps, or as many as converge.

        Raises
        ------
        InputError
            What `LagrangeProblem` refuses; orders other than 1 and 2, or other by direction; other Gauss points; small strain beside large
            ones; pressures where supports act against them.
        NotInstalledError
            There is no command ``ccx``.
        """
        told = LagrangeProblem(problem, self.name, LAWS)
        _check(told)
        if shutil.which("ccx") is None:
            raise NotInstalledError("CalculiX is not installed: apt-get install calculix-ccx")
        usual = told.stiffest / told.thinnest
        slopes = [given or share * usual for given, share in zip(self._slopes, (500.0, 50.0), strict=True)]
        with TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "problem.inp").write_text("\n".join(deck(told, *slopes)) + "\n")
            finished = run(["ccx", "-i", "problem"], folder=folder)
            dat, cvg = (_text(folder / f"problem.{suffix}") for suffix in ("dat", "cvg"))
        return _outcome(told, finished, dat, cvg)


def deck(told: LagrangeProblem, pressure_slope: float, stick_slope: float) -> Iterator[str]:
    """Lines of the input deck: nodes and elements count from 1, bodies one after the other; a step a load step."""
    yield from ("*HEADING", told.problem.name)
    elements = {body.name: _elements(told, body) for body in told.problem.bodies}
    used = np.unique(np.concatenate([numbers.ravel() for numbers in elements.values()]))
    yield "*NODE, NSET=ALL"
    yield from (f"{node + 1}, " + ", ".join(map(_number, told.nodes[node])) for node in used)
    first = 1
    for number, body in enumerate(told.problem.bodies):
        yield f"*ELEMENT, TYPE={ELEMENTS[_order(body)][0]}, ELSET=BODY{number}"
        yield from _rows(np.column_stack([first + np.arange(len(elements[body.name])), elements[body.name] + 1]))
        for surface, place in _places(told.problem, body):
            yield f"*SURFACE, NAME={surface}"
            yield from (f"{first + element}, {_FACES[place.face]}" for element in told.touching(place))
        yield from (f"*MATERIAL, NAME=MATERIAL{number}", *_law(body.material))
        yield f"*SOLID SECTION, ELSET=BODY{number}, MATERIAL=MATERIAL{number}"
        first += len(elements[body.name])
    for number, contact in enumerate(told.problem.contacts):
        yield from _contact(number, contact, pressure_slope, stick_slope)
    yield from _steps(told, used)


def _number(value: float) -> str:
    """A number as CalculiX reads it: a field has twenty characters at the most."""
    return f"{value:.12e}"


def _elements(told: LagrangeProblem, body: Body) -> IntArray:
    """Nodes of a body's elements as CalculiX counts them, from 0."""
    order = _order(body)
    return told.elements(body)[:, ELEMENTS[order][1] @ (order + 1) ** np.arange(3)]


def _rows(numbers: IntArray) -> Iterator[str]:
    """A row a line, continued after the sixteenth number."""
    for row in numbers.tolist():
        yield ", ".join(map(str, row[:16])) + ("," if len(row) > 16 else "")
        if len(row) > 16:
            yield ", ".join(map(str, row[16:]))


def _places(problem: Problem, body: Body) -> Iterator[tuple[str, Face]]:
    """Names and places of a body's surfaces in contact and under loads."""
    for number, contact in enumerate(problem.contacts):
        for side, place in (("SLAVE", contact.slave), ("MASTER", contact.master)):
            if isinstance(place, Face) and place.body == body.name:
                yield f"{side}{number}", place
    yield from ((f"LOAD{number}", load.place) for number, load in enumerate(problem.loads) if load.body == body.name)


def _law(material: Material) -> tuple[str, str]:
    if material.law == "linear-elastic":
        return "*ELASTIC", f"{_number(material.young)}, {_number(material.poisson)}"
    return "*HYPERELASTIC, NEO HOOKE", f"{_number(material.shear / 2)}, {_number(2 / material.bulk)}"


def _contact(number: int, contact: Contact, pressure_slope: float, stick_slope: float) -> Iterator[str]:
    yield from (f"*SURFACE INTERACTION, NAME=CONTACT{number}", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", _number(pressure_slope))
    if contact.friction:
        yield from ("*FRICTION", f"{_number(contact.friction)}, {_number(stick_slope)}")
    yield from (f"*CONTACT PAIR, INTERACTION=CONTACT{number}, TYPE=SURFACE TO SURFACE", f"SLAVE{number}, MASTER{number}")


def _steps(told: LagrangeProblem, used: IntArray) -> Iterator[str]:
    """A step a load step, with cuts as CalculiX makes them. The tolerance bounds the residual over the average force."""
    prescribed = np.isin(told.prescribed // 3, used)
    large = "" if _small(told.problem.bodies[0]) else ", NLGEOM"
    yield "*NSET, NSET=HELD"
    yield from (f"{node + 1}," for node in np.unique(told.prescribed[prescribed] // 3))
    for displacements, pressures in zip(told.displacements, told.pressures, strict=True):
        yield from (f"*STEP{large}, INC=1000", "*STATIC, SOLVER=SPOOLES", "1.0, 1.0, 1e-5, 1.0")
        yield from ("*CONTROLS, PARAMETERS=FIELD", f"{told.problem.settings.newton_tolerance:g}, 0.01", "*BOUNDARY")
        for unknown, value in zip(told.prescribed[prescribed], displacements[prescribed], strict=True):
            node, component = divmod(int(unknown), 3)
            yield f"{node + 1}, {component + 1}, {component + 1}, {_number(value)}"
        for number, size in enumerate(pressures):
            yield from ("*DSLOAD", f"LOAD{number}, P, {_number(size)}")
        for nodes, what in (("HELD", "RF"), ("ALL", "U")):
            yield from (f"*NODE PRINT, NSET={nodes}, FREQUENCY=100000", what)
        yield "*END STEP"


def _order(body: Body) -> int:
    return body.patch.directions[0].order


def _small(body: Body) -> bool:
    return body.material.law == "linear-elastic"


def _check(told: LagrangeProblem) -> None:
    """What this program has no word for."""
    for body in told.problem.bodies:
        orders = {direction.order for direction in body.patch.directions}
        if len(orders) > 1 or not orders <= ELEMENTS.keys():
            raise told.refuse("has hexahedra of order 1 and 2, the same along all directions", f"bodies.{body.name}.mesh.order")
        if _order(body) == 1 and set(body.quadrature) != {2}:
            raise told.refuse("has 2 Gauss points a direction in elements of order 1", f"bodies.{body.name}.mesh.quadrature")
        if _small(body) != _small(told.problem.bodies[0]):
            raise told.refuse("has small strain in all bodies or in none", f"bodies.{body.name}.material.law")
    pressed = Loads(told.problem, Numbering(told.problem)).forces(told.nodes, float(told.problem.total_steps))
    for load, forces in zip(told.problem.loads, pressed, strict=True):
        if np.abs(forces.ravel()[told.prescribed]).max(initial=0.0) > _ALONG * np.abs(forces).max():
            raise told.refuse("adds pressures to the forces of supports that they act against", f"loads.{load.name}.face")


def _outcome(told: LagrangeProblem, finished: Finished, dat: str, cvg: str) -> Outcome:
    """From what the output files say of the ends of load steps."""
    tables = [_by_node(told, text) for _, text in _TABLE.findall(dat)]
    steps = [
        load_step(told.problem, number, told.nodes + displacements, np.nan_to_num(forces))
        for number, (forces, displacements) in enumerate(zip(tables[::2], tables[1::2], strict=False), start=1)
    ]
    ending: Ending = "not converged" if _GAVE_UP.search(finished.output) else finished.end.ending
    error = _ERROR.search(finished.output)
    words = " ".join(error.group().split()) if error else finished.last_words
    return Outcome(*ended(steps, told.problem, ending, words), tuple(steps), _iterations(cvg.splitlines()), finished.cpu_seconds)


def _by_node(told: LagrangeProblem, table: str) -> FloatArray:
    """The vectors of a table, NaN at nodes that it does not name, shape (n, 3)."""
    rows = np.array([line.split() for line in table.splitlines()], dtype=float)
    vectors = np.full_like(told.nodes, np.nan)
    vectors[rows[:, 0].astype(int) - 1] = rows[:, 1:]
    return vectors


def _iterations(cvg: Iterable[str]) -> int:
    """Iterations, a linear solve each, those of increments that failed included: lines of the .cvg file that begin with a number."""
    return sum(1 for line in cvg if line.split() and line.split()[0].isdigit())


def _text(path: Path) -> str:
    return path.read_text() if path.exists() else ""
