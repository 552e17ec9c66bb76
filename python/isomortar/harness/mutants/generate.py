"""Faults by rule: the Fortran rules of universalmutator (operators, numbers, comparisons, arguments), in a random order."""

from __future__ import annotations

import contextlib
import io
import random
from collections.abc import Mapping
from itertools import accumulate

from isomortar.errors import InputError
from isomortar.harness.mutants.faults import Fault, fault_at

_RULES = ["universal.rules", "fortran.rules"]
#: Lines that compute nothing: comments, ends of blocks, headings, declarations that give no value.
_IGNORED = [
    r"^\s*(!|&?\s*$)",
    r"^\s*(use|implicit|private|public|module|end|contains|type|else|return|cycle|exit)\b",
    r"::(?!.*=)",
]
#: What rules for languages with braces add to a line: in Fortran no statement, or one that does nothing.
_FOREIGN = ("break;", "continue;")


def draw(sources: Mapping[str, str], seed: int) -> list[Fault]:
    """All faults that the rules make, in the random order of a seed. Many of them do not compile.

    Raises
    ------
    InputError
        universalmutator is not installed.
    """
    faults = [fault for file, text in sources.items() for fault in _faults_of(file, text)]
    random.Random(seed).shuffle(faults)
    return faults


def _faults_of(file: str, text: str) -> list[Fault]:
    try:
        from universalmutator.mutator import mutants_regexp  # optional
    except ImportError:
        raise InputError("universalmutator is not installed: pip install 'isomortar[mutants]'", "sample") from None
    lines = text.splitlines(keepends=True)
    starts = [0, *accumulate(len(line) for line in lines)]
    with contextlib.redirect_stdout(io.StringIO()):
        found = mutants_regexp(lines, _RULES, ignorePatterns=_IGNORED)
    changes = [(number, changed.rstrip("\n")) for number, changed, *_ in found if not changed.rstrip().endswith(_FOREIGN)]
    return [fault_at(file, text, starts[number - 1], lines[number - 1].rstrip("\n"), changed) for number, changed in changes]
