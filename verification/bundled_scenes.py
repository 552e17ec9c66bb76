"""Compare the bundled scenes, with overrides, with the explicit scenes of another program.

    python verification/bundled_scenes.py REFERENCE_FOLDER

Every ``SCENE*.json`` below the folder, SCENE being a bundled scene, is converted and compared with the bundled scene whose
families, orders, elements and stages are set to its own: control points and weights to 1e-14 of the body's size, the rest exactly.
With ``--facts FILE`` a sample of each distinct patch is stored, for the test that needs no folder.
"""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from convert_reference import convert

from isomortar.geometry.patch import Patch
from isomortar.model.entities import Body, Problem
from isomortar.scene import Scene, bundled_scenes

BOUND = 1e-14


def mesh_overrides(body: Body) -> list[str]:
    """Overrides that give a bundled scene's body the discretisation of this one."""
    choice: dict[str, list[Any]] = {
        "family": [d.family for d in body.patch.directions],
        "order": [d.order for d in body.patch.directions],
        "elements": [d.elements for d in body.patch.directions],
    }
    return [f"bodies.{body.name}.mesh.{key}={json.dumps(value)}" for key, value in choice.items()]


def size(patch: Patch) -> float:
    """Largest coordinate: the unit of round-off."""
    return float(np.abs(patch.control_points).max())


def own_noise(patch: Patch) -> float:
    """Round-off in the reference itself, where it is known: its weights of polynomial bodies are 1 only up to this."""
    noise = float(np.abs(patch.weights - 1.0).max())
    return noise if noise < 1e-12 else 0.0


def differences(ours: Problem, theirs: Problem) -> list[str]:
    """What differs beyond round-off, in words."""
    found = []
    for one, other in zip(ours.bodies, theirs.bodies, strict=True):
        allowed = BOUND + own_noise(other.patch)
        for what, error in {
            "knots": np.max([np.abs(a.knots - b.knots).max() for a, b in zip(one.patch.directions, other.patch.directions, strict=True)]),
            "control points": np.abs(one.patch.control_points - other.patch.control_points).max() / size(other.patch),
            "weights": np.abs(one.patch.weights - other.patch.weights).max(),
        }.items():
            if not error <= allowed:
                found.append(f"{what} of {one.name} differ by {error:.1e} (allowed {allowed:.1e})")
        if replace(one, patch=other.patch) != replace(other, name=one.name):
            found.append(f"material, quadrature or closure of {one.name}")
    names = [c.name for c in ours.contacts]
    if ours.contacts != tuple(replace(c, name=name) for c, name in zip(theirs.contacts, names, strict=True)):
        found.append("contacts")
    if ours.supports != tuple(replace(s, name=own.name) for s, own in zip(theirs.supports, ours.supports, strict=True)):
        found.append("supports and motions")
    if [s.steps for s in ours.stages] != [s.steps for s in theirs.stages]:
        found.append("stages")
    return found


def facts(scene: str, body: Body) -> dict[str, Any]:
    """A sample of a patch that tells it from others: eight control points and sums over all of them."""
    patch = body.patch
    chosen = np.linspace(0, len(patch.weights) - 1, 8).astype(int)
    phases = np.cos(np.arange(len(patch.weights)))
    return {
        "scene": scene,
        "body": body.name,
        "overrides": mesh_overrides(body),
        "knots": [d.knots.tolist() for d in patch.directions],
        "numbers": chosen.tolist(),
        "control_points": patch.control_points[chosen].tolist(),
        "weights": patch.weights[chosen].tolist(),
        "sum_cos_points": (phases @ patch.control_points).tolist(),
        "sum_cos_weights": float(phases @ patch.weights),
        "own_noise": own_noise(patch),
    }


def main() -> None:
    """Compare every explicit scene of the folder; exit code 1 if one differs or there is none."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--facts", type=Path, help="store samples of the distinct patches here")
    options = parser.parse_args()
    sources = [p for p in sorted(options.folder.rglob("*.json")) if not p.name.endswith(".result.json")]
    collected: dict[tuple[str, ...], dict[str, Any]] = {}
    failures = 0
    for source in sources:
        name = source.name.split("_")[0]
        if name not in bundled_scenes():
            sys.exit(f"{source}: there is no bundled scene {name}")
        with TemporaryDirectory() as folder:
            theirs = Scene.load(convert(source, Path(folder))).problem()
        overrides = [o for body in theirs.bodies for o in mesh_overrides(body)]
        overrides += [f"stages.{i}.steps={stage.steps}" for i, stage in enumerate(theirs.stages)]
        overrides += [f"stages.{i}.motions={_motions(name, theirs, i)}" for i in range(len(theirs.stages))]
        found = differences(Scene.load(name, overrides).problem(), theirs)
        failures += bool(found)
        print(f"{source.parent.name}/{source.stem:<20}", "; ".join(found) or "equal")
        for body in theirs.bodies:
            collected.setdefault((name, body.name, *mesh_overrides(body)), facts(name, body))
    if options.facts:
        options.facts.write_text("[\n" + ",\n".join(json.dumps(fact) for fact in collected.values()) + "\n]\n", encoding="utf-8")
    print(f"{len(sources)} scenes, {failures} differ; {len(collected)} distinct patches")
    sys.exit(1 if failures or not sources else 0)


def _motions(name: str, theirs: Problem, stage: int) -> str:
    """The motions of one stage as a TOML value, supports in the bundled scene's names."""
    supports = Scene.load(name).problem().supports
    entries = (
        f'"{own.name}" = {{ translate = {list(other.motions[stage].translate)}, rotate = {other.motions[stage].rotate!r} }}'
        for own, other in zip(supports, theirs.supports, strict=True)
    )
    return "{ " + ", ".join(entries) + " }"


if __name__ == "__main__":
    main()
