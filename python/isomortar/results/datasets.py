"""Datasets that grow by a row at a time, each opened once: h5py's own take six times as long for a row, of which a load step has sixty."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import h5py
import numpy as np

from isomortar.results import layout


class Datasets:
    """The datasets of a file that is being written.

    Parameters
    ----------
    file : h5py.File
        Open for writing.
    """

    def __init__(self, file: h5py.File) -> None:
        self._file = file
        self._opened: dict[str, h5py.h5d.DatasetID] = {}
        self._named: dict[str, set[str]] = {}

    def make(self, group: str, quantities: Mapping[str, layout.Quantity]) -> None:
        """Empty datasets of a group, where the quantities tell the shape of a row."""
        for name, quantity in quantities.items():
            self._make(f"{group}/{name}", quantity, quantity.row)

    def put(self, group: str, quantities: Mapping[str, layout.Quantity], source: object, row: int) -> None:
        """Write row `row`, the last one, of each dataset of a group: what the attributes of `source` are."""
        for name, quantity in quantities.items():
            self.put_row(f"{group}/{name}", quantity, getattr(source, name), row)

    def put_named(self, group: str, quantity: layout.Quantity, values: Mapping[str, float] | Mapping[str, str], row: int) -> None:
        """Write one row of each dataset of a group; a name that only some steps have is filled up."""
        names = self._named[group] = {*(self._named.get(group) or self._file[group]), *values}
        for name in names:
            self.put_row(f"{group}/{name}", quantity, values.get(name, quantity.missing), row)

    def rows(self, path: str) -> int:
        """How many rows a dataset has."""
        return int(self._dataset(path).shape[0])

    def put_row(self, path: str, quantity: layout.Quantity, value: Any, row: int) -> None:
        """Write row `row` of a dataset, its last one; make the dataset at its first row."""
        value = np.asarray(value, dtype=quantity.dtype)
        if path not in self._opened and path not in self._file:
            self._make(path, quantity, value.shape)
        self._write(path, value[None], row)

    def extend(self, path: str, rows: Sequence[Any]) -> None:
        """Write rows after those that a dataset has."""
        dataset = self._dataset(path)
        self._write(path, np.array(rows, dtype=dataset.dtype), dataset.shape[0])

    def _write(self, path: str, rows: np.ndarray, first: int) -> None:
        """Write rows from `first` on; what lay behind them is cut off."""
        dataset = self._dataset(path)
        dataset.set_extent((first + len(rows), *rows.shape[1:]))
        if rows.size and rows.dtype == layout.TEXT:
            h5py.Dataset(dataset)[first:] = rows
        elif rows.size:
            place = dataset.get_space()
            place.select_hyperslab((first, *(0 for _ in rows.shape[1:])), rows.shape)
            dataset.write(h5py.h5s.create_simple(rows.shape), place, np.ascontiguousarray(rows))

    def _dataset(self, path: str) -> h5py.h5d.DatasetID:
        if path not in self._opened:
            self._opened[path] = h5py.h5d.open(self._file.id, path.encode())
        return self._opened[path]

    def _make(self, path: str, quantity: layout.Quantity, row: tuple[int, ...]) -> None:
        """An empty dataset that grows along its first axis, in chunks of about 1 kB, at least one row."""
        rows = max(1, 128 // max(1, int(np.prod(row))))
        dataset = self._file.create_dataset(
            path,
            shape=(0, *row),
            maxshape=(None, *row),
            chunks=(rows, *(max(n, 1) for n in row)),
            dtype=quantity.dtype,
            fillvalue=quantity.missing,
            fletcher32=quantity.dtype != layout.TEXT,
        )
        dataset.attrs["unit"], dataset.attrs["description"] = quantity.unit, quantity.description
        self._opened[path] = dataset.id
