"""``python -m isomortar``: the command line."""

from isomortar.cli import main

main()
