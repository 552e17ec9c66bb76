"""Benchmark scenes against the results of an independent implementation of the same formulation (`import_references.py`)."""

from __future__ import annotations

from collections.abc import Callable

from reference_scenes import FIRST, RUNS, has_end, measure

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Matches, case
from isomortar.harness.cases import Case, Claim, Tier

#: Seconds each, by group: nodal elements, splines, beginnings with sticking and slipping points on deformable masters, a
#: closed ring.
QUICK = {
    "local": (
        *("press_L2_6", "press_N2_6", "press_N3_6"),
        *(f"{name}{FIRST}12" for name in ("twist_N3", "iron_N3")),
        *(f"twist_N2{FIRST}14", f"tire_N2_32_q{FIRST}13"),
    ),
    "tight": ("press_L2", f"twist_N3{FIRST}6", f"tire_L2{FIRST}3", f"tire_N2{FIRST}3"),
}

_NEWTON = "round-off: Newton's 1e-11 and contact conditions to 1e-10 here; the rest is the reference's uncertainty"
_TIGHT = "reference: another program at the same tolerances; Newton's 1e-11 is far below them"
_PAPER = "reference: the paper's tolerance of 1 % leaves the path free by as much, at every load step"
_POINTS = "theory: the same control points are in contact and slip, the same quadrature points lie beyond the master"


def tier(group: str) -> Callable[[str], Tier]:
    """Whole runs are minutes."""
    return lambda scene: "gate" if scene in QUICK[group] else "nightly"


def local_claims(scene: str) -> dict[str, Claim]:
    """All numbers, positions where the reference's end is reached."""
    names = ("force", "moment", "pressure", "traction", *(("position",) if has_end(scene) else ()))
    same: dict[str, Claim] = {name: Matches("other_code_local", _NEWTON, allowance=1e-10) for name in names}
    return {**same, "points": Matches("other_code_local", _POINTS)}


@case(
    claim="Forces, moments, contact and positions are those of an independent program, at every load step, to the tolerance of both.",
    tier=tier("local"),
    grid={"scene": tuple(dict.fromkeys((*QUICK["local"], *RUNS["local"])))},
    bounds=local_claims,
)
def local(scene: str) -> dict[str, FloatArray]:
    """Monolithic, slip of the control point's own; curves over the load steps, and positions at the end."""
    return measure("local", scene)


def tight_claims(scene: str) -> dict[str, Claim]:
    """All numbers, positions where the reference's end is reached."""
    names = ("force", "moment", "pressure", "traction", "points", *(("position",) if has_end(scene) else ()))
    return {name: Matches("other_code_tight", _POINTS if name == "points" else _TIGHT) for name in names}


@case(
    claim="With augmentations to 1e-8 and the paper's slip sum, results are those of an independent program.",
    tier=tier("tight"),
    grid={"scene": tuple(dict.fromkeys((*QUICK["tight"], *RUNS["tight"])))},
    bounds=tight_claims,
)
def tight(scene: str) -> dict[str, FloatArray]:
    """Uzawa with the paper's norm and growing penalties; curves over the load steps, and positions at the end."""
    return measure("tight", scene)


@case(
    claim="With the paper's own tolerances, forces, moments and positions are within some per cent of an independent program's.",
    tier="nightly",
    grid={"scene": tuple(RUNS["paper"])},
    bounds={name: Matches("other_code_paper", _PAPER) for name in ("force", "moment", "position")},
)
def paper(scene: str) -> dict[str, FloatArray]:
    """Uzawa to 1 % in the paper's norm; runs that both programs do without cutting a load step."""
    found = measure("paper", scene)
    return {name: found[name] for name in ("force", "moment", "position")}


#: By group of references.
GROUPS: dict[str, Case] = {"local": local, "tight": tight, "paper": paper}
