"""The study of orders and meshes of a scene: kinds of discretisation on several meshes, compared with a finer one."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from functools import partial
from pathlib import Path

from orders import page
from orders.analysis import analyse
from orders.finding import summary
from orders.plan import Plan
from orders.run import discretised

from isomortar.harness.runner import Result
from isomortar.harness.study import Conclusion, Run, Study
from isomortar.scene.scene import Scene


def study(scene: Scene, kinds: Sequence[str], body: str | None, quick: bool) -> Study:
    """The study of a scene, a run a discretisation; see `Plan.of`."""
    plan = Plan.of(scene, kinds, body, quick)
    settings = {"body": plan.sweep.body, "contact": plan.sweep.contact}
    names = [f"{scene.name}-{chosen.label.replace(' ', '-')}" for chosen in plan.runs]
    runs = [Run(name, plan.discretised(chosen), discretised, settings) for name, chosen in zip(names, plan.runs, strict=True)]
    return Study(tuple(runs), partial(_written, plan))


def _written(plan: Plan, folder: Path, results: Sequence[Result], started: datetime) -> Conclusion:
    """Compare the discretisations and write ``report.html``."""
    analysis = analyse(plan, {chosen: result.measurement for chosen, result in zip(plan.runs, results, strict=True)})
    return Conclusion(page.write(folder, analysis, started), len(analysis.failed), not analysis.failed, "\n".join(summary(analysis)))
