#include "scene/gltf/document/gltf_json.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "base/json_float.h"

namespace limpid::scene::gltf {
namespace {

constexpr int maxDepth = 256;
constexpr size_t maxJsonBytes = size_t{1} << 30;

/// Checked before parsing, since a document a million levels deep would exhaust the stack or memory.
bool nestsTooDeep(std::span<const std::byte> text) {
    int depth = 0;
    bool inString = false;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = static_cast<char>(text[i]);
        if (inString) {
            if (c == '\\') ++i;
            if (c == '"') inString = false;
        } else if (c == '"') {
            inString = true;
        } else if (c == '[' || c == '{') {
            if (++depth > maxDepth) return true;
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
    return false;
}

/// Returns the library's message without its tag ("[json.exception.parse_error.101] "), shortened to a line
/// or two.
std::string shortened(const char* message) {
    std::string text(message);
    if (const size_t tag = text.find("] "); text.starts_with("[json.") && tag != std::string::npos)
        text.erase(0, tag + 2);
    if (text.size() > 240) text = text.substr(0, 240) + "...";
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    }
    return text;
}

std::optional<uint64_t> asWhole(const Json& value) {
    constexpr uint64_t limit = uint64_t{1} << 53;
    if (value.is_number_unsigned()) {
        const auto number = value.get<uint64_t>();
        return number <= limit ? std::optional(number) : std::nullopt;
    }
    // Some exporters write 3.0 where glTF requires 3.
    if (!value.is_number_float()) return std::nullopt;
    const double number = value.get<double>();
    if (!(number >= 0.0 && number <= static_cast<double>(limit)) || number != std::floor(number))
        return std::nullopt;
    return static_cast<uint64_t>(number);
}

}  // namespace

Json parseJson(const std::filesystem::path& file, std::span<const std::byte> text, std::string_view kind) {
    if (text.size() > maxJsonBytes) throw InputError(file, "its JSON is too large");
    if (nestsTooDeep(text))
        throw InputError(file, fmt::format("its JSON nests more than {} levels deep", maxDepth));
    const auto* begin = reinterpret_cast<const char*>(text.data());
    try {
        Json json = Json::parse(begin, begin + text.size());
        if (!json.is_object())
            throw InputError(file,
                             fmt::format("is not {}: its JSON is {}, no object", kind, json.type_name()));
        return json;
    } catch (const Json::exception& error) {
        throw InputError(file, "is not valid JSON: " + shortened(error.what()));
    }
}

Object::Object(const std::filesystem::path& file, const Json& value, std::string place)
    : file_(&file), value_(&value), place_(std::move(place)) {
    if (!value.is_object()) fail("is not an object");
}

void Object::fail(const std::string& fault) const {
    throw InputError(*file_, (place_.empty() ? "the document" : place_) + ": " + fault);
}

void Object::fail(const char* key, const std::string& fault) const {
    throw InputError(*file_, (place_.empty() ? "" : place_ + ".") + key + ": " + fault);
}

const Json* Object::find(const char* key) const {
    const auto it = value_->find(key);
    return it == value_->end() ? nullptr : &*it;
}

const Json* Object::findArray(const char* key) const {
    const Json* value = find(key);
    if (value && !value->is_array()) fail(key, "is not a list");
    return value;
}

float Object::number(const char* key, float absent) const {
    const Json* value = find(key);
    if (!value) return absent;
    const auto number = finiteFloat(*value);
    if (!number) fail(key, "is not a finite number");
    return *number;
}

double Object::number(const char* key, double absent) const {
    const Json* value = find(key);
    if (!value) return absent;
    const double number = value->is_number() ? value->get<double>() : NAN;
    if (!std::isfinite(number)) fail(key, "is not a finite number");
    return number;
}

bool Object::boolean(const char* key, bool absent) const {
    const Json* value = find(key);
    if (!value) return absent;
    if (!value->is_boolean()) fail(key, "is neither true nor false");
    return value->get<bool>();
}

std::string Object::text(const char* key, const std::string& absent) const {
    const Json* value = find(key);
    if (!value) return absent;
    if (!value->is_string()) fail(key, "is not a text");
    return value->get<std::string>();
}

uint64_t Object::whole(const char* key) const {
    const Json* value = find(key);
    if (!value) fail(key, "is missing");
    const auto number = asWhole(*value);
    if (!number) fail(key, "is not a whole number of 0 to 2^53");
    return *number;
}

uint64_t Object::whole(const char* key, uint64_t absent) const {
    return has(key) ? whole(key) : absent;
}

int Object::index(const char* key, size_t size) const {
    if (!has(key)) return none;
    const uint64_t number = whole(key);
    if (number >= size) fail(key, fmt::format("is {}, but there are only {}", number, size));
    return static_cast<int>(number);
}

void Object::readNumbers(const char* key, std::span<float> values) const {
    const Json* list = findArray(key);
    if (!list) fail(key, "is missing");
    if (list->size() != values.size())
        fail(key, fmt::format("has {} numbers, not {}", list->size(), values.size()));
    for (size_t i = 0; i < values.size(); ++i) {
        const auto number = finiteFloat((*list)[i]);
        if (!number) fail(key, fmt::format("element {} is not a finite number", i));
        values[i] = *number;
    }
}

vec2 Object::vector(const char* key, const vec2& absent) const {
    if (!has(key)) return absent;
    std::array<float, 2> v{};
    readNumbers(key, v);
    return {v[0], v[1]};
}

vec3 Object::vector(const char* key, const vec3& absent) const {
    if (!has(key)) return absent;
    std::array<float, 3> v{};
    readNumbers(key, v);
    return {v[0], v[1], v[2]};
}

vec4 Object::vector(const char* key, const vec4& absent) const {
    if (!has(key)) return absent;
    std::array<float, 4> v{};
    readNumbers(key, v);
    return {v[0], v[1], v[2], v[3]};
}

mat4 Object::matrix(const char* key) const {
    std::array<float, 16> v{};
    readNumbers(key, v);
    return glm::make_mat4(v.data());
}

std::vector<float> Object::numbers(const char* key) const {
    const Json* list = findArray(key);
    std::vector<float> values(list ? list->size() : 0);
    if (list) readNumbers(key, values);
    return values;
}

std::vector<std::string> Object::texts(const char* key) const {
    std::vector<std::string> values;
    const Json* list = findArray(key);
    if (!list) return values;
    for (const Json& value : *list) {
        if (!value.is_string()) fail(key, "has an element that is not a text");
        values.push_back(value.get<std::string>());
    }
    return values;
}

std::vector<int> Object::indices(const char* key, size_t size) const {
    std::vector<int> values;
    const Json* list = findArray(key);
    if (!list) return values;
    values.reserve(list->size());
    for (const Json& value : *list) {
        const auto number = asWhole(value);
        if (!number) fail(key, "has an element that is not a whole number");
        if (*number >= size)
            fail(key, fmt::format("has the element {}, but there are only {}", *number, size));
        values.push_back(static_cast<int>(*number));
    }
    return values;
}

std::optional<Object> Object::object(const char* key) const {
    const Json* value = find(key);
    if (!value) return std::nullopt;
    return Object(*file_, *value, place_.empty() ? key : place_ + "." + key);
}

std::optional<Object> Object::extension(const char* name) const {
    const std::optional<Object> extensions = object("extensions");
    return extensions ? extensions->object(name) : std::nullopt;
}

std::vector<Object> Object::objects(const char* key) const {
    std::vector<Object> values;
    const Json* list = findArray(key);
    if (!list) return values;
    values.reserve(list->size());
    const std::string prefix = place_.empty() ? key : place_ + "." + key;
    for (const Json& value : *list)
        values.emplace_back(*file_, value, fmt::format("{}[{}]", prefix, values.size()));
    return values;
}

size_t Object::listSize(const char* key) const {
    const Json* list = findArray(key);
    return list ? list->size() : 0;
}

Object Object::objectAt(const char* key, size_t index) const {
    const Json* list = findArray(key);
    if (!list || index >= list->size()) fail(key, fmt::format("has no element {}", index));
    return Object(*file_, (*list)[index],
                  fmt::format("{}{}{}[{}]", place_, place_.empty() ? "" : ".", key, index));
}

std::vector<std::string> Object::keys() const {
    std::vector<std::string> names;
    for (const auto& [name, value] : value_->items()) names.push_back(name);
    return names;
}

}  // namespace limpid::scene::gltf
