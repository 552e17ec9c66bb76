"""Tables on a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console, RenderableType

#: Columns that tables are laid out for: Rich cuts words and numbers on fewer, a terminal folds the lines.
COLUMNS = 80


def print_whole(console: Console, table: RenderableType) -> None:
    """Print a table with all of its numbers, however narrow the terminal is."""
    console.width = max(console.width, COLUMNS)
    console.print(table)
