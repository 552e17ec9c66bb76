"""The exceptions of isomortar: one tree, so that ``except IsomortarError`` catches all that we raise on purpose."""

from __future__ import annotations


class IsomortarError(Exception):
    """Base of every error that isomortar raises on purpose. Its text says what, where and what to do."""


class IsomortarWarning(UserWarning):
    """What is doubtful of a scene or a run, where nothing else hears it. Its text says what, where and what to do."""


class InputError(IsomortarError, ValueError):
    """The input is wrong. Raised before any work starts.

    Parameters
    ----------
    message : str
        What is wrong and what is allowed.
    field : str, optional
        The field that is wrong, as a dotted path into the scene file (``bodies.slave.patch.knots``).
    """

    def __init__(self, message: str, field: str | None = None) -> None:
        self.message = message
        self.field = field
        super().__init__(f"{field}: {message}" if field else message)


class KernelError(IsomortarError):
    """The kernel returned a failure status.

    Parameters
    ----------
    message : str
        The status as a sentence.
    place : int
        Number of the element, control point or quadrature point the kernel named (0-based); -1: none.
    """

    def __init__(self, message: str, place: int = -1) -> None:
        self.place = place
        super().__init__(message)


class FoldedElementError(KernelError):
    """J <= 0 at a quadrature point: rejects a Newton iterate, or a body whose initial shape is folded."""


class LostProjectionError(KernelError):
    """The closest-point projection found no point."""


class PassedThroughError(LostProjectionError):
    """A slave's point has gone through the body of its master."""


class SingularSystemError(KernelError):
    """The linear system is singular or nearly so: a body that nothing holds, or redundant constraints."""


class ConvergenceError(IsomortarError):
    """A load step did not converge and could not be cut further. What had converged is kept."""


class PathError(ConvergenceError):
    """A load increment is longer than `solver.path_tolerance` allows.

    Parameters
    ----------
    error, tolerance : float
        Its estimated error, and what is allowed.
    """

    def __init__(self, error: float, tolerance: float) -> None:
        self.error = error
        super().__init__(f"the path error of the multipliers is {error:.2e}, above solver.path_tolerance = {tolerance:g}")


class ResultsError(IsomortarError):
    """A results file is missing, damaged, or does not belong to the scene."""
