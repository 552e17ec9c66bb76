#!/usr/bin/env python3
"""Print the version, for the build: that of the tag ``vX.Y.Z`` of the commit, or of the last one before it and how many came since."""

import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
#: What `git describe` says of a commit, or what `git archive` has put here in its place.
EXPORTED = "$Format:%(describe:tags=true,match=v[0-9]*)$"


def described() -> str:
    """The last tag, with the number of commits since and the last one's hash: ``v0.2.0-5-g1234567``; empty where there is none."""
    if "%" not in EXPORTED:
        return EXPORTED
    command = ["git", "-C", str(ROOT), "describe", "--tags", "--match", "v[0-9]*"]
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):  # no git, no repository, or no tag in it
        return ""


def version(words: str) -> str:
    """The same as a version that Python's packages can have."""
    found = re.fullmatch(r"v([0-9]+(?:\.[0-9]+)*)(?:-([0-9]+)-(g[0-9a-f]+))?", words)
    if not found:
        return "0.1.0.dev0"  # before the first release
    released, since, commit = found.groups()
    return f"{released}.post{since}+{commit}" if since else released


print(version(described()))
