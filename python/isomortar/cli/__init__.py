"""The command line ``isomortar``."""

from isomortar.cli.commands import main

__all__ = ["main"]
