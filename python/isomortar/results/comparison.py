"""Says where two problems differ, and whether one is the other gone on with."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import is_dataclass, replace
from typing import Any

from isomortar.model.entities import Body, Motion, Problem, Support
from isomortar.results.definition import plain

#: What a problem has several of, each by its name.
_KINDS = ("bodies", "contacts", "supports", "stages", "loads")
#: What bodies and contacts have from meshes where nobody asks for another.
_OF_MESHES = ("raised", "raised.face", "raised.orders", "quadrature", "subcells", "projection", "by_default")

#: Leaves of a problem by dotted path.
Leaves = dict[str, Any]


def is_longer(stored: Problem, given: Problem) -> bool:
    """Whether a problem is another one with stages added at its end, or its last stage longer at the same rate, and nothing else."""
    count = len(stored.stages)
    if given.total_steps <= stored.total_steps or len(given.stages) < count:
        return False
    last, longer = stored.stages[-1], given.stages[count - 1]
    if last.steps != longer.steps and any(s.holds(count - 2) and not s.holds(count - 1) for s in given.supports if count > 1):
        return False  # what a support bore goes to zero by the end of the stage
    share = last.steps / longer.steps
    supports = tuple(_first_stages(s, count, share) for s in given.supports)
    loads = tuple(replace(load, factors=_factors(load.factors, count, share)) for load in given.loads)
    stages = (*given.stages[: count - 1], replace(longer, steps=min(last.steps, longer.steps)))
    return not differences(_rounded(stored), _rounded(replace(given, stages=stages, supports=supports, loads=loads)))


def _first_stages(support: Support, count: int, share: float) -> Support:
    """A support in the first stages, and in a share of the last of these."""
    *before, last = support.motions[:count]
    x, y, z = (share * way for way in last.translate)
    motions = (*before, Motion((x, y, z), share * last.rotate))
    held = support.stages and tuple(stage for stage in support.stages if stage < count)
    return replace(support, motions=motions, factors=_factors(support.factors, count, share), stages=held)


def _factors(factors: tuple[float, ...], count: int, share: float) -> tuple[float, ...]:
    """Factors at the ends of the first stages, and where a share of the last of these has passed."""
    if not factors:
        return ()
    *before, last = factors[:count]
    begun = before[-1] if before else 0.0
    return (*before, begun + share * (last - begun))


def _rounded(problem: Problem) -> Problem:
    """What a problem does in its last stage, without the last digits: rates are those of other numbers, to round-off."""
    supports = []
    for support in problem.supports:
        *before, last = support.motions
        x, y, z, angle = (float(f"{value:.12g}") for value in (*last.translate, last.rotate))
        rounded = tuple(float(f"{value:.12g}") for value in support.factors)
        supports.append(replace(support, motions=(*before, Motion((x, y, z), angle)), factors=rounded))
    loads = tuple(replace(load, factors=tuple(float(f"{value:.12g}") for value in load.factors)) for load in problem.loads)
    return replace(problem, supports=tuple(supports), loads=loads)


def differences(stored: Problem, given: Problem) -> list[str]:
    """Where two problems differ: one sentence a field, by its dotted path. Their own names, which may be those of files, are no part.

    What makes others differ is told first, and they are not: entries that one of both has alone or by another name, then bodies of
    another mesh or shape.
    """
    old, new = (_flat(replace(problem, name="")) | _order(problem) | _meshes(problem) for problem in (stored, given))
    missing = object()
    unlike = [path for path in {**old, **new} if old.get(path, missing) != new.get(path, missing)]
    alone = {_entry(path) for path in old} ^ {_entry(path) for path in new}
    called = dict(_called(old, new, alone))
    causes = {entry: f"is called {name.partition('.')[2]} in the scene" for entry, name in called.items()}
    for entry in dict.fromkeys(_entry(path) for path in unlike):
        if entry in alone.difference(called, called.values()):
            causes[entry] = f"in the {'file' if any(_entry(path) == entry for path in old) else 'scene'} alone"
    unlike = [path for path in unlike if _entry(path) not in alone and not _is_names(path, old, new, called)]
    causes |= {path: _both(old, new, path) for path in unlike if path.endswith(".mesh")}
    for body in dict.fromkeys(_entry(path) for path in unlike if ".patch." in path and f"{_entry(path)}.mesh" not in causes):
        causes[f"{body}.patch"] = "another shape, or other sizes of as many elements"
    following = set(_following(old, {_entry(path) for path in causes}))
    causes |= {path: _both(old, new, path) for path in unlike if ".patch." not in path and path not in following}
    return [f"{path}: {said}" for path, said in causes.items()]


def _entry(path: str) -> str:
    """The body, contact, ... that a path begins with."""
    return ".".join(path.split(".")[:2])


def _called(old: Leaves, new: Leaves, alone: set[str]) -> Iterator[tuple[str, str]]:
    """Entries that have another name, and are in the same place and the same otherwise; that name."""
    for kind in _KINDS:
        for one, other in zip(old[kind], new[kind], strict=False):
            pair = f"{kind}.{one}", f"{kind}.{other}"
            if alone.issuperset(pair) and _within(old, pair[0]) == _within(new, pair[1]):
                yield pair


def _within(leaves: Leaves, entry: str) -> Leaves:
    """Leaves of an entry by their paths in it, but for names of its own and of bodies."""
    own = {path.removeprefix(entry): leaf for path, leaf in leaves.items() if _entry(path) == entry}
    return {path: leaf for path, leaf in own.items() if not path.endswith((".name", ".body"))}


def _is_names(path: str, old: Leaves, new: Leaves, called: dict[str, str]) -> bool:
    """Whether names differ there because entries do: a body that is called otherwise, or the list of all where one of both has more."""
    if path in _KINDS:
        return sorted(old[path]) != sorted(new[path])
    return called.get(f"bodies.{old.get(path)}") == f"bodies.{new.get(path)}"


def _following(leaves: Leaves, bodies: set[str]) -> Iterator[str]:
    """What follows from the meshes of bodies: of these, and of contacts that have one of them."""
    contacts = {_entry(path) for path, leaf in leaves.items() if path.startswith("contacts.") and f"bodies.{leaf}" in bodies}
    yield from (f"{entry}.{name}" for entry in bodies | contacts for name in _OF_MESHES)


def _both(old: Leaves, new: Leaves, path: str) -> str:
    return f"{_shown(old, path)} in the file, {_shown(new, path)} in the scene"


def _meshes(problem: Problem) -> dict[str, str]:
    """Elements of each body in words."""
    return {f"bodies.{body.name}.mesh": _mesh(body) for body in problem.bodies}


def _mesh(body: Body) -> str:
    directions = body.patch.directions
    return f"{' x '.join(str(d.elements) for d in directions)} elements of {' x '.join(f'{d.family}{d.order}' for d in directions)}"


def _flat(value: Any, path: str = "") -> Leaves:
    """Leaves of a problem; entries of lists go by their name where they have one. Lists of numbers are leaves."""
    content = plain(value) if is_dataclass(value) else value
    if isinstance(content, dict):
        entries = content.items()
    elif isinstance(content, list) and any(isinstance(entry, dict) for entry in content):
        entries = {str(entry.get("name", number)): entry for number, entry in enumerate(content)}.items()
    else:
        return {path: content}
    return {p: v for key, entry in entries for p, v in _flat(entry, f"{path}.{key}".lstrip(".")).items()}


def _order(problem: Problem) -> Leaves:
    """Names in the order in which numbers of the results file stand."""
    return {kind: [entry.name for entry in getattr(problem, kind)] for kind in _KINDS}


def _shown(leaves: Leaves, path: str) -> str:
    if path not in leaves:
        return "nothing"
    text = leaves[path] if path.endswith(".mesh") else repr(leaves[path])
    return text if len(text) <= 60 else f"other numbers ({text[:30]}...)"
