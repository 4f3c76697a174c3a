#include "base/log_receiver.h"

#include <gtest/gtest.h>

#include <thread>

#include "base/log.h"

namespace limpid::log {
namespace {

using Texts = std::vector<std::string>;

TEST(LogCollector, HasWhatItsThreadWrites) {
    write(Level::Warning, "before");
    const Collector outer;
    info("a camera was added");
    debug("nobody wants to know");
    {
        const Collector inner;
        warn("grey is used");
        EXPECT_EQ(inner.messages(), Texts{"grey is used"});
    }
    std::thread([] { warn("of another thread"); }).join();
    error("the end");
    EXPECT_EQ(outer.messages(), (Texts{"a camera was added", "grey is used", "the end"}));
}

}  // namespace
}  // namespace limpid::log
