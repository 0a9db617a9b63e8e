#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what shapemap is built and tested with, where it is missing. Debian 12 names.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
  cat <<'HELP'
usage: scripts/install_deps.sh [--dev] [--help]

Installs the Debian packages that are missing (as root, or through sudo) and brings the Python
environment .venv up to scripts/requirements.txt. Says and does nothing when all is there.

  --dev    also the tools that check the code: clang, clang-format, clang-tidy, valgrind, shellcheck,
           and the Python tools of scripts/requirements-dev.txt
  --help   this text
HELP
}

packages=(
  build-essential cmake ninja-build ccache
  libmrpt-obs-dev libmrpt-maps-dev libmrpt-slam-dev
  mrpt-apps mrpt-common # for the tests: rawlog-edit, carmen2rawlog and sample logs
  libopencv-dev libcgal-dev libceres-dev libeigen3-dev libnanoflann-dev nlohmann-json3-dev zlib1g-dev
  libcli11-dev libgtest-dev libgmock-dev libbenchmark-dev
  python3 python3-venv ca-certificates # pip needs the certificates
)
dev_packages=(clang clang-format clang-tidy valgrind shellcheck git)
requirements=(scripts/requirements.txt)

for argument in "$@"; do
  case "$argument" in
    --dev)
      packages+=("${dev_packages[@]}")
      requirements+=(scripts/requirements-dev.txt)
      ;;
    --help | -h) usage && exit 0 ;;
    *) usage >&2 && exit 2 ;;
  esac
done

as_root() {
  if [[ $EUID -eq 0 ]]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    echo "install_deps.sh: needs root or sudo for: $*" >&2
    return 1
  fi
}

install_packages() {
  local installed missing
  installed=$(dpkg-query -W -f '${db:Status-Abbrev} ${Package}\n' | sed -n 's/^ii  *//p' | sort -u)
  missing=$(comm -23 <(printf '%s\n' "${packages[@]}" | sort -u) <(printf '%s\n' "$installed"))
  if [[ -z $missing ]]; then return; fi
  mapfile -t missing <<<"$missing"
  echo "Installing ${missing[*]}"
  as_root apt-get -qq update
  as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -y -o Dpkg::Use-Pty=0 \
    install --no-install-recommends "${missing[@]}" >/dev/null
}

# The stamp holds what the environment was made from, so that it is touched only when that changes.
update_venv() {
  local stamp=.venv/requirements.stamp wanted known=""
  wanted=$(python3 --version && sha256sum "${requirements[@]}")
  if [[ -f $stamp ]]; then known=$(<"$stamp"); fi
  # The larger environment of --dev also serves without it.
  if [[ -x .venv/bin/python && $known == "$wanted"* ]]; then return; fi
  echo "Preparing the Python environment .venv"
  python3 -m venv --clear .venv
  .venv/bin/python -m pip install --quiet --disable-pip-version-check "${requirements[@]/#/--requirement=}"
  printf '%s\n' "$wanted" >"$stamp"
}

if ! command -v apt-get >/dev/null; then
  echo "install_deps.sh: no apt-get here; install by other means: ${packages[*]}" >&2
  exit 1
fi
install_packages
update_venv
