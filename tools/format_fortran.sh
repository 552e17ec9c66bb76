#!/usr/bin/env bash
# Indent the Fortran files. With --check: change nothing, show what would change and fail if anything would.
set -euo pipefail
cd "$(dirname "$0")/.."

status=0
while IFS= read -r file; do
  formatted=$(.venv/bin/findent -ifree -i2 -c2 -k- --align_paren=0 <"$file")
  difference=$(diff --unified "$file" - <<<"$formatted") && continue
  if [ "${1-}" = --check ]; then
    printf '%s\n' "$difference"
    status=1
  else
    printf '%s\n' "$formatted" >"$file"
    echo "formatted $file"
  fi
done < <(find fortran tests -name '*.f90')
exit $status
