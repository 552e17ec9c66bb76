#!/usr/bin/env bash
# Formatters and linters in check mode, all of them even when one complains; fails if any did.
set -uo pipefail
cd "$(dirname "$0")/.."
export PATH="$PWD/.venv/bin:$PATH"

failed=()
check() {
  local name=$1
  shift
  printf '==> %s\n' "$name"
  "$@" || failed+=("$name")
}

# Without the import hook of the editable install, behind which import-linter finds no files. The standard library comes before
# site-packages, where a dependency of universalmutator leaves an old `typing`.
layers() {
  python -S -c '
import sys
sys.path = ["python", *sys.path, sys.argv[1]]
sys.argv[1:] = ["--no-logo"]
from importlinter.cli import lint_imports_command
lint_imports_command()' "$(python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')"
}

check "Python format (ruff format)" ruff format --quiet --check .
check "Python (ruff)" ruff check --quiet --output-format=concise .
check "types (mypy)" mypy
check "types of the cases (mypy)" mypy verification
check "layers of the package (import-linter)" layers
check "Fortran format (findent)" bash tools/format_fortran.sh --check
check "Fortran (fortitude)" fortitude check --quiet --output-format=concise
check "compiler warnings" bash tools/build_debug.sh

if [ ${#failed[@]} -gt 0 ]; then
  printf 'failed: %s\n' "${failed[@]}" >&2
  exit 1
fi
