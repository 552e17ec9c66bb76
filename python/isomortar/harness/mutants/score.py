"""What a campaign says about the gate: shares with their intervals, who caught what, and what people said of the survivors."""

from __future__ import annotations

import tomllib
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from scipy.stats import binomtest

from isomortar._frozen import frozen
from isomortar.errors import InputError
from isomortar.harness.mutants.campaign import Attacked, Tally

#: What a survivor can be. An ``equivalent`` one computes the same; ``not caught`` is a gap of the gate.
CLASSES = ("equivalent", "performance only", "precision only", "not caught")


@frozen
class Classification:
    """What somebody found out about a survivor, and why it is so."""

    kind: str
    reason: str


@frozen
class Share:
    """`part` of `whole`, with Wilson's 95 % interval of the share that a random sample stands for."""

    part: int
    whole: int

    @property
    def value(self) -> float:
        """The share; NaN of nothing."""
        return self.part / self.whole if self.whole else np.nan

    @property
    def interval(self) -> tuple[float, float]:
        """Wilson's interval at 95 %."""
        if not self.whole:
            return 0.0, 1.0
        found = binomtest(self.part, self.whole).proportion_ci(0.95, method="wilson")
        return float(found.low), float(found.high)

    def __str__(self) -> str:
        low, high = self.interval
        return f"{self.part} of {self.whole} ({100 * self.value:.1f} %, interval {100 * low:.1f} to {100 * high:.1f} %)"


class Score:
    """The tally of a campaign, counted.

    Parameters
    ----------
    tally : Tally
    classified : dict of key to Classification
        What is known about survivors.
    least_share : float
        Of the random faults, without those classified as equivalent, that must be caught.
    """

    def __init__(self, tally: Tally, classified: dict[str, Classification], least_share: float) -> None:
        self.tally, self.classified, self.least_share = tally, classified, least_share
        self.planted = [a for a in tally.attacked if a.fault.name]
        self.sample = [a for a in tally.attacked if not a.fault.name]

    @property
    def caught_planted(self) -> Share:
        """Of the faults planted by hand."""
        return _caught(self.planted)

    @property
    def caught(self) -> Share:
        """Of the random faults."""
        return _caught(self.sample)

    @property
    def caught_of_real(self) -> Share:
        """Of the random faults that are not classified as equivalent."""
        return _caught([a for a in self.sample if self.kind(a) != "equivalent"])

    @property
    def caught_by_folder(self) -> dict[str, tuple[Share, Share]]:
        """Of the random faults in each folder of the sources: of all, and of those that are not classified as equivalent."""
        found = {}
        for folder in self.folders:
            within = [a for a in self.sample if a.fault.folder == folder]
            found[folder] = _caught(within), _caught([a for a in within if self.kind(a) != "equivalent"])
        return found

    @property
    def survivors(self) -> list[Attacked]:
        """Faults that no cell was red on; planted ones first."""
        return [a for a in self.tally.attacked if a.finding.killer is None]

    def kind(self, attacked: Attacked) -> str:
        """Class of a survivor, or that it has none yet."""
        known = self.classified.get(attacked.fault.key)
        return known.kind if known else "not classified"

    @property
    def passes(self) -> bool:
        """Every planted fault is caught, and of a sample the share that must be."""
        sampled = not self.sample or self.caught_of_real.value >= self.least_share
        return bool(self.tally.attacked) and self.caught_planted.part == self.caught_planted.whole and sampled

    @property
    def catches(self) -> dict[str, Counter[str]]:
        """By family of the first red cell: how many faults, by folder of the sources."""
        found: dict[str, Counter[str]] = {}
        for attacked in self.tally.attacked:
            if attacked.finding.killer:
                found.setdefault(attacked.finding.killer.partition("/")[0], Counter())[attacked.fault.folder] += 1
        return dict(sorted(found.items(), key=lambda item: -item[1].total()))

    @property
    def folders(self) -> list[str]:
        """Folders of the sources with faults."""
        return sorted({a.fault.folder for a in self.tally.attacked})


def _caught(attacked: Sequence[Attacked]) -> Share:
    return Share(sum(a.finding.killer is not None for a in attacked), len(attacked))


def read_classified(path: Path) -> dict[str, Classification]:
    """A TOML file of ``[[survivor]]`` with key, class and reason (and what helps people, such as place and change).

    Raises
    ------
    InputError
        A class that is none, no reason.
    """
    if not path.exists():
        return {}
    try:
        entries = tomllib.loads(path.read_text()).get("survivor", [])
    except tomllib.TOMLDecodeError as error:
        raise InputError(str(error), str(path)) from None
    found = {}
    for entry in entries:
        where = f"{path}: {entry.get('key', 'an entry without key')}"
        if not {"key", "class", "reason"} <= entry.keys() or not entry["reason"].strip():
            raise InputError("needs key, class and reason", where)
        if entry["class"] not in CLASSES:
            raise InputError(f"class is {entry['class']!r}; allowed: {', '.join(CLASSES)}", where)
        found[entry["key"]] = Classification(entry["class"], entry["reason"])
    return found
