#!/usr/bin/env bash
# Builds a wheel that needs nothing of the machine but its C library, into dist/, and tries it in an empty environment: the small scene of
# `isomortar doctor`, and with --gate the gate. The libraries of the solver (OpenBLAS, SuiteSparse, METIS, those of gfortran) go into it.
#
#     bash tools/build_wheel.sh [--gate]
set -euo pipefail
cd "$(dirname "$0")/.."
export PATH="$PWD/.venv/bin:$PATH"

say() { printf '==> %s\n' "$1"; }

say "Installing into .venv: what makes wheels"
python -m pip install --quiet --group release

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
say "Building"
mkdir -p dist "$folder/source"
git archive HEAD | tar -x -C "$folder/source"
python -m pip wheel --quiet --no-deps --no-build-isolation --wheel-dir "$folder/thin" "$folder/source"
auditwheel repair --wheel-dir "$folder/whole" "$folder"/thin/*.whl
cp "$folder"/whole/*.whl dist/

say "Trying it in an empty environment"
python -m venv "$folder/empty"
"$folder/empty/bin/python" -m pip install --quiet "$(echo "$folder"/whole/*.whl)${1:+[verify]}"
(cd "$folder" && empty/bin/isomortar doctor)
if [ "${1:-}" = --gate ]; then
  (cd "$folder/source" && "$folder/empty/bin/isomortar" verify)
fi
say "Done: dist/$(basename "$folder"/whole/*.whl)"
