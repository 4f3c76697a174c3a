#!/usr/bin/env bash
# Installs the Debian packages that Limpid needs; asks apt only for missing ones. Runs as root or with sudo.
set -euo pipefail

packages=(
    build-essential cmake ninja-build pkg-config ca-certificates
    libvulkan-dev glslc spirv-tools libspirv-cross-c-shared-dev
    libglm-dev libfmt-dev libspdlog-dev libtbb-dev nlohmann-json3-dev libcli11-dev
    libopenexr-dev zlib1g-dev libstb-dev libpng-dev libturbojpeg0-dev libmeshoptimizer-dev libdraco-dev libdnnl-dev libglfw3-dev libimgui-dev
    libwebsockets-dev libvpx-dev libopenmpi-dev fonts-inter
    pybind11-dev python3-dev python3-numpy
    libgtest-dev libgmock-dev
    mesa-vulkan-drivers vulkan-validationlayers
    "$@"
)

missing=()
for package in "${packages[@]}"; do
    status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$status" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

root=()
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "install.sh: run as root, or install sudo; missing: ${missing[*]}" >&2; exit 1; }
    root=(sudo)
fi
echo "Installing: ${missing[*]}"
"${root[@]}" apt-get update -q
"${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"
