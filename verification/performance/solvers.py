"""Sparse direct solvers behind one face: isomortar's, and those that a person would take instead, where they are installed."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from performance.problems import System
from scipy import sparse
from scipy.sparse.linalg import splu

from isomortar.geometry.patch import FloatArray


class Solver(ABC):
    """A solver of one system of n unknowns. Making it imports what it needs: ImportError where that is not installed.

    `applies` says of a system whether the solver is for its like.
    """

    name: str
    install = ""

    def __init__(self, system: System) -> None:
        self.system = system

    @staticmethod
    def applies(system: System) -> bool:  # noqa: ARG004
        """Whether it is made for systems of this kind."""
        return True

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
    """As in Newton's method: bodies by Cholesky and faces by dense LU, or UMFPACK where that takes fewer operations."""

    name = "isomortar"

    def analyse(self) -> None:
        """Order, and choose."""
        self._factors = self.system.analysed()

    def factorise(self) -> None:
        """Gather and factorise."""
        self.system.factorise(self._factors)

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve, with refinement where that is called for."""
        return self._factors.solve(right)


class Cholmod(Solver):
    """CHOLMOD by scikit-sparse, for what is symmetric and definite."""

    name, install = "CHOLMOD", "apt-get install libsuitesparse-dev; pip install scikit-sparse"

    def __init__(self, system: System) -> None:
        super().__init__(system)
        self._cholmod: Any = import_module("sksparse.cholmod")
        self._matrix = sparse.csc_array(system.matrix)

    @staticmethod
    def applies(system: System) -> bool:
        """To a solid alone."""
        return system.definite

    def analyse(self) -> None:
        """Order."""
        self._factor = self._cholmod.analyze(self._matrix, mode="supernodal")

    def factorise(self) -> None:
        """Factorise."""
        self._factor.cholesky_inplace(self._matrix)

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve."""
        return np.asarray(self._factor(right))


class Pardiso(Solver):
    """MKL's Pardiso, with its own defaults: two steps of refinement where pivots were perturbed."""

    name, install = "MKL Pardiso", "pip install pypardiso"

    def __init__(self, system: System) -> None:
        super().__init__(system)
        definite = system.definite
        self._solver: Any = import_module("pypardiso").PyPardisoSolver(mtype=2 if definite else 11)
        self._matrix = sparse.csr_array(sparse.triu(system.matrix)) if definite else system.matrix
        self._none = np.zeros((system.matrix.shape[0], 1))

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
        return np.asarray(self._solver._call_pardiso(self._matrix, right)).ravel()


class Mumps(Solver):
    """MUMPS, ordered by METIS."""

    name, install = "MUMPS", "apt-get install libmumps-seq-dev; pip install python-mumps"

    def __init__(self, system: System) -> None:
        super().__init__(system)
        mumps: Any = import_module("mumps")
        if re.search(r"/libmpi(_\w+)?\.so", Path("/proc/self/maps").read_text()):
            raise ImportError("the MUMPS that is found is for MPI, and ends a process that mpirun did not start")
        self._context = mumps.Context()
        self._context.set_matrix(sparse.coo_matrix(system.matrix), symmetric=system.definite)

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
        self._lu = splu(sparse.csc_array(self.system.matrix))

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve."""
        return np.asarray(self._lu.solve(right))


SOLVERS: tuple[type[Solver], ...] = (Isomortar, Cholmod, Pardiso, Mumps, SuperLU)
