#!/usr/bin/env bash
# Indent the Fortran files. With --check: change nothing, show what would change and fail if anything would.
set -euo pipefail
cd "$(dirname "$0")/.."

status=0
while IFS= read -r file; do
  .venv/bin/findent -ifree -i2 -c2 -k- --align_paren=0 <"$file" >"$file.formatted"
  if [ "${1-}" = --check ]; then
    diff --unified "$file" "$file.formatted" || status=1
    rm "$file.formatted"
  elif cmp --silent "$file" "$file.formatted"; then
    rm "$file.formatted"
  else
    echo "formatted $file"
    mv "$file.formatted" "$file"
  fi
done < <(find fortran tests -name '*.f90')
exit $status
