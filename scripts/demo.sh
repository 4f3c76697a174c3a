#!/usr/bin/env bash
# Installs what is missing, builds the program (Release), and demonstrates the main uses of Limpid. Results are in out/:
# - moving sequences of one sample per pixel and frame, denoised, with references, PSNR and FLIP;
# - a frame of 32 samples per pixel, denoised by the networks for stills;
# - a still, noisy and converged, with samples, seconds and PSNR.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install.sh
# The program alone, with precompiled headers and several files at once: see cmake/LimpidTargets.cmake. Arguments are
# for CMake.
scripts/build.sh release:limpid -DLIMPID_TESTS=OFF -DLIMPID_PCH=ON -DLIMPID_UNITY=ON "$@"

mkdir -p out
build/release/limpid bench quality --scene builtin:cornell --scene builtin:cornell-moving --width 256 --height 144 \
    --frames 16 --first 14 --reference-spp 512 --denoiser temporal --denoiser svgf --denoiser nano --out out \
    --report out/quality.html | tee out/quality.txt
echo
build/release/limpid bench quality --scene builtin:cornell --width 240 --height 136 --first 0 --frames 1 --spp 32 \
    --reference-spp 768 --denoiser svgf --denoiser film --denoiser kpcn --out out/network | tee out/network.txt
echo
build/release/limpid bench convergence --scene builtin:cornell --width 240 --height 136 \
    --spp 1024 --out out | tee out/convergence.txt
echo
echo "Denoised: out/quality.*.png (noisy, temporal, SVGF, nano, reference, side by side, labelled); the table: out/quality.txt; a page to look around in: out/quality.html"
echo "One frame of 32 samples, and two networks: out/network/*.png (noisy, SVGF, film, KPCN, reference); the table: out/network.txt"
echo "Converged: out/*spp.png (tone-mapped) and out/*spp.exr (linear); the table: out/convergence.txt"
