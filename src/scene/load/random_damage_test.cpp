// Tests scene files with random damage: each is rejected properly, or can be prepared (bad_input_test.cpp).
#include <random>

#include "scene/load/bad_input_test.h"

namespace limpid::scene::test {
namespace {

/// Flips bits, and sometimes deletes or repeats a range of bytes.
std::string damaged(std::string content, std::mt19937& random) {
    const auto below = [&](size_t n) { return std::uniform_int_distribution<size_t>(0, n - 1)(random); };
    const size_t changes = 1 + below(4);
    for (size_t i = 0; i < changes && !content.empty(); ++i) {
        const size_t at = below(content.size());
        const size_t length = 1 + below(std::min<size_t>(32, content.size() - at));
        switch (below(6)) {
            case 0:
                content.erase(at, length);
                break;
            case 1:
                content.insert(at, content.substr(at, length));
                break;
            default:
                content[at] = static_cast<char>(content[at] ^ (1 << below(8)));
        }
    }
    return content;
}

TEST_F(BadInput, RandomBitFlips) {
    GltfFile file = richFile(folder);
    const std::string glb = file.glb();
    const std::string gltf = get(file.save(folder));
    const std::string bin = get(folder / "scene.bin");
    for (unsigned seed = 0; seed < 700; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        expectLoadsOrIsRefused(write("scene.glb", damaged(glb, random)));
        expectLoadsOrIsRefused(write("scene.gltf", damaged(gltf, random)));
        put(folder / "scene.gltf", gltf);
        expectLoadsOrIsRefused((write("scene.bin", damaged(bin, random)), folder / "scene.gltf"));
        put(folder / "scene.bin", bin);
    }
    EXPECT_GT(loaded, 100);
    EXPECT_GT(refused, 100);
}

TEST_F(BadInput, RandomValues) {
    const std::vector<json> values = {
        parse("-1"),   parse("0"),    parse("1"),        parse("2"),          parse("5121"),
        parse("5126"), parse("1e30"), parse("1e-40"),    parse("4294967295"), parse("1099511627776"),
        parse("null"), parse("true"), parse("\"VEC4\""), parse("[]"),         parse("{}"),
        parse("[0]"),  parse("0.5"),  parse("-1e300")};
    GltfFile file = richFile(folder);
    file.save(folder);
    const json flat = file.document.flatten();
    for (unsigned seed = 0; seed < 2000; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        const auto below = [&](size_t n) { return std::uniform_int_distribution<size_t>(0, n - 1)(random); };
        json changed = file.document;
        for (size_t i = 0, n = 1 + below(3); i < n; ++i) {
            const auto leaf = std::next(flat.begin(), static_cast<std::ptrdiff_t>(below(flat.size())));
            json::json_pointer place(leaf.key());
            // Sometimes change the container instead of the leaf.
            if (below(4) == 0) place = place.parent_pointer();
            if (changed.contains(place)) changed[place] = values[below(values.size())];
        }
        expectLoadsOrIsRefused(write("scene.gltf", changed.dump()));
    }
    EXPECT_GT(loaded, 100);
    EXPECT_GT(refused, 100);
}

TEST_F(BadInput, RandomObj) {
    const std::string obj =
        "mtllib scene.mtl\no a\nv 0 0 0\nv 1 0 0\nv 1 1 0 1 0 0\nv 0 1 0\nvt 0 1\nvn 0 0 1\nusemtl m\nf "
        "1/1/1 2/1/1 3/1/1 "
        "4/1/1\ng b\nusemtl n\nf -1 -2 -3\nf 1//1 2//1 3//1\n";
    const std::string mtl =
        "newmtl m\nKd 1 0.5 0\nKs 1 1 1\nNs 10\nillum 7\nmap_Kd -s 1 1 1 -o 0 0 -clamp on a.png\nnewmtl "
        "n\nKe 1 1 1\nd 0.5\n";
    image::writePng(folder / "a.png", {1, 1, 3, {1, 2, 3}});
    for (unsigned seed = 0; seed < 1000; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        put(folder / "scene.mtl", seed % 2 ? damaged(mtl, random) : mtl);
        expectLoadsOrIsRefused(write("scene.obj", seed % 2 ? obj : damaged(obj, random)));
    }
    EXPECT_GT(loaded, 100);
    EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace limpid::scene::test
