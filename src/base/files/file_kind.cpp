#include "base/files/file_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace limpid {
namespace {

using namespace std::string_view_literals;

struct Kind {
    std::string_view magic, name;
};

constexpr Kind kinds[] = {
    {"\x89PNG"sv, "a PNG picture"},
    {"\xff\xd8\xff"sv, "a JPEG picture"},
    {"\x76\x2f\x31\x01"sv, "an OpenEXR picture"},
    {"#?"sv, "a Radiance HDR picture"},
    {"II*\0"sv, "a TIFF picture"},
    {"MM\0*"sv, "a TIFF picture"},
    {"DDS "sv, "a DDS texture"},
    {"\xabKTX"sv, "a KTX texture"},
    {"RIFF"sv, "a WebP picture or another RIFF file"},
    {"glTF"sv, "a GLB scene"},
    {"Kaydara FBX"sv, "an FBX scene"},
    {"BLENDER"sv, "a Blender file"},
    {"PK\x03\x04"sv, "a ZIP archive"},
    {"\x1f\x8b"sv, "a gzip archive"},
    {"version https://git-lfs"sv, "a Git LFS pointer to a file that was not fetched"},
    {"\xff\xfe"sv, "UTF-16 text"},
    {"\xfe\xff"sv, "UTF-16 text"},
    {"<"sv, "an HTML or XML page"},
};

}  // namespace

std::string describeBeginning(std::span<const std::byte> bytes) {
    if (bytes.empty()) return "it is empty";
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()),
                                std::min<size_t>(bytes.size(), 64));
    std::string shown;
    for (const char c : text.substr(0, 4))
        shown += fmt::format("{}{:02x}", shown.empty() ? "" : " ", static_cast<uint8_t>(c));
    const auto* kind = std::ranges::find_if(kinds, [&](const Kind& k) { return text.starts_with(k.magic); });
    return fmt::format("it begins with {}{}", shown,
                       kind == std::end(kinds) ? "" : fmt::format(", as {} does", kind->name));
}

}  // namespace limpid
