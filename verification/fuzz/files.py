"""Results files that are damaged, cut short or edited: plot, export and resume refuse them with a sentence, or give what was written."""

from __future__ import annotations

import functools
import io
import random
import tempfile
from collections.abc import Iterator
from pathlib import Path

import h5py
from forked import program
from fuzz.base_scenes import PRESS
from fuzz.child import Ending, Wrong, ending_of, tally, tried

import isomortar
from isomortar.harness import Bound, case
from isomortar.results.files import sealed
from isomortar.solve.record import Observer, StepResult

#: What is done with a file; `resume` goes on after its only load step.
COMMANDS = ("plot", "export", "resume", "resume")


class _Stop(Observer):
    """Ends a run after its first load step."""

    def recorded(self, _: StepResult) -> None:
        raise KeyboardInterrupt


@functools.cache
def whole() -> bytes:
    """A results file with the first of two load steps."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "whole.h5"
        try:
            isomortar.run(isomortar.Scene.from_toml(PRESS), path, _Stop())
        except KeyboardInterrupt:
            return path.read_bytes()
    raise AssertionError("the run was to be stopped")


def used(number: int, folder: Path) -> Ending:
    """Spoil the file of a number and use it."""
    chance = random.Random(number)
    path, scene = folder / "press.h5", folder / "press.toml"
    sound = whole()
    content = chance.choice(SPOILT)(sound, chance)
    path.write_bytes(content)
    scene.write_text(PRESS)
    command = COMMANDS[number % len(COMMANDS)]
    words = ("run", str(scene), "--quiet", "--resume", "--output", str(path)) if command == "resume" else (command, str(path))
    ending = ending_of(*program(*words, folder=folder))
    if ending.kind == "right" and content != sound and not _is_sealed(content):
        raise Wrong(f"{command} takes a file that is not as it was written")
    if ending.kind != "right" and path.read_bytes() != content:
        raise Wrong(f"{command} refuses a file and changes it")
    return Ending(ending.kind, f"{command}: {ending.said}")


def _is_sealed(content: bytes) -> bool:
    return content == sealed(content)


def _cut(sound: bytes, chance: random.Random) -> bytes:
    return sound[: chance.randrange(len(sound))]


def _flipped(sound: bytes, chance: random.Random) -> bytes:
    """Some bits."""
    spoilt = bytearray(sound)
    for _ in range(chance.choice((1, 1, 3, 20))):
        spoilt[chance.randrange(len(spoilt))] ^= 1 << chance.randrange(8)
    return bytes(spoilt)


def _overwritten(sound: bytes, chance: random.Random) -> bytes:
    """A block of zeros, of noise, or of another place."""
    size = chance.choice((1, 8, 64, 512, 4096))
    at, other = chance.randrange(len(sound) - size), chance.randrange(len(sound) - size)
    return sound[:at] + chance.choice((bytes(size), chance.randbytes(size), sound[other : other + size])) + sound[at + size :]


def _longer(sound: bytes, chance: random.Random) -> bytes:
    return sound + chance.randbytes(chance.choice((1, 512)))


def _untouched(sound: bytes, _: random.Random) -> bytes:
    return sound


def _edited(sound: bytes, chance: random.Random) -> bytes:
    """Something taken out, renamed, or given another value, with a program that knows HDF5."""
    copy = io.BytesIO(sound)
    with h5py.File(copy, "a") as file:
        names: list[str] = []
        file.visit(names.append)
        name = chance.choice(names)
        entry = file[name]
        deed = chance.randrange(4)
        if deed == 0 or (deed == 3 and not isinstance(entry, h5py.Dataset)):
            del file[name]
        elif deed == 1 and len(entry.attrs):
            attribute = chance.choice(list(entry.attrs))
            if chance.random() < 0.5:
                del entry.attrs[attribute]
            else:
                entry.attrs[attribute] = chance.choice((0, "x", b"{}", b"[1, 2", 1e300))
        elif deed == 3 and entry.shape and len(entry):
            entry[0] = chance.choice((0, -1, 10**6)) if entry.dtype.kind in "if" else entry[-1]
        else:
            file.move(name, f"{name}-moved")
    return copy.getvalue()


def _edited_and_sealed(sound: bytes, chance: random.Random) -> bytes:
    """The same by somebody who seals it again: no longer a matter of damage, but no traceback either."""
    return sealed(_edited(sound, chance))


SPOILT = (_cut, _cut, _flipped, _flipped, _overwritten, _longer, _edited, _edited_and_sealed, _untouched)


def endings(first: int, count: int) -> Iterator[tuple[int, Ending]]:
    """How the files of some numbers end."""
    whole()
    for number in range(first, first + count):
        yield number, tried(functools.partial(used, number))


@case(
    claim="A results file that is cut short, damaged or edited is refused by plot, export and resume, and left as it is; one that is as it "
    "was written is taken. No traceback, signal or hang, and never numbers that were not computed.",
    tier=lambda count: "gate" if count < 100 else "nightly",
    grid={"count": (25, 400)},
    bounds={
        "right": Bound(at_least=0.03, at_most=0.4, reason="definition: files that were left alone, or sealed again"),
        "refused": Bound(at_most=0.4, reason="definition: what a file is refused for is no matter of the scene"),
        "stopped": Bound(at_least=0.5, at_most=1.0, reason="definition: most files are spoilt"),
    },
)
def files(count: int) -> dict[str, float]:
    """Shares of the endings; one that is wrong is an error that names its number."""
    return tally(endings(0, count), "python verification/fuzz_at_length.py files")
