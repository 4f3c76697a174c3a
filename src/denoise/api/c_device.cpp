#include "denoise/api/c_device.h"

#include "denoise/api/c_guard.h"

namespace limpid::denoise {

MessageCallback callbackOf(limpid_message_callback message, void* user) {
    if (!message) return {};
    return [message, user](MessageLevel level, const std::string& text) {
        message(user, static_cast<limpid_message_level>(level), text.c_str());
    };
}

std::shared_ptr<gpu::Device> openDevice(const limpid_device_desc* desc) {
    const limpid_device_desc d = desc ? wholeStruct(desc, "limpid_device_desc") : limpid_device_desc{};
    gpu::DeviceOptions options;
    options.select = d.select ? d.select : "";
    options.validation = d.validation != 0;
    options.readsEnvironment = false;
    options.messages = callbackOf(d.message, d.message_user);
    return std::make_shared<gpu::Device>(options);
}

}  // namespace limpid::denoise
