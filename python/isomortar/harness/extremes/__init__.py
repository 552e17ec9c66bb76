"""The program at its extremes: runs as a user starts them, how each ends, and the page that shows where it can be trusted."""

from isomortar.harness.extremes.endings import Ending, digits, endings, judge
from isomortar.harness.extremes.runs import Run, program, run

__all__ = ["Ending", "Run", "digits", "endings", "judge", "program", "run"]
