"""Packages that only those need who ask for something."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from isomortar.errors import InputError


def optional(package: str, asked: str, extra: str = "") -> Any:
    """A package, which an extra of ours installs, by default one of its name.

    Raises
    ------
    InputError
        It is not installed; `asked` names what needs it.
    """
    try:
        return import_module(package)
    except ImportError as error:
        raise InputError(f"needs {package}, which is not installed: pip install 'isomortar[{extra or package}]'", asked) from error
