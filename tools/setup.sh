#!/usr/bin/env bash
# Set up a working copy: system packages (Debian), the virtual environment .venv, the package itself (editable).
# Installs only what is missing, and says so before it does. Called by `make`, which repeats it only when needed.
# With --mumps the engine mumps is built in, for runs on several machines (docs/engines.md): MUMPS and MPI are installed, too.
set -euo pipefail
cd "$(dirname "$0")/.."

remembered=.venv/with-mumps # a later set-up of this copy does the same
case "${1-}" in
  "") ;;
  --mumps) mkdir -p .venv && touch "$remembered" ;;
  *)
    printf 'set-up stopped: it has no option %s; allowed: --mumps\n' "$1" >&2
    exit 2
    ;;
esac
engine_packages=() options=()
if [ -f "$remembered" ]; then
  engine_packages=(libmumps-dev libopenmpi-dev openmpi-bin)
  options=(-Csetup-args=-Dmumps=enabled)
fi

say() { printf '==> %s\n' "$*"; }
fail() { printf 'set-up stopped: %s\n' "$*" >&2; exit 1; }

# Does `python3 -c CODE` succeed?
python_can() { python3 -c "$1" 2>/dev/null; }
python_has_headers() { python_can 'import pathlib, sysconfig; raise SystemExit(not pathlib.Path(sysconfig.get_path("include"), "Python.h").exists())'; }
python_has_venv() { python_can 'import ensurepip, venv'; }

missing_packages() {
  local package
  for package in gcc gfortran libc6-dev libopenblas-dev libsuitesparse-dev "${engine_packages[@]}"; do
    [ "$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || echo "$package"
  done
  python_has_headers || echo python3-dev
  python_has_venv || echo python3-venv
}

ask_administrator() {
  fail "system packages are missing, and this account can not install them. Ask an administrator to run
    apt-get update && apt-get install $*
then repeat your command."
}

install_system_packages() {
  local packages as_root=()
  if ! command -v apt-get >/dev/null; then
    say "This is not Debian: taking the compilers gcc and gfortran, OpenBLAS, SuiteSparse and Python's headers${options:+, MUMPS and MPI} to be installed."
    return
  fi
  mapfile -t packages < <(missing_packages)
  [ ${#packages[@]} -gt 0 ] || return 0
  if [ "$(id -u)" -ne 0 ]; then
    # With nobody at the keyboard, sudo is of use only if it asks no password.
    command -v sudo >/dev/null && { [ -t 0 ] || sudo -n true 2>/dev/null; } || ask_administrator "${packages[@]}"
    as_root=(sudo)
  fi
  say "Installing system packages${as_root:+ with sudo}: ${packages[*]}"
  if [ ${#as_root[@]} -gt 0 ]; then sudo -v || ask_administrator "${packages[@]}"; fi
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends "${packages[@]}"
}

check_python() {
  python_can 'import sys; raise SystemExit(sys.version_info < (3, 11))' ||
    fail "Python 3.11 or later is needed; python3 is $(command -v python3 || echo missing), $(python3 --version 2>&1 || true)"
  python_has_headers || fail "$(command -v python3) has no header files (Python.h): put a python3 that has them first on PATH"
  python_has_venv || fail "$(command -v python3) can not make virtual environments: put a python3 that can first on PATH"
}

make_environment() {
  if ! .venv/bin/python -c '' 2>/dev/null; then
    say "Making the virtual environment .venv with $(python3 --version)"
    python3 -m venv --clear .venv
    [ ${#options[@]} -eq 0 ] || touch "$remembered"
  fi
  # The build runs meson and ninja of the environment, activated or not.
  export PATH="$PWD/.venv/bin:$PATH"
  say "Installing into .venv: the Python packages that pyproject.toml names (build, dev, dependencies), then isomortar (compiles the kernel)"
  python -m pip install --quiet --upgrade 'pip>=25.1'
  python -m pip install --quiet --group build --group dev
  rm -rf build/cp* # a build that is there would keep the options it was made with
  python -m pip install --quiet --no-build-isolation --editable . "${options[@]}"
  local packages
  packages=$(python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
  cp tools/working_copy.py "$packages/isomortar_working_copy.py"
  echo 'import isomortar_working_copy' > "$packages/isomortar-editable.pth" # in the place of meson-python's, which takes longer
  { echo "#!$PWD/.venv/bin/python" && cat tools/launch.py; } > .venv/bin/isomortar # in the place of pip's, which shows tracebacks
  .venv/bin/isomortar --version >/dev/null # what was built is known from here on, to accounts that may not write here, too
}

install_system_packages
check_python
make_environment
touch .venv/set-up
say "Set-up is complete."
