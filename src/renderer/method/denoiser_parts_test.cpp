#include "renderer/method/denoiser_parts.h"

#include <gtest/gtest.h>

#include "renderer/method/parameters.h"

namespace limpid {
namespace {

/// A part that is off changes parameters of groups that its denoiser reads; one that is missing changes none.
TEST(DenoiserParts, AreParametersOfTheirDenoiser) {
    for (const denoise::Denoiser& denoiser : denoise::denoisers()) {
        for (size_t part = 0; part < denoiserParts.size(); ++part) {
            RenderSettings settings;
            settings.pipeline = {Integrator::Path, &denoiser};
            DenoiserParts parts;
            EXPECT_EQ(withParts(settings, parts), settings);
            parts.on[part] = false;
            const RenderSettings without = withParts(settings, parts);
            EXPECT_EQ(without != settings, hasPart(&denoiser, part)) << denoiser.name << " " << part;
            for (const std::string& text : assignmentsOf(without)) {
                const std::string group = text.substr(0, text.find('.'));
                EXPECT_NE(std::ranges::find(denoiser.groups, group), denoiser.groups.end()) << text;
            }
        }
    }
    EXPECT_FALSE(hasPart(nullptr, 0));
}

}  // namespace
}  // namespace limpid
