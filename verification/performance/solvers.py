"""Sparse direct solvers behind one face: isomortar's, and those that a person would take instead, where they are installed."""

from __future__ import annotations

from abc import ABC, abstractmethod
from importlib import import_module
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from isomortar._sparse import SparseLU
from isomortar.geometry.patch import FloatArray
from isomortar.solve.system import orderings


class Solver(ABC):
    """A solver of one matrix, shape (n, n). Making it imports what it needs: ImportError where that is not installed."""

    name: str
    install = ""

    def __init__(self, matrix: sparse.csr_array) -> None:
        self.matrix = matrix

    @abstractmethod
    def analyse(self) -> None:
        """Order the unknowns and find the pattern of the factors."""

    @abstractmethod
    def factorise(self) -> None:
        """Factorise once more."""

    @abstractmethod
    def solve(self, right: FloatArray) -> FloatArray:
        """Solution of one right-hand side, shape (n,)."""


class Isomortar(Solver):
    """UMFPACK, ordered and solved as in Newton's method: without refinement."""

    name = "isomortar"

    def analyse(self) -> None:
        """Order; where either ordering may be the faster, by what the first factors take."""
        indptr, indices = (np.asarray(index, dtype=np.int64) for index in (self.matrix.indptr, self.matrix.indices))
        rivals = [SparseLU(indptr, indices, ordering=name) for name in orderings(self.matrix.shape[0])]
        self._lu = min((lu.factorise(self.matrix.data) for lu in rivals), key=lambda lu: lu.flops) if len(rivals) > 1 else rivals[0]

    def factorise(self) -> None:
        """Factorise."""
        self._lu.factorise(self.matrix.data)

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve."""
        return self._lu.solve(right, refine=0)


class Pardiso(Solver):
    """MKL's Pardiso for unsymmetric matrices, with its own defaults: two steps of refinement where pivots were perturbed."""

    name, install = "MKL Pardiso", "pip install pypardiso"

    def __init__(self, matrix: sparse.csr_array) -> None:
        super().__init__(matrix)
        self._solver: Any = import_module("pypardiso").PyPardisoSolver(mtype=11)
        self._none = np.zeros((matrix.shape[0], 1))

    def analyse(self) -> None:
        """Order."""
        self._phase(11, self._none)

    def factorise(self) -> None:
        """Factorise."""
        self._phase(22, self._none)

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve."""
        return self._phase(33, right)

    def _phase(self, phase: int, right: FloatArray) -> FloatArray:
        """One phase alone, which pypardiso's public functions do not offer."""
        self._solver.set_phase(phase)
        return np.asarray(self._solver._call_pardiso(self.matrix, right)).ravel()


class Mumps(Solver):
    """MUMPS for unsymmetric matrices, ordered by METIS."""

    name, install = "MUMPS", "apt-get install libmumps-seq-dev; pip install python-mumps"

    def __init__(self, matrix: sparse.csr_array) -> None:
        super().__init__(matrix)
        self._context: Any = import_module("mumps").Context()
        self._context.set_matrix(sparse.coo_matrix(matrix))

    def analyse(self) -> None:
        """Order."""
        self._context.analyze(ordering="metis")

    def factorise(self) -> None:
        """Factorise."""
        self._context.factor(ordering="metis", reuse_analysis=True)

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve."""
        return np.asarray(self._context.solve(right)).ravel()


class SuperLU(Solver):
    """SuperLU of SciPy, which orders anew at every factorisation."""

    name = "SciPy SuperLU"

    def analyse(self) -> None:
        """Nothing: that is a part of factorising."""

    def factorise(self) -> None:
        """Order and factorise."""
        self._lu = splu(sparse.csc_array(self.matrix))

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve."""
        return np.asarray(self._lu.solve(right))


SOLVERS: tuple[type[Solver], ...] = (Isomortar, Pardiso, Mumps, SuperLU)
