#include "studio/state/state_file.h"

#include "base/error.h"
#include "base/files/file.h"
#include "studio/state/state_json.h"

namespace limpid::studio {
namespace {

using nlohmann::json;

constexpr uint64_t maxBytes = uint64_t{64} << 20;  ///< a scene can have many lights
constexpr const char* versionKey = "limpid_state";
constexpr int version = 1;

json fileOf(const State& state) {
    json fields = toJson(state);
    fields[versionKey] = version;
    return fields;
}

}  // namespace

json readStateFile(const std::filesystem::path& file) {
    const std::vector<std::byte> bytes = readFile(file, maxBytes);
    const auto* const text = reinterpret_cast<const char*>(bytes.data());
    json fields = json::parse(text, text + bytes.size(), nullptr, false);
    if (!fields.is_object() || !fields.contains(versionKey))
        throw InputError(file, "is not a Limpid state file");
    if (fields.at(versionKey) != version) throw InputError(file, "the state is of another version of Limpid");
    fields.erase(versionKey);
    // The lights are those of a scene, which is not known here.
    json known = fields;
    known.erase("lights");
    try {
        State state;
        studio::apply(state, known);
    } catch (const UsageError& fault) {
        throw InputError(file, fault.what());
    }
    return fields;
}

void writeStateFile(const std::filesystem::path& file, const State& state) {
    writeTextAtomically(file, fileOf(state).dump(1) + "\n");
}

std::string stateText(const State& state) {
    json fields = fileOf(state);
    if (!state.lights.isChanged()) fields.erase("lights");
    return fields.dump();
}

}  // namespace limpid::studio
