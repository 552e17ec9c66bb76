#!/usr/bin/env bash
# Formatters and linters in check mode, all of them even when one complains; fails if any did.
set -uo pipefail
cd "$(dirname "$0")/.."
export PATH="$PWD/.venv/bin:$PATH"

out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
names=() processes=()

# All are at work at the same time; what they say comes one after another.
check() {
  names+=("$1")
  "${@:2}" > "$out/$1" 2>&1 &
  processes+=($!)
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

# The package, then the cases: both keep what they know of a file in one place.
types() {
  local failed=0
  mypy || failed=1
  mypy verification || failed=1
  return $failed
}

check "compiler warnings" bash tools/build_debug.sh
check "types (mypy)" types
check "Python format (ruff format)" ruff format --quiet --check .
check "Python (ruff)" ruff check --quiet --output-format=concise .
check "layers of the package (import-linter)" layers
check "Fortran format (findent)" bash tools/format_fortran.sh --check
check "Fortran (fortitude)" fortitude check --quiet --output-format=concise

failed=()
for number in "${!names[@]}"; do
  printf '==> %s\n' "${names[number]}"
  wait "${processes[number]}" || failed+=("${names[number]}")
  cat "$out/${names[number]}"
done

if [ ${#failed[@]} -gt 0 ]; then
  printf 'failed: %s\n' "${failed[@]}" >&2
  exit 1
fi
