#!/usr/bin/env bash
# embed.sh TEST SOURCE BUILD LIBDIR: one test of Limpid as other programs meet it. CTest runs them (label embed),
# "install" first: it installs the library into BUILD/tests/embed/prefix, and the others build programs against that.
# CXX and CMAKE_GENERATOR are those of the build.
set -euo pipefail
test=$1 source=$2 build=$3 libdir=$4
work=$build/tests/embed
prefix=$work/prefix
own=$work/$test
export PKG_CONFIG_PATH=$prefix/$libdir/pkgconfig CMAKE_PREFIX_PATH=$prefix
[ "${LIMPID_TEST_DEVICE:-cpu}" != cpu ] || export VK_LOADER_DRIVERS_SELECT='*lvp*'

fail() { echo "embed.sh $test: $*" >&2; exit 1; }
# configure FOLDER BUILD OPTION ...
configure() { cmake -S "$1" -B "$2" -D CMAKE_BUILD_TYPE=Release "${@:3}"; }
# refuses TEXT COMMAND ...: the command fails, and says TEXT.
refuses() {
    local said
    if said=$("${@:2}" 2>&1); then fail "not refused: ${*:2}"; fi
    tr -s ' \n' ' ' <<<"$said" | grep -qF "$1" || fail "'$1' is not in: $said"
}
consumer() {
    cmake --build "$own"
    "$own/version"
    "$own/wrapper"
}
# pictures FOLDER WIDTH HEIGHT NAME ...: each is there and of that size, and no two are the same.
pictures() {
    cd "$1"
    local size=$2x$3 name
    shift 3
    for name in "$@"; do
        [ "$(head -n 1 "$name")" = "P6 ${size/x/ } 255" ] || fail "$name is not a picture of $size"
    done
    [ "$(sha256sum "$@" | cut -d ' ' -f 1 | sort -u | wc -l)" -eq $# ] || fail "two of $* are the same"
}

[ "$test" = install ] || [ -e "$prefix/$libdir/liblimpid.so" ] || fail "no library in $prefix: run embed_install"
rm -rf "$own"
mkdir -p "$own"
case $test in
    install)
        rm -rf "$prefix"
        cmake --install "$build" --prefix "$prefix" --component library
        cmake --install "$build" --prefix "$prefix" --component development
        readelf -d "$prefix/$libdir/liblimpid.so" | grep SONAME | grep -qF '[liblimpid.so.0]' ||
            fail "the SONAME is not liblimpid.so.0"
        for file in include/limpid/denoise{.h,.hpp,_vulkan.h,_vulkan.hpp} "$libdir"/liblimpid.so.0 \
            "$libdir"/pkgconfig/limpid.pc "$libdir"/cmake/limpid/limpidConfig{,Version}.cmake; do
            [ -e "$prefix/$file" ] || fail "$file is not installed"
        done
        ;;
    find_package)
        configure "$source/tests/embed/consumer" "$own"
        consumer
        refuses "no component 'neural'; it has: denoise" \
            configure "$source/tests/embed/consumer" "$own/neural" -D COMPONENT=neural
        configure "$source/tests/embed/consumer" "$own/optional" -D COMPONENT=neural -D OPTIONAL=ON
        ;;
    pkg_config)
        cp -a "$prefix" "$own/moved"
        export PKG_CONFIG_PATH=$own/moved/$libdir/pkgconfig
        version=$(sed -n 's/^project(limpid VERSION \([0-9.]*\).*/\1/p' "$source/CMakeLists.txt")
        [ "$(pkg-config --modversion limpid)" = "$version" ] || fail "another version than the project's, $version"
        ${CC:-cc} -std=c99 $(pkg-config --cflags limpid) -o "$own/version" "$source/tests/embed/consumer/version.c" \
            $(pkg-config --libs limpid)
        LD_LIBRARY_PATH=$own/moved/$libdir "$own/version"
        ;;
    fetch_content)
        configure "$source/tests/embed/consumer" "$own" -D SOURCE="$source"
        [ "$(cd "$own" && ctest -N | sed -n 's/^Total Tests: //p')" = 0 ] || fail "tests in somebody else's project"
        consumer
        ;;
    symbols)
        nm -D --defined-only "$prefix/$libdir/liblimpid.so" | awk '$2 != "A" {sub(/@.*/, "", $3); print $3}' |
            LC_ALL=C sort >"$own/symbols"
        ! grep -v '^limpid_' "$own/symbols" || fail "exported, and not of the interface"
        ${CC:-cc} -std=c99 $(pkg-config --cflags limpid) -o "$own/abi" "$source/tests/embed/abi.c"
        { cat "$own/symbols"; "$own/abi"; } >"$own/abi.txt"
        diff -u "$source/tests/embed/abi-0.2.txt" "$own/abi.txt" || fail "the ABI has changed: lines may be added to
abi-0.2.txt, where they follow what was there in their struct; anything else is another SONAME"
        ;;
    example_c)
        configure "$source/examples/c" "$own"
        cmake --build "$own"
        (cd "$own" && ./limpid-c cpu)
        pictures "$own" 320 180 noisy.ppm clean.ppm
        ;;
    example_vulkan)
        configure "$source/examples/vulkan" "$own"
        cmake --build "$own"
        export VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
        (cd "$own" && ./limpid-vulkan --validate --two)
        pictures "$own" 500 300 noisy.ppm clean.ppm clean2.ppm
        ;;
    example_makefiles)
        export LIBRARY_PATH=$prefix/$libdir LD_LIBRARY_PATH=$prefix/$libdir
        cp -r "$source/examples/c" "$source/examples/vulkan" "$own"
        make -C "$own/c"
        (cd "$own/c" && ./limpid-c cpu)
        make -C "$own/vulkan" CXXFLAGS=-O0
        (cd "$own/vulkan" && ./limpid-vulkan)
        ;;
    *) fail "there is no such test" ;;
esac
