"""Write the C wrapper of the kernel's API files with f2py, and refuse what f2py would get wrong silently.

Usage: ``f2py_wrap.py MODULE OUTPUT_DIRECTORY FILE...``; writes ``MODULEmodule.c``. f2py maps a kind that it does not
know to C ``float`` or ``int`` and only says so in its log: here that is an error. So is anything that needs
a Fortran wrapper (a function, a module): the API is bare subroutines.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path


def main(module: str, directory: str, *sources: str) -> int:
    """Run f2py; the exit code is 1 if the wrapper cannot be trusted."""
    command = [sys.executable, "-m", "numpy.f2py", "--lower", "-m", module, "--build-dir", directory, *sources]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    log = (run.stdout + run.stderr).splitlines()
    guesses = [line.strip() for line in log if "mapped to C" in line]
    wrappers = [path.name for path in Path(directory).glob(f"{module}-f2pywrappers*") if "subroutine" in path.read_text().lower()]
    if run.returncode:
        print(*log, sep="\n", file=sys.stderr)
        return 1
    if guesses:
        print(f"f2py guessed a kind in {', '.join(sources)}; use kinds of iso_c_binding there:", *guesses, sep="\n  ", file=sys.stderr)
        return 1
    if wrappers:
        print(f"f2py wants Fortran wrappers ({', '.join(wrappers)}); keep to bare subroutines in the API", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
