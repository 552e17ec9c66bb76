"""The command line ``isomortar``."""

import os

# Before anything loads it: threads of the linear algebra library do not make the solves faster, and get in the way of the assembly's.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from isomortar.cli.commands import main

__all__ = ["main"]
