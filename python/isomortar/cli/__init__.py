"""The command line ``isomortar``."""

from isomortar._process import loading, own_process
from isomortar.cli.endings import told

own_process()

__all__ = ["main"]


def main() -> None:
    """Run the command line; whatever ends it early becomes one sentence and an exit code."""
    with told():
        with loading():
            from isomortar.cli.commands import app  # within: Ctrl-C may come meanwhile, or a library be missing

        app()
