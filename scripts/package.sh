#!/usr/bin/env bash
# package.sh [CMAKE OPTION ...]: builds the Debian packages into build/packages: limpid, liblimpid0, liblimpid-dev and
# python3-limpid; for files of other renderers liblimpid-shot0 and liblimpid-shot-dev; for the network
# liblimpid-neural0, liblimpid-neural-dev and limpid-weights; for clusters limpid-mpi. With -DLIMPID_APPS=OFF it builds
# only liblimpid0 and liblimpid-dev; if -DLIMPID_NEURAL=ON is given, too, also the three packages of the network.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install.sh dpkg-dev
cmake -S . -B build/package -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DLIMPID_TESTS=OFF "$@"
cmake --build build/package
# Remove packages of earlier versions.
rm -rf build/packages build/package/packages
(cd build/package && cpack)
mkdir -p build/packages
mv build/package/packages/*.deb build/packages/
ls build/packages
