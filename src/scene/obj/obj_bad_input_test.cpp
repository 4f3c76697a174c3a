// Tests malformed and abusive OBJ files (model/bad_input_test.cpp).
#include <cmath>

#include "scene/load/bad_input_test.h"

namespace limpid::scene::test {
namespace {

TEST_F(BadInput, Obj) {
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const auto expectObj = [&](const std::string& text, const std::string& fault) {
        SCOPED_TRACE(text.substr(0, 100));
        expectRefused(write("scene.obj", text), fault);
    };
    for (const char* index :
         {"4", "-4", "0", "99999999999999999999", "2147483648", "-2147483649", "nan", "1.5", "x", "/1"}) {
        expectObj(corners + "f 1 2 " + index + "\n", "line 4");
        expectObj(corners + "vt 0 0\nf 1/1 2/1 3/" + index + "\n", "line 5");
        expectObj(corners + "vn 0 0 1\nf 1//1 2//1 3//" + index + "\n", "line 5");
    }
    for (const char* number : {"nan", "inf", "-inf", "1e39", "1e999", "x", "1,5", ""}) {
        expectObj("v 0 0 0\nv 1 0 0\nv 0 1 " + std::string(number) + "\nf 1 2 3\n", "line 3");
    }
    expectObj("v 0 0 0\nv 1e20 0 0\nv 0 1e20 0\nf 1 2 3\n", "too large");
    expectObj(corners + "f 1 2\n", "fewer than three");
    expectObj(corners, "no triangles");
    expectObj("mtllib\n", "without a file name");
    expectObj(std::string(1000, '\0'), "NUL character");
    put(folder / "scene.mtl", "newmtl m\nKd 1 x 1\n");
    put(folder / "scene.obj", "mtllib scene.mtl\n" + corners + "usemtl m\nf 1 2 3\n");
    EXPECT_THROW(loadScene(folder / "scene.obj"), InputError);
}

TEST_F(BadInput, ObjThatIsNoText) {
    const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::string wide;
    for (const char c : text) wide += std::string(1, c) + '\0';
    expectRefused(write("a.obj", "\xff\xfe" + wide), "is UTF-16 text");
    expectRefused(write("a.obj", wide), "line 1: holds a NUL character");
    expectRefused(write("a.obj", text + std::string("# a\0b\n", 6)), "line 5: holds a NUL character");
    EXPECT_NO_THROW(loadScene(write("a.obj", "\xef\xbb\xbf" + text)))
        << "a byte order mark of UTF-8 is no fault";
}

TEST_F(BadInput, ObjAbuse) {
    std::string polygon = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
    for (int i = 0; i < 300'000; ++i) polygon += i % 3 == 0 ? " 1" : i % 3 == 1 ? " 2" : " 3";
    EXPECT_EQ(loadScene(write("scene.obj", polygon + "\n")).triangleCount(), 299'998u);
    std::string zigzag;  // star-shaped: the slow case of triangulation
    std::string face = "f";
    for (int i = 0; i < 256; ++i) {
        const float angle = static_cast<float>(i) * 2.0f * pi / 256.0f;
        const float radius = i % 2 ? 0.1f : 1.0f;
        zigzag += "v " + std::to_string(radius * std::cos(angle)) + " " +
                  std::to_string(radius * std::sin(angle)) + " 0\n";
        face += " " + std::to_string(i + 1);
    }
    for (int i = 0; i < 100; ++i) zigzag += face + "\n";
    EXPECT_EQ(loadScene(write("scene.obj", zigzag)).triangleCount(), 25'400u);
    std::string libraries = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int i = 0; i < 10'000; ++i) libraries += "mtllib scene.mtl\nusemtl none" + std::to_string(i) + "\n";
    put(folder / "scene.mtl", "newmtl a\n" + std::string(1'000'000, '#'));
    EXPECT_EQ(loadScene(write("scene.obj", libraries + "f 1 2 3\n")).triangleCount(), 1u);
}

}  // namespace
}  // namespace limpid::scene::test
