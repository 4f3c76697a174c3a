#!/usr/bin/env bash
# package_check.sh [CHROOT]: tests the packages in build/packages (made by scripts/package.sh) in a bare Debian 12:
# that they install and work as documented. Run it as root. CHROOT is a folder with a bare system; if it is empty or
# does not exist, debootstrap creates the system. Without CHROOT, a temporary folder is used and removed at the end.
# The variable MIRROR sets a mirror for debootstrap.
set -euo pipefail
cd "$(dirname "$0")/.."
[ "$(id -u)" -eq 0 ] || { echo "package_check.sh: run as root" >&2; exit 1; }
ls build/packages/*.deb >/dev/null || { echo "package_check.sh: run scripts/package.sh first" >&2; exit 1; }
# Use a separate mount namespace, so that nothing stays mounted.
[ -n "${LIMPID_PACKAGE_CHECK:-}" ] ||
    LIMPID_PACKAGE_CHECK=1 exec unshare --mount --propagation private bash "scripts/$(basename "$0")" "$@"

root=${1:-}
if [ -z "$root" ]; then
    root=$(mktemp -d /var/tmp/limpid-packages.XXXXXX)
    trap 'umount -R "$root/proc" "$root/dev" 2>/dev/null || true; rm -rf --one-file-system "$root"' EXIT
fi
if [ ! -e "$root/etc/debian_version" ]; then
    scripts/install.sh debootstrap
    debootstrap --variant=minbase bookworm "$root" ${MIRROR:+"$MIRROR"}
fi
mount -t proc proc "$root/proc"
mount --rbind /dev "$root/dev"

step() { echo "== $*"; }
inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 "$@"; }
get() { inside DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "$@"; }
fail() { echo "package_check.sh: $*" >&2; exit 1; }
# refused COMMAND ...: checks that the command fails.
refused() { if inside "$@"; then fail "should have failed: $*"; fi; }
# pictures FOLDER NAME ...: checks that all files are PPM pictures and differ from each other.
pictures() {
    local folder=$root/$1 name
    shift
    for name in "$@"; do [ "$(head -c 2 "$folder/$name")" = P6 ] || fail "$name is not a picture"; done
    [ "$(cd "$folder" && sha256sum "$@" | cut -d ' ' -f 1 | sort -u | wc -l)" -eq $# ] || fail "two of $* are the same"
}

step "the packages and what they depend on, nothing else"
rm -rf "$root/check"
mkdir "$root/check"
cp build/packages/*.deb "$root/check"
inside apt-get update -q
get $(cd build/packages && printf '/check/%s ' *.deb)
inside limpid --version
for file in bin/limpid lib/python3/dist-packages/limpid/__init__.py share/limpid/kpcn.safetensors \
    share/man/man1/limpid.1.gz share/bash-completion/completions/limpid share/zsh/site-functions/_limpid \
    share/fish/vendor_completions.d/limpid.fish; do
    inside dpkg -S "/usr/$file" >/dev/null || fail "/usr/$file is in no package"
done
for package in limpid liblimpid0 liblimpid-dev python3-limpid; do
    # A bare system may be configured not to unpack documentation, so check the package itself.
    list=$(dpkg-deb --contents build/packages/${package}_*.deb)
    for file in copyright changelog.gz changelog.Debian.gz; do
        grep -qF "./usr/share/doc/$package/$file" <<<"$list" || fail "$package has no $file"
    done
done
inside python3 -c 'import limpid; print(limpid.__version__, limpid.__doc__.splitlines()[0])'
step "without a driver: an error that says so"
refused limpid render builtin:cornell -o /check/none.png --width 16 --height 9 --spp 1

step "with lavapipe"
get mesa-vulkan-drivers
inside limpid info
inside limpid render builtin:cornell -o /check/cornell.png --width 64 --height 36 --spp 4 --device cpu
inside limpid render builtin:cornell-moving -o /check/noisy.%d.exr --width 64 --height 36 --frames 3 --spp 1 \
    --aov all --jitter off --device cpu
inside limpid denoise /check/noisy.%d.exr -o /check/clean.%d.png --denoiser svgf --device cpu
inside limpid denoise /check/noisy.%d.exr -o /check/nano.%d.png --denoiser nano --device cpu
inside limpid render builtin:cornell -o /check/kpcn.png --width 64 --height 36 --spp 8 --denoiser kpcn --device cpu
cp -r examples docs python/tests "$root/check"
inside python3 /check/examples/python/denoise_sequence.py cpu
mkdir -p "$root/check/python"
mv "$root/check/tests" "$root/check/python/tests"
inside PYTHONDONTWRITEBYTECODE=1 python3 /check/python/tests/test_docs.py

step "programs built against the packages"
get g++ cmake make pkg-config glslc vulkan-validationlayers
sync=VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
for example in c vulkan; do
    source=/check/examples/$example
    inside cmake -S "$source" -B "$source/build" -D CMAKE_BUILD_TYPE=Release
    inside cmake --build "$source/build"
    inside make -C "$source"
done
for folder in examples/c examples/c/build; do
    inside sh -c "cd /check/$folder && ./limpid-c cpu"
    pictures check/$folder noisy.ppm clean.ppm
done
# The example denoises 32 frames, with three in flight, and changes their size half-way.
for folder in examples/vulkan examples/vulkan/build; do
    inside $sync sh -c "cd /check/$folder && ./limpid-vulkan --validate && ./limpid-vulkan --validate --two"
    pictures check/$folder noisy.ppm clean.ppm clean2.ppm
done

step "what the library takes and needs"
inside dpkg-query -W -f='${Package} ${Version}: ${Installed-Size} KiB, needs ${Depends}\n' \
    liblimpid0 liblimpid-dev limpid python3-limpid
(cd build/packages && ls -l -- *.deb)
readelf -d "$(realpath "$root"/usr/lib/*/liblimpid.so.0)" | grep NEEDED
step "all well"
