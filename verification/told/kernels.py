"""Files that are named as kernels and are none: each is refused, in words that say what it is."""

from __future__ import annotations

import tempfile
from pathlib import Path

from isomortar._compiled import kernel_at, suited_kernel
from isomortar.errors import InputError
from isomortar.harness import Bound, case

#: What a file is called, what stands in it (nothing: there is none; /: a folder), and words of what is said.
FILES = {
    "lost.py": (None, "is no file of a module"),
    "lost.so": (None, "is no file of a module"),
    "folder.py": ("/", "is no file of a module"),
    "text.txt": ("no module", "is no file of a module"),
    "broken.py": ("def add_body(:\n", "cannot be imported"),
    "broken.so": ("no library", "cannot be imported"),
    "empty.py": ("", "has no add_body"),
    "data.py": ("add_body = 1\n", "has no add_body"),
}


@case(
    claim="What is no kernel is refused as one: a file that is not there, a folder, another file, one with errors, a module that "
    "lacks routines.",
    tier="gate",
    bounds={"silent": Bound(0.0, 0.0, "definition: those that are taken, or of which something else is said")},
)
def no_kernel() -> dict[str, float]:
    """How many."""
    silent = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, (text, words) in FILES.items():
            path = Path(folder) / name
            if text == "/":
                path.mkdir()
            elif text is not None:
                path.write_text(text)
            try:
                kernel_at(path, suited_kernel())
                silent += 1
            except InputError as error:
                silent += words not in str(error)
    return {"silent": float(silent)}
