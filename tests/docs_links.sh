#!/bin/sh
# Every link of the documents to a file of this repository leads to one, and every anchor to a heading.
set -eu
cd "$(dirname "$0")/.."
broken=0

# has_heading PAGE ANCHOR: GitHub names headings like this. One that occurs again gets -1, -2 and so on.
has_heading() {
    awk -v anchor="$2" '/^#+ / {
        name = tolower($0)
        sub(/^#+ +/, "", name)
        gsub(/[^a-z0-9 _-]/, "", name)
        gsub(/ /, "-", name)
        count = seen[name]++
        if ((count ? name "-" count : name) == anchor) found = 1
    }
    END { exit !found }' "$1"
}

for page in $(git ls-files '*.md' 2>/dev/null || ls ./*.md docs/*.md); do
    folder=$(dirname "$page")
    # A path with a space in it would be two here: there are none.
    for link in $(grep -o ']([^): ]*)' "$page" | sed 's/^](//; s/)$//'); do
        file=${link%%#*}
        target=$folder/$file
        [ -n "$file" ] || target=$page
        if [ ! -e "$target" ]; then
            echo "$page: no such file: $link" >&2
            broken=1
        elif [ "$link" != "$file" ] && [ "${target%.md}" != "$target" ] && ! has_heading "$target" "${link#*#}"; then
            echo "$page: no such heading: $link" >&2
            broken=1
        fi
    done
done
exit $broken
