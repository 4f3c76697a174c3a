#!/usr/bin/env bash
# Renders scenes with Blender's Cycles and with Limpid, and prints how much they differ (docs/cycles.md).
# Installs Debian's Blender if it is missing. Options: scripts/cycles.sh --help.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install.sh blender python3-numpy
[ -x build/release/limpid ] || scripts/build.sh release -DLIMPID_TESTS=OFF
nice blender --background --factory-startup --python-exit-code 1 --python scripts/cycles/compare.py -- "$@"
