#!/usr/bin/env bash
# Fetches Mesa's software Vulkan driver from Debian's backports (lavapipe 25, which has ray-tracing pipelines)
# and unpacks it below build/, without touching the system. Prints the file to set in VK_ICD_FILENAMES. Fails
# with a reason if that is not possible (no network, another distribution).
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$PWD/build/lavapipe25
icd=$folder/lvp_icd.json
if [ -s "$icd" ]; then
    echo "$icd"
    exit 0
fi

fail() { echo "lavapipe25.sh: $*" >&2; exit 1; }
. /etc/os-release
[ "${ID:-}" = debian ] && [ "${VERSION_CODENAME:-}" = bookworm ] || fail "only on Debian 12, this is ${PRETTY_NAME:-unknown}"
mirror=$(sed -nE 's/^(URIs:|deb(-src)?( \[.*\])?) *(https?:[^ ]*\/debian)\/?( .*)?$/\4/p' /etc/apt/sources.list \
    /etc/apt/sources.list.d/* 2>/dev/null | head -n 1 || true)
rm -rf "$folder"
mkdir -p "$folder"/apt/lists/partial "$folder"/apt/archives/partial "$folder"/root
echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] ${mirror:-http://deb.debian.org/debian} bookworm-backports main" \
    >"$folder/apt/sources.list"
options=(-o Dir::Etc::SourceList="$folder/apt/sources.list" -o Dir::Etc::SourceParts=/dev/null
    -o Dir::State::Lists="$folder/apt/lists" -o Dir::Cache="$folder/apt" -o APT::Sandbox::User=root
    -o Acquire::http::Timeout=30 -o Acquire::Retries=1)
{
    apt-get "${options[@]}" -q update
    (cd "$folder/apt" && apt-get "${options[@]}" -q download mesa-vulkan-drivers)
} >"$folder/log" 2>&1 || fail "bookworm-backports cannot be read: $(tail -n 1 "$folder/log")"
dpkg -x "$folder"/apt/mesa-vulkan-drivers_*.deb "$folder/root"
rm -rf "$folder/apt"

library=$(find "$folder/root" -name 'libvulkan_lvp.so' -print -quit)
[ -n "$library" ] || fail "the package has no libvulkan_lvp.so"
# Debian 12's own driver has installed the libraries that this one needs.
missing=$(ldd "$library" | sed -nE 's/^\s*(\S+) => not found.*/\1/p' | tr '\n' ' ')
[ -z "$missing" ] || fail "the driver lacks $missing"
printf '{"file_format_version": "1.0.0", "ICD": {"library_path": "%s", "api_version": "1.4.305"}}\n' "$library" >"$icd"
echo "$icd"
