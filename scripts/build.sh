#!/usr/bin/env bash
# build.sh PRESET [CMAKE OPTION ...]: configures and builds a preset of CMakePresets.json.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=$1
shift
cmake --preset "$preset" "$@" >/dev/null
cmake --build --preset "$preset"
