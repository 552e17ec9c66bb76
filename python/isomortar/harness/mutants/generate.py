"""Faults by rule: the rules of universalmutator for a language (operators, numbers, comparisons, arguments), in a random order."""

from __future__ import annotations

import contextlib
import io
import random
from collections.abc import Mapping
from itertools import accumulate

from isomortar.errors import InputError
from isomortar.harness.mutants.faults import Fault, fault_at
from isomortar.harness.mutants.layers import Layer

#: What rules for languages with braces add to a line: no statement, or one that does nothing.
_FOREIGN = ("break;", "continue;")


def draw(layer: Layer, sources: Mapping[str, str], seed: int) -> list[Fault]:
    """All faults that the rules of a layer make in its sources, in the random order of a seed. Many of them do not compile.

    Raises
    ------
    InputError
        universalmutator is not installed.
    """
    faults = [fault for file, text in sources.items() for fault in _faults_of(layer, file, text)]
    random.Random(seed).shuffle(faults)
    return faults


def _faults_of(layer: Layer, file: str, text: str) -> list[Fault]:
    try:
        from universalmutator.mutator import mutants_regexp  # optional
    except ImportError:
        raise InputError("universalmutator is not installed: pip install 'isomortar[mutants]'", "sample") from None
    lines = text.splitlines(keepends=True)
    starts = [0, *accumulate(len(line) for line in lines)]
    with contextlib.redirect_stdout(io.StringIO()):
        found = mutants_regexp(lines, ["universal.rules", layer.rules], ignorePatterns=list(layer.ignored))
    changes = [(number, changed.rstrip("\n")) for number, changed, *_ in found if not changed.rstrip().endswith(_FOREIGN)]
    return [fault_at(file, text, starts[number - 1], lines[number - 1].rstrip("\n"), changed) for number, changed in changes]
