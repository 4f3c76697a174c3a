// Tests that the host memory for one picture, from its file to the device, stays below --max-image-memory:
// compares the peak of `limpid render` with a large picture and with one of a single pixel.
#include <stb/stb_image_write.h>

#include <algorithm>
#include <vector>

#include "tests/cli/cli_fixture.h"
#include "tests/cli/measured_run.h"

namespace limpid {
namespace {

constexpr uint64_t megabyte = uint64_t{1} << 20;
constexpr uint64_t bound = 64 * megabyte;
/// The difference between two equal renders, caused by drivers and allocators.
constexpr uint64_t noise = 16 * megabyte;

class ImageMemoryTest : public CliTest {
  protected:
    void SetUp() override {
#if defined(__SANITIZE_ADDRESS__)
        GTEST_SKIP() << "sanitizers keep what is freed";
#endif
        CliTest::SetUp();
        put("scene.obj",
            "mtllib scene.mtl\nusemtl m\nv -1 0 -1\nv 1 0 -1\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n"
            "f 1/1 2/2 3/3\n");
        put("scene.mtl", "newmtl m\nmap_Kd picture.png\n");
    }

    /// Writes a black picture with one component. Zeros compress well: 38 million pixels in 37 KB.
    void putPng(int size) const {
        const std::vector<uint8_t> pixels(static_cast<size_t>(size) * static_cast<size_t>(size));
        stbi_write_png(path("picture.png").c_str(), size, size, 1, pixels.data(), size);
    }

    /// Writes one colour, in runs of 127 for each component.
    void putHdr(uint32_t width, uint32_t height) const {
        std::string row{2, 2, static_cast<char>(width >> 8), static_cast<char>(width & 255)};
        for (const char value : {'\x80', '\x40', '\x20', '\x81'}) {
            for (uint32_t left = width; left > 0;) {
                const uint32_t count = std::min(left, 127u);
                row += {static_cast<char>(128 + count), value};
                left -= count;
            }
        }
        std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " +
                           std::to_string(width) + "\n";
        for (uint32_t y = 0; y < height; ++y) text += row;
        put("sky.hdr", text);
    }

    MeasuredRun render(const std::vector<std::string>& more) const {
        std::vector<std::string> words = {LIMPID_PROGRAM,
                                          "render",
                                          path("scene.obj"),
                                          "-o",
                                          path("out.png"),
                                          "--width",
                                          "8",
                                          "--height",
                                          "8",
                                          "--spp",
                                          "1",
                                          "--device",
                                          "cpu",
                                          "--max-image-memory",
                                          "64MB"};
        words.insert(words.end(), more.begin(), more.end());
        return runMeasured(words, path("log.txt"));
    }
};

TEST_F(ImageMemoryTest, ALargeTextureIsScaledDownAndStaysBelowTheBound) {
    putPng(1);
    const MeasuredRun small = render({});
    ASSERT_EQ(small.code, 0) << small.output;
    putPng(6144);  // at full size it takes 144 MB as RGBA alone, 553 MB with mip levels and the device's copy
    const MeasuredRun large = render({});
    ASSERT_EQ(large.code, 0) << large.output;
    EXPECT_NE(large.output.find("picture.png: scaled down from 6144x6144 to 2048x2048"), std::string::npos)
        << large.output;
    EXPECT_LT(large.peak, small.peak + bound + noise);
}

TEST_F(ImageMemoryTest, ALargeEnvironmentIsScaledDownAndStaysBelowTheBound) {
    putPng(1);
    putHdr(8, 4);
    const MeasuredRun small = render({"--env", path("sky.hdr")});
    ASSERT_EQ(small.code, 0) << small.output;
    putHdr(4096, 2048);  // at full size it takes 503 MB
    const MeasuredRun large = render({"--env", path("sky.hdr")});
    ASSERT_EQ(large.code, 0) << large.output;
    EXPECT_NE(large.output.find("sky.hdr: scaled down from 4096x2048 to 1365x682"), std::string::npos)
        << large.output;
    EXPECT_LT(large.peak, small.peak + bound + noise);
}

TEST_F(ImageMemoryTest, TheBoundHasAUnit) {
    putPng(1);
    EXPECT_EQ(render({"--max-image-memory", "x"}).code, 2);
    expect("render " + path("scene.obj") + " --max-image-memory 12parsecs -o " + path("a.png"), 2, "parsecs");
    expect("render " + path("scene.obj") + " --max-image-memory 1KB -o " + path("a.png"), 2,
           "max-image-memory");
}

}  // namespace
}  // namespace limpid
