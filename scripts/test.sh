#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# All tests, from a fresh machine: installs what is missing, builds, runs. Stops at the first failure.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
  cat <<'HELP'
usage: scripts/test.sh [--release-only | --asan-only] [--help]

Installs what is missing, then builds and tests the presets asan (AddressSanitizer and
UndefinedBehaviorSanitizer) and release, and runs the Python tests.

  --release-only  leave out the asan preset
  --asan-only     only the asan preset
  --help          this text

SHAPEMAP_DATASETS  folder with real logs; the tests that need them skip without it
SHAPEMAP_JOBS      parallel jobs, by default one per processor
HELP
}

presets=(asan release)
python_tests=yes
case "${1-}" in
  "") ;;
  --release-only) presets=(release) ;;
  --asan-only) presets=(asan) && python_tests=no ;;
  --help | -h) usage && exit 0 ;;
  *) usage >&2 && exit 2 ;;
esac
jobs=${SHAPEMAP_JOBS:-$(nproc)}

started_s=$SECONDS
step=setup
section() {
  step=$1
  printf '\n=== %s (after %d s)\n' "$1" $((SECONDS - started_s))
}
trap 'status=$?; if ((status != 0)); then echo "test.sh: failed in: $step" >&2; fi' EXIT

# Undefined behaviour and leaks are failures; the suppressions name what is not ours.
export ASAN_OPTIONS="detect_stack_use_after_return=1:strict_string_checks=1${ASAN_OPTIONS:+:$ASAN_OPTIONS}"
export UBSAN_OPTIONS="print_stacktrace=1${UBSAN_OPTIONS:+:$UBSAN_OPTIONS}"

section "dependencies"
scripts/install_deps.sh
if [[ -n ${SHAPEMAP_DATASETS-} ]]; then
  echo "real logs from $SHAPEMAP_DATASETS"
else
  echo "SHAPEMAP_DATASETS is not set: the tests on real logs skip"
fi

for preset in "${presets[@]}"; do
  section "build $preset"
  # Tests written in Python run in .venv as well.
  cmake --preset "$preset" -DPython3_EXECUTABLE="$PWD/.venv/bin/python" >/dev/null
  cmake --build --preset "$preset" --parallel "$jobs"
  section "test $preset"
  ctest --preset "$preset" --parallel "$jobs"
done

if [[ $python_tests == yes ]]; then
  section "Python tests"
  .venv/bin/python -m pytest --numprocesses "$jobs" tests/python
fi
section "all passed"
