"""A run that its user stops on the way."""

from isomortar.solve.record import Observer, StepResult


class Stopped(Observer):
    """Ends a run, as Ctrl-C does, once a load step is recorded."""

    def __init__(self, after: int) -> None:
        self._after = after

    def recorded(self, result: StepResult) -> None:
        if result.step == self._after:
            raise KeyboardInterrupt
