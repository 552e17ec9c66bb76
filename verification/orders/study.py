"""The study of orders and meshes of a scene: kinds of discretisation on several meshes, compared with a finer one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from orders import page
from orders.analysis import analyse
from orders.plan import Plan

from isomortar.harness.cases import Cell
from isomortar.harness.measurement import Measurement
from isomortar.harness.study import Conclusion
from isomortar.scene.scene import Scene


@dataclass(frozen=True)
class Orders:
    """What is run of a scene."""

    plan: Plan

    @classmethod
    def of(cls, scene: Scene, kinds: Sequence[str], body: str | None, quick: bool) -> Orders:
        """The study of a scene; see `Plan.of`."""
        return cls(Plan.of(scene, kinds, body, quick))

    def cells(self, folder: Path) -> list[Cell]:
        """A cell a discretisation."""
        return self.plan.cells(folder / "scenes")

    def conclude(self, folder: Path, measurements: Sequence[Measurement], started: datetime) -> Conclusion:
        """Compare the discretisations and write ``report.html``."""
        analysis = analyse(self.plan, dict(zip(self.plan.runs, measurements, strict=True)))
        return Conclusion(page.write(folder, analysis, started), len(analysis.failed), not analysis.failed)
