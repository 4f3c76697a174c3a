#include <string_view>

#include "base/error.h"
#include "serve/session/protocol.h"
#include "studio/state/state_json.h"
#include "targets.h"

namespace limpid::fuzz {

bool serve(Bytes input) {
    const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
    limpid::serve::ClientMessage message;
    try {
        message = limpid::serve::parseMessage(text);
    } catch (const UsageError&) {
        return false;
    }
    const auto* const edit = std::get_if<limpid::serve::Edit>(&message.content);
    if (!edit) return true;
    studio::State state;
    try {
        studio::apply(state, edit->changes);
    } catch (const UsageError&) {
        return false;
    }
    // What was accepted must be what is told to all clients, and be accepted again.
    studio::apply(state, studio::toJson(state));
    return true;
}

}  // namespace limpid::fuzz
