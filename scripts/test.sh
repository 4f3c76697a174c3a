#!/usr/bin/env bash
# Installs what is missing, builds Release, runs all tests.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install.sh libembree-dev chromium ffmpeg openmpi-bin python3 python3-numpy python3-torch xvfb xauth xdotool
scripts/build.sh release -DLIMPID_TESTS=ON "$@"
[ -d ../shared/scenes ] || echo "NOTE: ../shared/scenes is absent: the tests on real scenes will be skipped."
# One more than there are cores: tests of the window and of servers mostly wait.
ctest --preset release --parallel "$(($(nproc) + 1))"
echo "== tests that were skipped, and why"
sed -n 's/.*\(NOT TESTED.*\|NOT VALIDATED.*\|SKIPPED: .*\)/\1/p' build/release/Testing/Temporary/LastTest.log | sort | uniq -c

echo "== the hardware tracer, on a software driver that has ray-tracing pipelines"
if icd=$(scripts/lavapipe25.sh); then
    LIMPID_TEST_CASES='*/hardware*:TracersTest*' VK_ICD_FILENAMES=$icd ctest --preset release --parallel "$(nproc)" -LE 'python|embed'
else
    echo "NOTE: NOT TESTED here: the hardware tracer."
fi
