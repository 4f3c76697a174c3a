#!/usr/bin/env bash
# Renders the thumbnails of the built-in scenes for the start page of `limpid view` (apps/viewer/thumbnails).
# Usage: scripts/render_thumbnails.sh LIMPID [NAME...]
set -euo pipefail

limpid=$1
shift
folder=$(cd "$(dirname "$0")/.." && pwd)/apps/viewer/thumbnails
mkdir -p "$folder"
names=("$@")
if [ ${#names[@]} -eq 0 ]; then
    # The rooms and still lifes that a number makes have no thumbnail.
    mapfile -t names < <("$limpid" view --help | grep -o 'builtin:[a-z0-9-]*' | sed 's/builtin://' | grep -v -- '-N$\|-$' | sort -u)
fi
for name in "${names[@]}"; do
    "$limpid" render "builtin:$name" --width 192 --height 108 --spp "${SPP:-256}" -o "$folder/$name.png"
done
