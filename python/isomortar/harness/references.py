"""References: ``reference_data/<name>/`` holds ``data.h5`` and ``record.toml``, which says what the data is worth.

A dataset is called as the number that it is compared with, in a group called as the cell's settings where the case has any. Its
attribute ``uncertainty`` (same unit, one number or its shape) is what the tolerance is made of. The record names the class:

- ``exact``: a formula
- ``over-refined``: this program, far finer than what is compared with it
- ``other code``: another program
- ``self``: this program as it was; shows change, never correctness
"""

from __future__ import annotations

import hashlib
import io
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Literal, get_args

import h5py
import numpy as np

from isomortar.errors import InputError
from isomortar.harness.cases import Case, Cell
from isomortar.harness.compare import Expected, Lookup
from isomortar.scene.toml_text import dump

Kind = Literal["exact", "over-refined", "other code", "self"]
KINDS: tuple[Kind, ...] = get_args(Kind)
#: Type of datasets that hold a text: its letters in UTF-8, as numbers are held in double precision, of whatever type they were.
_LETTERS = np.dtype(np.uint8)
#: What every record says of itself, as a text; ``sha256`` is that of ``data.h5``.
FIELDS = ("title", "class", "origin", "made", "uncertainty", "sha256")


class Reference:
    """A reference read from its folder.

    Raises
    ------
    InputError
        Record or data incomplete or changed; a wrong class; a dataset that is not finite or has no uncertainty.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        try:
            self.record = tomllib.loads((folder / "record.toml").read_text())
            content = (folder / "data.h5").read_bytes()
        except OSError as error:
            raise InputError(f"can not be read: {error}", str(folder)) from None
        missing = [name for name in FIELDS if not str(self.record.get(name, "")).strip()]
        if missing:
            raise InputError(f"the record lacks {', '.join(missing)}", str(folder / "record.toml"))
        if self.record["class"] not in KINDS:
            raise InputError(f"class is {self.record['class']!r}; allowed: {', '.join(KINDS)}", str(folder / "record.toml"))
        if hashlib.sha256(content).hexdigest() != self.record["sha256"]:
            raise InputError("is not the data that the record is of: its hash differs", str(folder / "data.h5"))
        self._expected: dict[str, Expected] = {}
        with h5py.File(io.BytesIO(content), "r") as file:
            file.visititems(self._read)

    def _read(self, name: str, item: h5py.Dataset | h5py.Group) -> None:
        if isinstance(item, h5py.Dataset):
            uncertainty = np.asarray(item.attrs.get("uncertainty", np.nan), dtype=np.float64)
            text = bytes(np.asarray(item)).decode() if item.dtype == _LETTERS else None
            values = np.zeros(1) if text else np.asarray(item, dtype=np.float64)
            shapes = uncertainty.shape in ((), values.shape)
            if not (shapes and values.size and np.isfinite(values).all() and np.isfinite(uncertainty).all() and (uncertainty >= 0).all()):
                raise InputError(f"{name} must be finite, not empty, with an uncertainty of zero or more", str(self.folder / "data.h5"))
            self._expected[name] = Expected(values, uncertainty, str(self.record["class"]), text)

    def get(self, cell: Cell, number: str) -> Expected | None:
        """The dataset of a cell and number, of class ``self`` where a run of that case made it; None: there is none."""
        found = self.dataset(dataset_name(cell, number))
        return replace(found, kind="self") if found and self.record["made"] == made_by(cell.case) else found

    def dataset(self, name: str) -> Expected | None:
        """The dataset of a name; None: there is none."""
        return self._expected.get(name)


def made_by(case: Case) -> str:
    """What the record of a reference says that a run of this case made."""
    return f"isomortar bless {case.name}"


def dataset_name(cell: Cell, number: str) -> str:
    """Where in the file the dataset of a cell and number is."""
    return f"{cell.label.replace('/', '|')}/{number}" if cell.settings else number


def finder(folder: Path) -> Lookup:
    """Finds datasets of the references below a folder; each is read once. None where there is no such reference or dataset."""
    known: dict[str, Reference | None] = {}

    def lookup(name: str, cell: Cell, number: str) -> Expected | None:
        if name not in known:
            known[name] = Reference(folder / name) if (folder / name / "record.toml").exists() else None
        reference = known[name]
        return reference.get(cell, number) if reference else None

    return lookup


def write_reference(folder: Path, datasets: Mapping[str, tuple[np.ndarray | str, float]], record: Mapping[str, str]) -> None:
    """Write a reference: values with their absolute uncertainty by dataset name, and a record (all of FIELDS but the hash).

    A text stands there as its letters in UTF-8, compressed; its uncertainty is relative to the numbers in it.
    """
    folder.mkdir(parents=True, exist_ok=True)
    memory = io.BytesIO()
    with h5py.File(memory, "w") as file:
        for name, (values, uncertainty) in sorted(datasets.items()):
            data = np.frombuffer(values.encode(), _LETTERS) if isinstance(values, str) else values
            packed = {"compression": "gzip"} if isinstance(values, str) else {}
            file.create_dataset(name, data=data, track_times=False, **packed).attrs["uncertainty"] = uncertainty
    (folder / "data.h5").write_bytes(memory.getvalue())
    complete = {**record, "sha256": hashlib.sha256(memory.getvalue()).hexdigest()}
    (folder / "record.toml").write_text(dump(complete))
    Reference(folder)
