"""The command line ``isomortar``."""

from isomortar._process import own_process
from isomortar.cli.endings import told

own_process()

__all__ = ["main"]


def main() -> None:
    """Run the command line; whatever ends it early becomes one sentence and an exit code."""
    with told():
        from isomortar.cli.commands import app  # within: half a second in which Ctrl-C may come, or a library be missing

        app()
