#!/usr/bin/env bash
# clips.sh FOLDER: makes the documentation's animated pictures in FOLDER. They show one sample per pixel, SVGF and
# 4,096 samples side by side, 60 frames in 3 seconds. Needs a GPU, ffmpeg, the font DejaVu Sans Mono, and a Release
# build.
set -euo pipefail
limpid=$(cd "$(dirname "$0")/.." && pwd)/build/release/limpid
mkdir -p "$1"
cd "$1"

# label TEXT: prints the ffmpeg filter that draws TEXT into the lower left corner.
label() {
    echo "drawtext=font='DejaVu Sans Mono':text='$1':x=8:y=h-22:fontsize=14:fontcolor=white:box=1:boxcolor=black@0.5:boxborderw=4"
}

# clip NAME SCENE CAMERA_PATH: renders the three versions of a sequence and makes NAME.webp of them.
clip() {
    local frames=(--frames 60 --width 320 --height 180 --exposure 0 --camera-path "$3")
    "$limpid" render "$2" "${frames[@]}" --spp 1 --jitter off -o "$1.noisy.%04d.png"
    "$limpid" render "$2" "${frames[@]}" --denoiser svgf -o "$1.svgf.%04d.png"
    "$limpid" render "$2" "${frames[@]}" --spp 4096 --samples-per-launch 64 --jitter pixel -o "$1.reference.%04d.png"
    ffmpeg -y -v error -framerate 20 -i "$1.noisy.%04d.png" -framerate 20 -i "$1.svgf.%04d.png" \
        -framerate 20 -i "$1.reference.%04d.png" -loop 0 -c:v libwebp_anim -quality 70 -filter_complex \
        "[0]$(label '1 sample per pixel')[a];[1]$(label SVGF)[b];[2]$(label '4,096 samples')[c];[a][b][c]hstack=3" \
        "$1.webp"
}

clip moving-camera builtin:lab-disocclusion dolly
clip moving-object builtin:cornell-moving shake
