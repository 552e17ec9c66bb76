"""The program ``isomortar-factor``: a rank beside `isomortar run` that factorises with it (docs/engines.md)."""

from __future__ import annotations

from isomortar.cli.endings import told
from isomortar.errors import InputError


def main() -> None:
    """Factorise with the first rank until that ends; what ends it early becomes one sentence and an exit code."""
    with told():
        from isomortar import _distributed  # within: Ctrl-C may come meanwhile, or a library be missing

        if _distributed.serve() == 0:
            raise InputError(f"isomortar-factor is no program of its own: {_distributed.STARTED_BY}")
