#!/usr/bin/env bash
# build.sh PRESET[:TARGET] [CMAKE OPTION ...]: configures a preset of CMakePresets.json and builds it, or one target.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1%%:*}
target=${1#"$preset"}
shift
cmake --preset "$preset" "$@" >/dev/null
cmake --build --preset "$preset" ${target:+--target "${target#:}"}
