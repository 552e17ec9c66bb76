"""Measure the points of the sweeps to the extremes with another program, as what stands beside this one's on the page.

    python verification/extremes_before.py COMMIT /path/of/its/bin/isomortar

measures those points that ``extremes/before.json`` does not hold yet, one after the other, and adds them; a run that was killed goes on.
The program is built by `make setup` in a checkout of that commit.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

from extremes import page, points
from extremes.points import Earlier, point_of
from extremes.trials import program

from isomortar.harness.cases import Cell
from isomortar.harness.collection import collect
from isomortar.harness.measurement import measure

_CASES = Path(__file__).parent


def cells() -> Iterator[Cell]:
    """The points of all tiers."""
    for case in collect(_CASES):
        yield from (cell for cell in case.cells if points.is_point(cell))


def main() -> None:
    """Measure what is not there; what no sweep has any more is dropped."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("commit")
    parser.add_argument("program", type=Path)
    options = parser.parse_args()
    path = _CASES / "extremes" / page.BEFORE
    known = points.read(path)
    wanted = {cell.name: cell for cell in cells()}
    found = {name: point for name, point in known.points.items() if known.commit == options.commit and name in wanted}
    with program([str(options.program.resolve())]):
        for name, cell in wanted.items():
            if name not in found:
                found[name] = point_of(measure(cell))
                points.write(path, Earlier(options.commit, found))
                print(f"{found[name].ending.name.lower():8} {found[name].digits:5.1f}  {name}  {found[name].words}", flush=True)


if __name__ == "__main__":
    main()
