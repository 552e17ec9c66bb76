#!/usr/bin/env bash
# The kernel with run-time checks compiled in, every compiler warning an error, and the tests of its modules: build/debug.
set -euo pipefail
cd "$(dirname "$0")/.."
export PATH="$PWD/.venv/bin:$PATH"

if [ -f build/debug/build.ninja ]; then
  meson configure build/debug -Dkernel_tests=true
else
  meson setup build/debug --buildtype=debug -Dwerror=true -Dkernel_tests=true >/dev/null
fi
ninja --quiet -C build/debug
