// Typed, checked access to a glTF document's JSON: code built on this never assumes that a value has the
// right type.
//
// Specification: glTF 2.0, https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/math.h"
#include "scene/model/scene.h"

namespace limpid::scene::gltf {

using Json = nlohmann::json;

/// Parses the document's JSON. Throws InputError if it is not a JSON object ("is not a glTF document"), or
/// nests deeper than any glTF does.
Json parseJson(const std::filesystem::path& file, std::span<const std::byte> text,
               std::string_view kind = "a glTF document");

/// An object of the document. Each read function takes a key, and the value to return if the key is absent. A
/// value of the wrong type or range throws InputError with the file and the value's path ("nodes[3].scale").
/// The JSON must outlive the Object.
class Object {
  public:
    /// Throws InputError if `value` is not an object.
    Object(const std::filesystem::path& file, const Json& value, std::string place);

    const std::string& place() const { return place_; }
    bool has(const char* key) const { return find(key) != nullptr; }

    float number(const char* key, float absent) const;    ///< must be finite
    double number(const char* key, double absent) const;  ///< must be finite
    bool boolean(const char* key, bool absent) const;
    std::string text(const char* key, const std::string& absent = {}) const;
    /// Reads an integer from 0 to 2^53. The second form requires the key.
    uint64_t whole(const char* key, uint64_t absent) const;
    uint64_t whole(const char* key) const;
    /// Reads an index below `size`, the length of the list it refers to; `none` if absent.
    int index(const char* key, size_t size) const;

    vec2 vector(const char* key, const vec2& absent) const;
    vec3 vector(const char* key, const vec3& absent) const;
    vec4 vector(const char* key, const vec4& absent) const;
    mat4 matrix(const char* key) const;                 ///< 16 numbers, in column-major order
    std::vector<float> numbers(const char* key) const;  ///< empty if absent
    std::vector<std::string> texts(const char* key) const;
    std::vector<int> indices(const char* key, size_t size) const;

    std::optional<Object> object(const char* key) const;
    std::optional<Object> extension(const char* name) const;
    std::vector<Object> objects(const char* key) const;  ///< a list of objects; empty if absent
    /// The length of a list, 0 if absent, and one of its objects: for code that runs often, since objects()
    /// makes all of them.
    size_t listSize(const char* key) const;
    Object objectAt(const char* key, size_t index) const;
    std::vector<std::string> keys() const;

    /// Throws InputError: "file: place: fault".
    [[noreturn]] void fail(const std::string& fault) const;
    /// Like above, but about one of the object's values: "file: place.key: fault".
    [[noreturn]] void fail(const char* key, const std::string& fault) const;

  private:
    const Json* find(const char* key) const;
    const Json* findArray(const char* key) const;
    void readNumbers(const char* key, std::span<float> values) const;  ///< requires exactly values.size()
                                                                       ///< numbers

    const std::filesystem::path* file_;
    const Json* value_;
    std::string place_;
};

}  // namespace limpid::scene::gltf
