#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# From a fresh machine to a map: installs what is missing, builds, maps the log that ships with shapemap.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
  cat <<'HELP'
usage: scripts/demo.sh [--help]

Installs what is missing, builds the release preset and maps the demo log, the simulated rescue
arena of datasets/. The map and its trajectory go to results/demo/; what is there is replaced.
HELP
}

case "${1-}" in
  "") ;;
  --help | -h) usage && exit 0 ;;
  *) usage >&2 && exit 2 ;;
esac

scripts/install_deps.sh
cmake --preset release -DPython3_EXECUTABLE="$PWD/.venv/bin/python" >/dev/null
cmake --build --preset release --target shapemap-cli --parallel "$(nproc)"

results=results/demo
mkdir -p "$results"
started_ms=$(date +%s%3N)
status=0
build/release/bin/shapemap-cli --demo --out "$results/map.png" --trajectory "$results/trajectory.tum" \
  --report "$results/report.json" --draw-path --force || status=$?
# 4: the map is written, but not every position found its place.
if ((status != 0 && status != 4)); then exit "$status"; fi
elapsed_ms=$(($(date +%s%3N) - started_ms))

echo
echo "The map:        $PWD/$results/map.png"
echo "The trajectory: $PWD/$results/trajectory.tum"
printf 'Mapping took %d.%03d s.\n' $((elapsed_ms / 1000)) $((elapsed_ms % 1000))
exit "$status"
