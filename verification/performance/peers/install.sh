#!/usr/bin/env bash
# Installs the programs that isomortar is compared with: GetFEM and CalculiX as Debian packages, the others with pip into .peers, an
# environment of their own. isomortar itself never needs them, and its set-up never installs them.
#
#     bash verification/performance/peers/install.sh
set -euo pipefail
cd "$(dirname "$0")/../../.."

packages=(python3-getfem calculix-ccx)
as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)

printf '==> Installing Debian packages%s: %s\n' "${as_root:+ with sudo}" "${packages[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends "${packages[@]}"

printf '==> Installing into .peers: nutils with MKL, NGSolve\n'
python3 -m venv .peers
.peers/bin/python -m pip install --quiet --upgrade pip
.peers/bin/python -m pip install --quiet 'nutils>=9' 'mkl<2026' 'ngsolve>=6.2'
