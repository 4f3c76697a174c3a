#!/usr/bin/env bash
#SBATCH --job-name=limpid
#SBATCH --output=limpid.%A_%a.log
#SBATCH --requeue
# One task of a job array: runs a command of limpid with the task's share of the work (--shard I/N). {shard} in the
# arguments becomes I. docs/long-renders.md has examples.
#
#   sbatch --array=1-8 tools/slurm/shard.sh render scene.glb -o parts/{shard}.sums --spp 65536
#
# I and N come from Slurm, Grid Engine or LSF, whose array must be 1-N. LIMPID_SHARDS=N says how many parts there are:
# for PBS, which does not, and to run some tasks again. LIMPID is the program, if it is not in PATH.
set -euo pipefail

fail() {
    echo "shard.sh: $*" >&2
    exit 2
}

[ $# -gt 0 ] || fail "needs a command of limpid: render, denoise or dataset, and its options"
number=${SLURM_ARRAY_TASK_ID:-${PBS_ARRAY_INDEX:-${LSB_JOBINDEX:-${SGE_TASK_ID:-}}}}
case $number in
    '' | *[!0-9]*) fail "is for a task of a job array, such as sbatch --array=1-8" ;;
esac
shards=${LIMPID_SHARDS:-}
if [ -z "$shards" ]; then
    first=${SLURM_ARRAY_TASK_MIN:-${SGE_TASK_FIRST:-1}}
    last=${SLURM_ARRAY_TASK_MAX:-${LSB_JOBINDEX_END:-${SGE_TASK_LAST:-}}}
    count=${SLURM_ARRAY_TASK_COUNT:-$last}
    [ -n "$last" ] || fail "this scheduler does not say how many tasks there are: set LIMPID_SHARDS"
    [ "$first" = 1 ] && [ "$count" = "$last" ] && [ "${SGE_TASK_STEPSIZE:-1}" = 1 ] ||
        fail "the array is not 1-N: set LIMPID_SHARDS to the number of parts, to run some of them"
    shards=$last
fi
exec "${LIMPID:-limpid}" "${@//\{shard\}/$number}" --shard "$number/$shards"
