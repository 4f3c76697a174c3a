#include "base/json_float.h"

#include <gtest/gtest.h>

namespace limpid {
namespace {

/// What finiteFloat() needs of nlohmann::json.
struct Value {
    bool number = true;
    double value = 0.0;

    bool is_number() const { return number; }
    template <typename T>
    T get() const {
        return static_cast<T>(value);
    }
};

std::optional<float> converted(double value) {
    return finiteFloat(Value{.value = value});
}

TEST(JsonFloat, NumbersAreFloatsInTheirRange) {
    constexpr float largest = std::numeric_limits<float>::max();
    EXPECT_EQ(converted(-1.5), -1.5f);
    EXPECT_EQ(converted(1e-300), 0.0f);
    for (const double number : {static_cast<double>(largest), 3.4028235e38, 3.4028235677973362e38}) {
        EXPECT_EQ(converted(number), largest) << number;
        EXPECT_EQ(converted(-number), -largest) << number;
    }
    for (const double number : {3.4028235677973366e38, 3.403e38, 1e39, 1e300,
                                std::numeric_limits<double>::infinity(), std::nan("")}) {
        EXPECT_FALSE(converted(number)) << number;
        EXPECT_FALSE(converted(-number)) << number;
    }
    EXPECT_FALSE(finiteFloat(Value{.number = false}));
}

}  // namespace
}  // namespace limpid
