#!/bin/sh
# Every link of the documents to a file of this repository leads to one.
set -eu
cd "$(dirname "$0")/.."
broken=0
for page in $(git ls-files '*.md' 2>/dev/null || ls ./*.md docs/*.md); do
    # A path with a space in it would be two here: there are none.
    for link in $(grep -o '](\([^)#: ]*\)[)#]' "$page" | sed 's/^](//; s/[)#]$//'); do
        [ -e "$(dirname "$page")/$link" ] && continue
        echo "$page: no such file: $link" >&2
        broken=1
    done
done
exit $broken
