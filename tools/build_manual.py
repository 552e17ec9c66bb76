"""Build the manual: run the blocks of its pages, then let Sphinx make pages of them: ``python tools/build_manual.py [FOLDER]``.

The folder, results/manual by default, gets the HTML pages in `html`; `source/docs` is docs/ with what the blocks made. A fenced block of
`sh` or `python` is run, one of `toml` that begins with a comment `# NAME.toml` is written, all in the order of the page and in a folder of
the page's name beside it, where its pictures are; what a block prints follows it on the page. Blocks of `text` are read by people alone. A
block that fails ends the build, and so does any warning of Sphinx. How long a page takes, and how long to its first picture, is printed.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from time import monotonic

ROOT = Path(__file__).parent.parent
_FENCE = re.compile(r"^```(sh|python|toml)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
_NAME = re.compile(r"# (\S+\.toml)\n")
#: Pages whose blocks are run; those of the reference tell of scenes and commands in general, and have tests of their own.
PAGES = ("start.md", "tutorial.md", "gallery.md", "howto/*.md")


class BlockError(Exception):
    """A block of a page failed."""


@dataclass(frozen=True)
class Block:
    """A fenced block of a page."""

    language: str
    text: str

    def run(self, folder: Path) -> str:
        """Run it in a folder, or write its file there; returns what it printed.

        Raises
        ------
        BlockError
            With the end of what it printed.
        """
        if self.language == "toml":
            name = _NAME.match(self.text)
            if name is None:
                raise BlockError("begins with no comment # NAME.toml that says where to write it")
            (folder / name[1]).write_text(self.text, encoding="utf-8")
            return ""
        command = ["bash", "-euo", "pipefail", "-c", self.text]
        if self.language == "python":  # a file, which processes that it starts can import
            (folder / "block.py").write_text(self.text, encoding="utf-8")
            command = [sys.executable, "block.py"]
        search = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)])
        setting = {**os.environ, "PATH": search, "COLUMNS": "110"}
        ended = subprocess.run(command, cwd=folder, env=setting, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if ended.returncode:
            raise BlockError(f"ended with exit code {ended.returncode}:\n{ended.stdout[-2000:]}")
        return ended.stdout


def run_page(path: Path) -> tuple[int, float | None]:
    """Run the blocks of a page, and put what each printed behind it; returns how many there are, and seconds to the first picture.

    Raises
    ------
    BlockError
        Naming page and line.
    """
    folder = path.with_suffix("")
    folder.mkdir(exist_ok=True)
    page, pieces, end = path.read_text(encoding="utf-8"), [], 0
    fences, begun, pictured = list(_FENCE.finditer(page)), monotonic(), None
    for fence in fences:
        try:
            printed = Block(fence[1], fence[2]).run(folder)
        except BlockError as error:
            line = page.count("\n", 0, fence.start(2)) + 1
            raise BlockError(f"{path.name}, line {line}: the block {error}") from None
        if pictured is None and any(folder.rglob("*.png")):
            pictured = monotonic() - begun
        pieces += [page[end : fence.end()], f"\n\n```text\n{printed.rstrip()}\n```" if printed.strip() else ""]
        end = fence.end()
    path.write_text("".join([*pieces, page[end:]]), encoding="utf-8")
    return len(fences), pictured


def kernel() -> str:
    """A page of the Fortran modules: what stands at the head of each, by folder."""
    lines = [
        "# The kernel",
        "",
        "What stands at the head of each module; its public procedures are documented beside it, argument by argument.",
        "",
    ]
    for folder in ("api", "base", "nurbs", "solid", "contact", "sparse"):
        lines += [f"## {folder}", ""]
        for path in sorted((ROOT / "fortran" / folder).rglob("*.f90")):
            head = re.match(r"(?:!> .*\n)+", path.read_text(encoding="utf-8"))
            if head is not None:
                lines += [f"`{path.relative_to(ROOT)}`", f": {' '.join(head[0].replace('!> ', '').split())}", ""]
    return "\n".join(lines)


def build(folder: Path) -> int:
    """Build the manual in a folder, anew; returns how many blocks were run.

    Raises
    ------
    BlockError
    subprocess.CalledProcessError
        Sphinx failed, or warned.
    """
    source = folder / "source" / "docs"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(ROOT / "docs", source)
    for beside in ("fortran", "python", "verification"):  # pages link to sources there
        (source.parent / beside).symlink_to(ROOT / beside)
    (source / "kernel").with_suffix(".md").write_text(kernel(), encoding="utf-8")
    count = 0
    for page in sorted(path for pattern in PAGES for path in source.glob(pattern)):
        print(f"running {page.relative_to(source)}", end=": ", flush=True)
        begun = monotonic()
        blocks, pictured = run_page(page)
        shown = "no picture" if pictured is None else f"the first picture after {pictured:.1f} s"
        print(f"{blocks} blocks in {monotonic() - begun:.1f} s, {shown}", flush=True)
        count += blocks
    subprocess.run([sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html", source, folder / "html"], check=True)
    return count


if __name__ == "__main__":
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "results" / "manual"
    try:
        print(f"{build(target)} blocks run; {target / 'html' / 'index.html'}")
    except (BlockError, subprocess.CalledProcessError) as failure:
        sys.exit(f"the manual is not built: {failure}")
