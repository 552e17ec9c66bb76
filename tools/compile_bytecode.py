"""Compile the package's Python for a working copy, so that no start has to: where Python is told to keep nothing, each would.

Called by the build, `python tools/compile_bytecode.py PACKAGE STAMP DEPENDENCIES`, when a file or folder of the package has changed.
"""

import compileall
import sys
from pathlib import Path
from py_compile import PycInvalidationMode

package, stamp, dependencies = map(Path, sys.argv[1:])
# Checked by their sources' hashes: two versions of a file may be of one second and size. A wrong file is told of by its import.
compileall.compile_dir(package, quiet=2, invalidation_mode=PycInvalidationMode.CHECKED_HASH)
sources = [path for path in (package, *package.rglob("*")) if path.name != "__pycache__" and (path.is_dir() or path.suffix == ".py")]
dependencies.write_text(f"{stamp}: {' '.join(str(path).replace(' ', chr(92) + ' ') for path in sources)}\n")
stamp.touch()
