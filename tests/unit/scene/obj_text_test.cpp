// What the formats of .obj and .mtl allow and few files use.
#include "scene/obj/obj_text.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/files.h"
#include "image/png.h"
#include "scene/obj/load_obj.h"
#include "support/temporary_folder.h"

namespace lumi::test {
namespace {

std::string obj(std::string_view text, const std::string& there = {}) {
    return plainObj(text, [&](const std::string& name) { return name == there; });
}

TEST(ObjText, OrdinaryLinesStayAsTheyAre) {
    for (const char* text : {"", "\n", "v 0 0 0\nf 1 2 3\n", "# a \\ b\nmtllib a.mtl\n", "\n\nmtllib\tb.mtl\n"}) {
        std::string expected = text;
        std::replace(expected.begin(), expected.end(), '\t', ' ');
        EXPECT_EQ(obj(text), expected);
    }
    EXPECT_EQ(obj("v 0 0 0\r\nv 1 0 0"), "v 0 0 0\nv 1 0 0\n");
}

TEST(ObjText, ContinuedLinesAreWholeAndOthersKeepTheirNumber) {
    EXPECT_EQ(obj("f 1 2 \\\n3 4\nv 1 2 3\n"), "f 1 2  3 4\n\nv 1 2 3\n");
    EXPECT_EQ(obj("f 1\\\r\n2\\\r\n3\r\n"), "f 1 2 3\n\n\n");
    EXPECT_EQ(obj("f 1\\"), "f 1\\\n") << "nothing follows";
    EXPECT_EQ(obj(" # C:\\meshes\\\nv 1 2 3\n"), " # C:\\meshes\\\nv 1 2 3\n") << "comments end with their line";
    EXPECT_EQ(obj("v 0 0 0\rv 1 0 0\r"), "v 0 0 0\nv 1 0 0\n");
}

TEST(ObjText, AByteOrderMarkIsNoWord) { EXPECT_EQ(obj("\xef\xbb\xbfmtllib a.mtl\n"), "mtllib a.mtl\n"); }

TEST(ObjText, EachMaterialFileHasALine) {
    EXPECT_EQ(obj("mtllib a.mtl  b.mtl # both\n"), "mtllib a.mtl\rmtllib b.mtl\n");
    EXPECT_EQ(obj("mtllib my own.mtl \n", "my own.mtl"), "mtllib my\\ own.mtl\n");
    EXPECT_EQ(obj("mtllib my\\ own.mtl\n", "my own.mtl"), "mtllib my\\ own.mtl\n");
    EXPECT_EQ(obj("mtllib my\\ own.mtl b.mtl\n"), "mtllib my\\ own.mtl\rmtllib b.mtl\n");
    EXPECT_EQ(obj("mtllib a #1.mtl\n", "a #1.mtl"), "mtllib a\\ #1.mtl\n");
    EXPECT_EQ(obj("mtllib .\\sub\\a.mtl\n"), "mtllib ./sub/a.mtl\n");
    EXPECT_EQ(obj("mtllibrary a.mtl\n"), "mtllibrary a.mtl\n");
}

TEST(ObjText, MaterialsAreCompleted) {
    EXPECT_EQ(plainMtl("newmtl a\nKd 0.5\nKs .1 .2 .3\nKe 2 # bright\n"),
              "newmtl a\nKd 0.5 0.5 0.5\nKs .1 .2 .3\nKe 2 2 2\n");
    EXPECT_EQ(plainMtl("map_Kd -o 0.5 my  q.png\n"), "map_Kd -o 0.5 0 0 my  q.png\n");
    EXPECT_EQ(plainMtl("map_Kd -s 2 3 -clamp on -cc on -boost 2 q.png"), "map_Kd -s 2 3 1 -clamp on -boost 2 q.png\n");
    EXPECT_EQ(plainMtl("bump -bm 0.2 -t 1 n.png\n"), "bump -bm 0.2 -t 1 0 0 n.png\n");
    EXPECT_EQ(plainMtl("\xef\xbb\xbfnewmtl a\r\nmap_Kd a b.png\r\n"), "newmtl a\nmap_Kd a b.png\n");
}

TEST(ObjText, FilesThatUseAllOfItLoad) {
    TemporaryFolder folder;
    const Image8 white{{1, 1}, {255, 255, 255, 255}};
    writePng(folder / "q.png", white);
    writeFileAtomically(
        folder / "a b.mtl",
        std::string_view("\xef\xbb\xbfnewmtl first\nKd 0.25\nnewmtl shown\nmap_Kd -o 0.5 -cc on q.png\n"));
    writeFileAtomically(folder / "c.mtl", std::string_view("newmtl other\nKd 1 0 0\n"));
    writeFileAtomically(
        folder / "a.obj",
        std::string_view("\xef\xbb\xbfmtllib a b.mtl\nmtllib missing.mtl c.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                         "vt 0 0\nusemtl first\nf 1/1 \\\n2/1 3/1\nusemtl shown\nf 1/1 3/1 4/1\n"
                         "usemtl other\nf 2/1 3/1 4/1\n"));
    MessageLog log;
    const Scene scene = loadObj(folder / "a.obj", log);
    EXPECT_EQ(scene.triangleCount(), 3);
    const auto named = [&](const std::string& name) -> const Material& {
        return *std::find_if(scene.materials.begin(), scene.materials.end(),
                             [&](const Material& m) { return m.name == name; });
    };
    EXPECT_EQ(named("first").baseColor, Vec3(0.25f));
    EXPECT_EQ(named("other").baseColor, Vec3(1, 0, 0));
    ASSERT_TRUE(named("shown").baseColorTexture);
    EXPECT_EQ(named("shown").baseColorTexture.offset.x, 0.5f);
    ASSERT_EQ(log.warnings().size(), 1u);
    EXPECT_NE(log.warnings()[0].find("missing.mtl"), std::string::npos) << log.warnings()[0];
}

}  // namespace
}  // namespace lumi::test
