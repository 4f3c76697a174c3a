#!/bin/sh
# The sequences of docs/quality.md that are only reported: no default is chosen by them. Prints a table for each group.
#
#   bench/reported.sh LIMPID [SCENES] [OPTIONS OF `limpid bench quality`...]
#
# LIMPID is the program. SCENES is a folder of scenes from files; without it ("" or left out) only the built-in scenes
# are measured.
set -eu
limpid=$1
scenes=${2:-}
shift
[ $# -gt 0 ] && shift

measure() { "$limpid" bench quality --first 20 --frames 36 "$@"; }

measure --scene builtin:room-7 --camera-path dolly "$@"
measure --scene builtin:still-life-3 --camera-path orbit "$@"
if [ -z "$scenes" ]; then
    echo "reported.sh: NOT MEASURED: the sequences of scenes from files (no folder was given)" >&2
    exit 0
fi
measure --scene "$scenes/cornell_box_glb/CornellBox.glb" --camera-path dolly "$@"
# Night: only the lamp's own light.
measure --scene "$scenes/lights_punctual_lamp/LightsPunctualLamp.gltf" --camera-path orbit "$@"
# Alpha, and coloured glass.
measure --scene "$scenes/alpha_blend_mode_test/AlphaBlendModeTest.gltf" \
    --scene "$scenes/transmission_test/TransmissionTest.glb" --env "$scenes/env/vestibule_1k.hdr" \
    --camera-path orbit "$@"
# A skinned figure that walks.
measure --scene "$scenes/cesium_man/CesiumMan.gltf" --env "$scenes/env/vestibule_1k.hdr" --camera-path shake "$@"
