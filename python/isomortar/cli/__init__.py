"""The command line ``isomortar``."""

from isomortar._process import own_process

own_process()

from isomortar.cli.commands import main

__all__ = ["main"]
