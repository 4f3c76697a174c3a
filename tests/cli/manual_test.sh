#!/usr/bin/env bash
# manual_test.sh PROGRAM: checks that the man page has every command, and that bash completes commands and
# options.
set -euo pipefail
program=$1
fail() { echo "manual_test.sh: $*" >&2; exit 1; }
page=$("$program" help --man)
source <("$program" completion bash)
for shell in zsh fish; do
    script=$("$program" completion $shell)  # not through a pipe that closes early, since the program would fail
    [[ $script == *limpid* ]] || fail "nothing for $shell"
done

# completes EXPECTED WORD ...: the last word is the one being typed.
completes() {
    COMP_WORDS=("${@:2}")
    COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
    _limpid
    [[ " ${COMPREPLY[*]} " == *" $1 "* ]] || fail "'${*:2}' is completed as '${COMPREPLY[*]}', without $1"
}
completes render limpid re
completes --help limpid render --he
commands=$("$program" --help | sed -n '/^Subcommands:/,$s/^  \([a-z]\+\) .*/\1/p')
[ -n "$commands" ] || fail "no commands in --help"
for command in $commands; do
    completes "$command" limpid "${command:0:2}"
    grep -q "^\.SH LIMPID ${command^^}$" <<<"$page" || fail "the man page has no '$command'"
done
