"""Scenes in other alphabets: read from a file as they were written, and refused in another encoding than UTF-8."""

from __future__ import annotations

import codecs
import tempfile
from pathlib import Path

from isomortar.errors import InputError
from isomortar.harness import Bound, case
from isomortar.scene import Scene

WORDS = ("größe", "шина", "ゴム")
SCENE = """# für {words}
format = 1
name = "scene"
bodies.block.geometry = {{ kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }}
supports.base.face = "block.w0"
[[stages]]
name = "one"
steps = 1
"""
#: Other encodings, with words that they can write, and a word of what is said of them.
OTHERS = {"latin-1": ("größe", "Latin-1"), "utf-16": ("шина", "UTF-16"), "utf-16-le": ("größe", "UTF-16"), "utf-32": ("ゴム", "UTF-32")}


@case(
    claim="A scene in UTF-8, with a byte-order mark or without, keeps its words as they were written; other encodings are refused by name.",
    tier="gate",
    bounds={
        "others": Bound(0.0, 0.0, "definition: scenes whose text is not that of the file"),
        "taken": Bound(0.0, 0.0, "definition: files that are no UTF-8, and are taken, or refused for something else"),
    },
)
def written() -> dict[str, float]:
    """How many."""
    others = taken = 0
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.toml"
        for words in WORDS:
            for mark in (b"", codecs.BOM_UTF8):
                path.write_bytes(mark + SCENE.format(words=words).encode())
                others += Scene.load(path).to_toml() != SCENE.format(words=words)
        for encoding, (words, word) in OTHERS.items():
            path.write_bytes(SCENE.format(words=words).encode(encoding))
            try:
                Scene.load(path)
            except InputError as error:
                taken += word not in str(error)
            else:
                taken += 1
    return {"others": float(others), "taken": float(taken)}
