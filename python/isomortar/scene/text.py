"""Text of files that people write: UTF-8, and the name of what it is where it is not."""

from __future__ import annotations

import codecs
from pathlib import Path
from shlex import quote

from isomortar.errors import InputError

#: How results files begin.
_RESULTS = b"isomortar results file;"
#: Marks at the beginning of a file, the longer one of two that begin alike first.
_MARKS = {
    codecs.BOM_UTF32_LE: "UTF-32",
    codecs.BOM_UTF32_BE: "UTF-32",
    codecs.BOM_UTF16_LE: "UTF-16",
    codecs.BOM_UTF16_BE: "UTF-16",
}


def read_text(path: Path) -> str:
    """Text of a file in UTF-8, without the byte-order mark that some editors put before it.

    Parameters
    ----------
    path : Path

    Raises
    ------
    InputError
        It is in another encoding, which is named, or a results file.
    """
    content = path.read_bytes().removeprefix(codecs.BOM_UTF8)
    if content.startswith(_RESULTS):
        raise InputError(f"{path} is a results file, and no text: isomortar info {quote(str(path))} says what it holds")
    marked = next((name for mark, name in _MARKS.items() if content.startswith(mark)), None)
    if marked or b"\0" in content:  # ASCII in UTF-16 without a mark is valid UTF-8, with zeros in between
        raise InputError(f"{path} is {marked or 'UTF-16'} text (or none at all): save it as UTF-8")
    try:
        return content.decode()
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"{path} is Latin-1 or Windows-1252 text, most likely: byte {content[error.start]:#x} in line {line} is not UTF-8. "
            "In your editor, save it as UTF-8"
        ) from error
