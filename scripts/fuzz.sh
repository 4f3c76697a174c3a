#!/usr/bin/env bash
# fuzz.sh TARGET SECONDS [LIBFUZZER OPTION ...]: builds and runs one fuzzer: gltf, obj, hdr, exr, png,
# checkpoint or serve.
# fuzz.sh TARGET merge: reduces the inputs that earlier runs found to those that add coverage. See docs/fuzzing.md.
set -euo pipefail
cd "$(dirname "$0")/.."
[ $# -ge 2 ] || { sed -n '2,4s/^# //p' "$0" >&2; exit 2; }
target=$1
seconds=$2
shift 2
seeds=tests/fuzz/corpus/$target
found=build/fuzz/corpus-$target
[ -d "$seeds" ] || { echo "fuzz.sh: there is no target '$target'" >&2; exit 2; }
scripts/install.sh clang libclang-rt-14-dev

cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --target "fuzz_$target"
mkdir -p "$found" "build/fuzz/findings-$target"
options=(-rss_limit_mb=2048 -max_len=8192 "-artifact_prefix=build/fuzz/findings-$target/")

if [ "$seconds" = merge ]; then
    mkdir "$found.merged"
    nice -n 19 "build/fuzz/fuzz_$target" -merge=1 "${options[@]}" "$@" "$found.merged" "$seeds" "$found"
    rm -r "$found"
    mv "$found.merged" "$found"
    exit
fi
# The relevant time limit is processor time (fuzz_main.cpp); the wall-clock limit only catches endless
# waiting.
exec nice -n 19 "build/fuzz/fuzz_$target" "-max_total_time=$seconds" -timeout=1200 "-dict=tests/fuzz/$target.dict" \
    -print_final_stats=1 "${options[@]}" "$@" "$found" "$seeds"
