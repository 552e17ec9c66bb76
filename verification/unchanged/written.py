"""Files that a user can have, in words: what is in them, a line a thing, with numbers that are printed in full or told by a few of all."""

from __future__ import annotations

import base64
import json
import re
import zlib
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import h5py
import numpy as np
from numpy.typing import ArrayLike
from PIL import Image

#: So many numbers are printed; of more their count, the first, the ends of their range, their mean, and one that tells their order.
PRINTED = 8
#: Waves that tell the order of numbers have no period that a mesh has: golden angles, in radians.
_ANGLE = np.pi * (3.0 - np.sqrt(5.0))
#: What only a machine tells: times, and counts of searches that round-off lengthens by a few of some ten thousand.
_OF_MACHINES = re.compile(r"timings/|counters/(evaluations|elements searched|history)")
#: Parts of a page that are no words of it.
_SILENT = ("style", "script")


def numbers(values: ArrayLike) -> str:
    """An array in words."""
    array = np.asarray(values)
    flat = array.ravel().astype(np.float64)
    if flat.size <= PRINTED:
        return f"({', '.join(f'{value + 0.0:.9g}' for value in flat)})"
    known = flat[np.isfinite(flat)]
    waves = np.cos(_ANGLE * np.flatnonzero(np.isfinite(flat)))
    parts = [known[0], known.min(), known.max(), known.mean(), np.abs(known).mean(), (waves * known).mean()] if known.size else []
    return f"{'x'.join(map(str, array.shape))}, {flat.size - known.size} unknown: ({', '.join(f'{part + 0.0:.9g}' for part in parts)})"


def results_lines(path: Path) -> Iterator[str]:
    """A results file: every dataset by its name, what it says of itself, and its numbers, but for what only the machine tells."""
    found: list[str] = []

    def note(name: str, item: h5py.Dataset | h5py.Group) -> None:
        said = {key: str(item.attrs[key]) for key in sorted(item.attrs)}
        if isinstance(item, h5py.Dataset):
            found.append(f"{name} {said} {item.dtype}: {'' if _OF_MACHINES.match(name) else _dataset(item)}")
        else:
            found.append(f"{name}/ {said}")

    with h5py.File(path) as file:
        note("", file)
        file.visititems(note)
    yield from found


def _dataset(item: h5py.Dataset) -> str:
    if item.dtype.names:
        return "; ".join(f"{name} {numbers(item[()][name])}" for name in item.dtype.names)
    if item.dtype.kind in "OS":
        texts = np.atleast_1d(item.asstr()[()]).ravel().tolist()
        return repr([text if len(text) < 300 else f"{text[:80]} ... {len(text)} letters" for text in texts[:12]])
    return numbers(item[()])


def vtk_lines(path: Path) -> Iterator[str]:
    """A file for ParaView: elements with what they say, and their arrays."""
    for element in ElementTree.parse(path).getroot().iter():
        said = " ".join(f"{name}={value}" for name, value in sorted(element.attrib.items()))
        yield f"{element.tag} {said}{_array(element)}"


def _array(element: ElementTree.Element) -> str:
    if element.tag != "DataArray":
        return ""
    kind = np.dtype(element.attrib["type"].lower())
    raw = base64.b64decode(str(element.text))
    size = int(np.frombuffer(raw[:8], np.uint64)[0])
    return f" {size} bytes: {numbers(np.frombuffer(raw[8:], kind))}"


def json_lines(value: Any, place: str = "") -> Iterator[str]:
    """Plain data: a line an entry by its place, lists of numbers in one."""
    if isinstance(value, dict):
        for name, entry in value.items():
            yield from json_lines(entry, f"{place}.{name}")
    elif isinstance(value, list) and value and not all(isinstance(entry, int | float) for entry in value):
        if all(isinstance(entry, list) and entry and all(isinstance(v, int | float) for v in entry) for entry in value):
            yield f"{place} {numbers(np.concatenate([np.asarray(entry, float) for entry in value]))}"
            return
        for number, entry in enumerate(value):
            yield from json_lines(entry, f"{place}[{number}]")
    elif isinstance(value, list):
        yield f"{place} {numbers([float(entry) for entry in value])}"
    else:
        yield f"{place} {value!r}"


class _Page(HTMLParser):
    """Words of a page, and what its elements say of themselves."""

    def __init__(self) -> None:
        super().__init__()
        self.said: list[str] = []
        self._silent = 0

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Begin an element."""
        self._silent += tag in _SILENT
        told = " ".join(f"{name}={value}" for name, value in attrs if len(str(value)) < 2000)
        if told and not self._silent:
            self.said.append(f"<{tag} {told}>")

    def handle_endtag(self, tag: str) -> None:
        """End it."""
        self._silent -= tag in _SILENT

    def handle_data(self, data: str) -> None:
        """Say what stands in it."""
        words = " ".join(data.split())
        if words and not self._silent:
            self.said.append(words)


def page_lines(text: str) -> Iterator[str]:
    """A page without its style and its program."""
    page = _Page()
    page.feed(text)
    yield from page.said


def view_lines(text: str) -> Iterator[str]:
    """A page that shows a run: its words, what it tells its program, and the numbers of its surfaces."""
    yield from page_lines(text)
    for name, content in re.findall(r'<script type="[^"]*" id="(\w+)">(.*?)</script>', text, re.DOTALL):
        if content.lstrip().startswith("{"):
            yield from json_lines(json.loads(content), name)
        else:
            yield f"{name}: {numbers(np.frombuffer(zlib.decompress(base64.b64decode(content)), '<f4'))}"


def film_lines(path: Path) -> Iterator[str]:
    """A film: its type, its pictures, and how long each is shown."""
    with Image.open(path) as film:
        yield f"{film.format} of {getattr(film, 'n_frames', 1)} pictures, {film.info.get('duration')} ms, again {film.info.get('loop')}"
