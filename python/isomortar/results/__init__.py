"""Results: the HDF5 file of a run, its fields for ParaView, curves and pictures.

`isomortar.results.pictures.plot` and `isomortar.results.paraview.export` are not imported here: a run needs no Matplotlib.
"""

from isomortar.results.reader import ContactHistory, Results
from isomortar.results.writer import ResultsWriter

__all__ = ["ContactHistory", "Results", "ResultsWriter"]
