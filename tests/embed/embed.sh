#!/usr/bin/env bash
# embed.sh TEST SOURCE BUILD LIBDIR: runs one test of the installed library. CTest runs these tests (label embed). The
# first one, "install", installs the libraries into BUILD/tests/embed/prefix; the others build programs against that.
# The environment has the CXX and CMAKE_GENERATOR of the build.
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
# refuses TEXT COMMAND ...: checks that the command fails and that its output contains TEXT.
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
# pictures FOLDER WIDTH HEIGHT NAME ...: checks that all files exist, have that size, and differ from each other.
pictures() {
    cd "$1"
    local size=$2x$3 name
    shift 3
    for name in "$@"; do
        [ "$(head -n 1 "$name")" = "P6 ${size/x/ } 255" ] || fail "$name is not a picture of $size"
    done
    [ "$(sha256sum "$@" | cut -d ' ' -f 1 | sort -u | wc -l)" -eq $# ] || fail "two of $* are the same"
}

# soname FILE NAME: checks the library's SONAME.
soname() { readelf -d "$prefix/$libdir/$1" | grep SONAME | grep -qF "[$2]" || fail "the SONAME is not $2"; }
installed() {
    local file
    for file in "$@"; do
        [ -e "$prefix/$file" ] || fail "$file is not installed"
    done
}
# abi LIBRARY PREFIX PROGRAM FILE: checks that LIBRARY exports only symbols PREFIX*, and that FILE lists these symbols
# and the output of PROGRAM.c.
abi() {
    nm -D --defined-only "$prefix/$libdir/$1.so" | awk '$2 != "A" {sub(/@.*/, "", $3); print $3}' |
        LC_ALL=C sort >"$own/symbols"
    ! grep -v "^$2" "$own/symbols" || fail "exported, and not of the interface"
    ${CC:-cc} -std=c99 $(pkg-config --cflags limpid) -o "$own/abi" "$source/tests/embed/$3.c"
    { cat "$own/symbols"; "$own/abi"; } >"$own/abi.txt"
    diff -u "$source/tests/embed/$4" "$own/abi.txt" || fail "the ABI has changed: lines may be added to
$4, where they follow what was there in their struct; anything else is another SONAME"
}

[ "$test" = install ] || [ -e "$prefix/$libdir/liblimpid.so" ] || fail "no library in $prefix: run embed_install"
rm -rf "$own"
mkdir -p "$own"
case $test in
    install)
        rm -rf "$prefix"
        cmake --install "$build" --prefix "$prefix" --component library
        cmake --install "$build" --prefix "$prefix" --component development
        soname liblimpid.so liblimpid.so.0
        installed include/limpid/denoise{.h,.hpp,_vulkan.h,_vulkan.hpp} "$libdir"/liblimpid.so.0 \
            "$libdir"/pkgconfig/limpid.pc "$libdir"/cmake/limpid/limpidConfig{,Version}.cmake
        for other in neural shot; do
            [ ! -e "$prefix/include/limpid/$other.h" ] || fail "$other.h is installed without its library"
        done
        ;;
    find_package)
        configure "$source/tests/embed/consumer" "$own"
        consumer
        refuses "no component 'other'; it has: denoise" \
            configure "$source/tests/embed/consumer" "$own/other" -D COMPONENT=other
        configure "$source/tests/embed/consumer" "$own/optional" -D COMPONENT=other -D OPTIONAL=ON
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
        # Debug compiles faster, the more without symbols, and is what no other test builds.
        configure "$source/tests/embed/consumer" "$own" -D SOURCE="$source" -D CMAKE_BUILD_TYPE=Debug \
            -D CMAKE_CXX_FLAGS_DEBUG= -D CMAKE_C_FLAGS_DEBUG=
        [ "$(cd "$own" && ctest -N | sed -n 's/^Total Tests: //p')" = 0 ] || fail "tests in somebody else's project"
        consumer
        ;;
    symbols)
        abi liblimpid limpid_ abi abi-0.2.txt
        ;;
    neural_install)
        for component in neural neural_development weights; do
            cmake --install "$build" --prefix "$prefix" --component $component
        done
        soname liblimpid-neural.so liblimpid-neural.so.0
        installed include/limpid/neural{.h,.hpp} "$libdir"/liblimpid-neural.so.0 "$libdir"/pkgconfig/limpid-neural.pc \
            share/limpid/kpcn{,-cis565}.safetensors
        ;;
    neural_find_package)
        configure "$source/tests/embed/consumer" "$own" -D COMPONENT=neural
        cmake --build "$own"
        "$own/network_wrapper"
        ;;
    neural_pkg_config)
        cp -a "$prefix" "$own/moved"
        export PKG_CONFIG_PATH=$own/moved/$libdir/pkgconfig
        ${CC:-cc} -std=c99 $(pkg-config --cflags limpid-neural) -o "$own/network" \
            "$source/tests/embed/consumer/network.c" $(pkg-config --libs limpid-neural)
        LD_LIBRARY_PATH=$own/moved/$libdir "$own/network"
        rm -r "$own/moved/share"
        refuses "kpcn.safetensors: the weights that come with Limpid are neither there" \
            env LD_LIBRARY_PATH="$own/moved/$libdir" "$own/network"
        ;;
    neural_symbols)
        abi liblimpid-neural limpid_network_ abi_neural abi-neural-0.2.txt
        ;;
    shot_install)
        for component in shot shot_development; do cmake --install "$build" --prefix "$prefix" --component $component; done
        soname liblimpid-shot.so liblimpid-shot.so.0
        installed include/limpid/shot{.h,.hpp} "$libdir"/liblimpid-shot.so.0 "$libdir"/pkgconfig/limpid-shot.pc
        ;;
    shot_find_package)
        configure "$source/tests/embed/consumer" "$own" -D COMPONENT=shot
        cmake --build "$own"
        "$own/shot_wrapper" "$source/tests/data/shots/camera.%04d.exr" "$own/clean.%04d.exr"
        ;;
    shot_pkg_config)
        ${CC:-cc} -std=c99 $(pkg-config --cflags limpid-shot) -o "$own/shot" "$source/tests/embed/consumer/shot.c" \
            $(pkg-config --libs limpid-shot)
        input=$source/tests/data/shots/objects.%04d.exr
        LD_LIBRARY_PATH=$prefix/$libdir "$own/shot" "$input" "$own/c.%04d.exr" | grep -F "layers of Cycles"
        "$build/limpid" denoise "$input" -o "$own/program.%04d.exr" --device cpu --bidirectional
        for frame in 0013 0014; do cmp "$own/c.$frame.exr" "$own/program.$frame.exr"; done
        ;;
    shot_symbols)
        abi liblimpid-shot limpid_shot_ abi_shot abi-shot-0.2.txt
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
