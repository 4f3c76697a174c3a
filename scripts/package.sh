#!/usr/bin/env bash
# package.sh [CMAKE OPTION ...]: builds the Debian packages limpid, liblimpid0, liblimpid-dev and python3-limpid into
# build/packages; for the network liblimpid-neural0, liblimpid-neural-dev and limpid-weights, too.
# With -DLIMPID_APPS=OFF only the library's two; with -DLIMPID_NEURAL=ON besides, the network's three.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install.sh dpkg-dev
cmake -S . -B build/package -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DLIMPID_TESTS=OFF "$@"
cmake --build build/package
# Packages of an earlier version must not lie beside the new ones.
rm -rf build/packages build/package/packages
(cd build/package && cpack)
mkdir -p build/packages
mv build/package/packages/*.deb build/packages/
ls build/packages
