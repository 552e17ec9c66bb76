"""Results: the HDF5 file of a run, its fields for ParaView, curves and pictures."""

from isomortar.results.reader import ContactHistory, Results
from isomortar.results.writer import ResultsWriter

__all__ = ["ContactHistory", "Results", "ResultsWriter"]
