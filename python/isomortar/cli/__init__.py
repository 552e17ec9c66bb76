"""The command line ``isomortar``."""

import os
import sys
from io import TextIOWrapper

from isomortar._process import loading, own_process
from isomortar.cli.endings import told

own_process()

__all__ = ["main"]


def main() -> None:
    """Run the command line; whatever ends it early becomes one sentence and an exit code.

    Figures go into files: what the environment names for Matplotlib to show them by, be it there or not, has no part in them. Letters that
    the terminal does not have, in help or in a file's name, are written by their number.
    """
    os.environ["MPLBACKEND"] = "agg"
    if isinstance(sys.stdout, TextIOWrapper) and sys.stdout.errors == "strict":
        sys.stdout.reconfigure(errors="backslashreplace")
    with told():
        with loading():
            from isomortar.cli.commands import asked  # within: Ctrl-C may come meanwhile, or a library be missing

        asked(sys.argv[1:])()
