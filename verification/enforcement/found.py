"""What became of the runs, and how far they are from their reference."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np
from enforcement.known import KIND, STRIPS
from enforcement.plan import MORTAR, REFERENCE, Planned

from isomortar._frozen import frozen
from isomortar.accuracy.measures import roughness
from isomortar.geometry.patch import FloatArray
from isomortar.harness.runs import ByMethod, Computed


@frozen
class Found(Computed):
    """A run, and its distance from others."""

    planned: Planned

    @property
    def name(self) -> str:
        """Its scene."""
        return self.planned.setup.name

    @property
    def method(self) -> str:
        """The way of enforcement."""
        return self.planned.way

    @cached_property
    def curve(self) -> FloatArray:
        """The curve that is compared, shape (load steps that converged,)."""
        setup = self.planned.setup
        supports = [support.name for support in setup.load(self.planned.way).problem().supports]
        return self.curves(setup.quantity, len(supports), 3)[:, supports.index(setup.support), setup.component]

    @property
    def peaks(self) -> FloatArray:
        """Largest pressure, shape (load steps that converged,)."""
        return self.curves("pressure", 2)[:, 1]

    @property
    def roughness(self) -> float:
        """Second-difference energy of the curve, without its stages' kinks, over its square."""
        stages = self.planned.setup.load(self.planned.way).problem().stages
        number = np.repeat(np.arange(len(stages)), [stage.steps for stage in stages])[: len(self.curve)]
        return float(roughness(np.arange(len(self.curve)), self.curve, number) / (self.curve @ self.curve)) if len(self.curve) else np.nan

    def off(self, reference: Found) -> float:
        """Distance of the curve from another one's, over the norm of that; NaN where one is not whole."""
        if self.ending != "measured" or reference.ending != "measured":
            return np.nan
        return float(np.linalg.norm(self.curve - reference.curve) / np.linalg.norm(reference.curve))


@frozen
class Known(Computed):
    """A run whose tractions are known."""

    @property
    def name(self) -> str:
        """Its scene."""
        return str(self.result.cell.settings["scene"])

    @property
    def kind(self) -> str:
        """Family and order across the contact."""
        return str(self.result.cell.settings["kind"])

    @property
    def method(self) -> str:
        """The way of enforcement."""
        return str(self.result.cell.settings["way"])


@frozen
class Evidence(ByMethod[Found]):
    """The runs by one way of enforcement, beside those by the others, those of known tractions, and what is exact by method and order."""

    known: Sequence[Known] = ()
    table: Sequence[Mapping[str, Any]] = ()

    @property
    def _known(self) -> list[Known]:
        return ByMethod(self.known, self.method).by(self.method)

    def beside_strip(self) -> dict[str, float]:
        """Distance of the tractions from the exact ones over what a root at every edge costs, by scene."""
        runs = [run for run in self._known if run.kind == KIND]
        self.left_out.extend(f"{run.name}: {run.words}" for run in runs if run.ending != "measured")
        return {run.name: run.number("off") / STRIPS[run.name] for run in runs if run.ending == "measured"}

    def rougher_than_mortar(self) -> dict[str, float]:
        """Roughness of the tractions over that by the mortar method, by scene and kind."""
        mortar = {(run.name, run.kind): run.number("roughness") for run in ByMethod(self.known, MORTAR).by(MORTAR)}
        self.left_out.extend(f"{run.name} {run.kind}: {run.words}" for run in self._known if run.ending != "measured")
        whole = [run for run in self._known if run.ending == "measured"]
        return {f"{run.name} {run.kind}": run.number("roughness") / mortar[run.name, run.kind] for run in whole}

    def counted(self, key: str, least: int = 1) -> dict[str, float]:
        """A number of what is exact, by order, from an order on."""
        return {f"order {row['order']}": row[key] for row in self.table if row["method"] == self.method and row["order"] >= least}

    def stable_beside_mortar(self, least: int) -> dict[str, float]:
        """Inf-sup constant over that of the mortar method, by order, from an order on."""
        mortar = Evidence(self.runs, MORTAR, table=self.table).counted("inf-sup", least)
        return {order: value / mortar[order] for order, value in self.counted("inf-sup", least).items()}

    def solves_beside_mortar(self, edges: str) -> dict[str, float]:
        """Linear solves over those by the mortar method, of one scene."""
        return {run.name: run.number("solves") / mortar.number("solves") for run, mortar, _ in self._compared() if run.name == edges}

    def costs_beside_mesh(self) -> dict[str, float]:
        """Distance from the mortar method on the same mesh over that of the mortar method from the reference, by scene."""
        whole = [found for found in self._compared() if all(run.ending == "measured" for run in found)]
        self.left_out.extend(run.name for run, *_ in self._compared() if run.name not in {run.name for run, *_ in whole})
        return {run.name: run.off(mortar) / mortar.off(reference) for run, mortar, reference in whole}

    def missing(self) -> dict[str, float]:
        """Load steps that are missing, by scene."""
        known = {f"{run.name} {run.kind}": run.number("missing") for run in self._known}
        return {run.name: run.number("missing") for run in self.by(self.method)} | known

    def beside_mortar(self) -> dict[str, float]:
        """Distance from the reference over that of the mortar method on the same meshes, by scene."""
        found = {}
        for run, mortar, reference in self._compared():
            ratio = run.off(reference) / mortar.off(reference)
            if np.isnan(ratio):
                self.left_out.append(f"{run.name}: {run.words or mortar.words or reference.words}")
            else:
                found[run.name] = ratio
        return found

    def with_fewer_beside_mortar(self) -> dict[str, float]:
        """The same of scenes with fewer constraints than control points."""
        fewer = {run.name for run in self.by(self.method) if run.number("constraints") < run.number("control_points")}
        return {scene: ratio for scene, ratio in self.beside_mortar().items() if scene in fewer}

    def peak_beside_mortar(self) -> dict[str, float]:
        """Largest pressure of the last load step that both have, over that of the mortar method, by scene."""
        both = {run.name: (run.peaks, mortar.peaks) for run, mortar, _ in self._compared()}
        last = {scene: min(len(mine), len(theirs)) - 1 for scene, (mine, theirs) in both.items()}
        return {scene: float(mine[last[scene]] / theirs[last[scene]]) for scene, (mine, theirs) in both.items() if last[scene] >= 0}

    def _compared(self) -> list[tuple[Found, Found, Found]]:
        mortar, reference = ({run.name: run for run in self.by(way)} for way in (MORTAR, REFERENCE))
        return [(run, mortar[run.name], reference[run.name]) for run in self.by(self.method)]
