// What a corner of a face may refer to, and the ways in which programs write it.
#include <gtest/gtest.h>

#include "base/files.h"
#include "scene/obj/load_obj.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lumi {
namespace {

const std::string kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

Scene loadText(const std::string& obj, MessageLog& log) {
    test::TemporaryFolder folder;
    writeFileAtomically(folder / "a.obj", std::string_view(obj));
    return loadObj(folder / "a.obj", log);
}

/// Of three vertices and these lines; nothing is warned of.
Scene loadFaces(const std::string& lines) {
    SCOPED_TRACE(lines);
    MessageLog log;
    Scene scene = loadText(kThree + lines, log);
    EXPECT_TRUE(log.warnings().empty()) << log.warnings().front();
    return scene;
}

void expectRefused(const std::string& lines, const std::initializer_list<std::string>& parts) {
    MessageLog log;
    test::expectError(
        ErrorKind::BadInput, [&] { loadText(kThree + lines, log); }, parts);
}

TEST(ObjFaces, CommentsBehindThemAreNone) {
    for (const char* face : {"f 1 2 3 # 9 9 9", "f 1 2 3 #9", "f 1 2 3# 9 9", "f 1 2 3 # a \\", "f 1 2 \\\n3 # b \\"})
        EXPECT_EQ(loadFaces(std::string(face) + "\nf 3 2 1\n").triangleCount(), 2);
    EXPECT_EQ(loadFaces("v 5 5 5 # 1\nvt 0 0 # 0\nvn 0 0 1#\nf 1/1/1 2/1/1 4/1/1 # 3\n").triangleCount(), 1);
    expectRefused("# one\nf 1 2 3 # 9\nf 1 2 9 # 1\n", {"a.obj:6: ", "found 9"});
    MessageLog log;
    EXPECT_EQ(loadText(kThree + "f 1 2 3\nl 1 2 # 0\np 1 # 0 0\nl # 1\n", log).triangleCount(), 1);
    EXPECT_EQ(log.warnings(), std::vector<std::string>{"a.obj: lines and points are not drawn"});
}

TEST(ObjFaces, NamesMayHoldWhatBeginsComments) {
    test::TemporaryFolder folder;
    writeFileAtomically(folder / "f#1.mtl", std::string_view("newmtl a#b\nKd 1 0 0\nnewmtl c\nKd 0 1 0\n"));
    writeFileAtomically(folder / "a.obj", "mtllib f#1.mtl\n" + kThree + "o one#two\nusemtl a#b\nf 1 2 3\n");
    MessageLog log;
    const Scene scene = loadObj(folder / "a.obj", log);
    EXPECT_TRUE(log.warnings().empty());
    EXPECT_EQ(scene.instances.at(0).name, "one#two");
    EXPECT_EQ(scene.materials[scene.instances[0].mesh->material].baseColor, Vec3(1, 0, 0));
}

TEST(ObjFaces, WordsAreNamedAsTheyWereWritten) {
    expectRefused("f 0x1/0/123456 2 3\n", {"a.obj:4: ", "without a vertex"});
    expectRefused("f 1//7 2/0/123456 3//7\n", {"a.obj:4: ", "a normal", "found 123456"});
    expectRefused("f 1/-9/123456 2 3\n", {"a.obj:4: ", "a normal", "found 123456"});
}

TEST(ObjFaces, LinesWithoutNumbersAreNoCoordinates) {
    MessageLog log;
    EXPECT_EQ(loadText(kThree + "vt\nvn\nvt 1 1\nvn 0 0 1\nf -3/-2/-2 -2/-1/-1 -1/-1/-1\n", log).triangleCount(), 1);
    ASSERT_EQ(log.warnings().size(), 2u);
    EXPECT_NE(log.warnings()[0].find("a.obj:8: a face refers to a texture coordinate that does not"),
              std::string::npos);
    EXPECT_NE(log.warnings()[1].find("a.obj:8: a face refers to a normal that does not"), std::string::npos);
    expectRefused("vt\nvt 1 1\nf 1/2 2/2 3/2\n", {"a.obj:6: ", "expected 1 to 1, found 2"});
}

TEST(ObjFaces, NumbersMayHaveAPlus) {
    EXPECT_EQ(loadFaces("vt 0 0\nvn 0 0 1\nf +1/+1/+1 +2/+1/+1 +3/+1/+1\n").triangleCount(), 1);
    expectRefused("f 1 2 +-1\n", {"a.obj:4: ", "without a vertex", "found +-1"});
    expectRefused("f 1 2 +7\n", {"a.obj:4: ", "expected 1 to 3, found +7"});
}

TEST(ObjFaces, EmptyPartsAreNone) {
    for (const char* face : {"f 1// 2// 3//", "f 1/ 2/ 3/", "l 1/ 2/ 3//\nf 1 2 3"}) {
        MessageLog log;
        const Scene scene = loadText(kThree + "vt 0 0\nvn 0 0 1\n" + face + "\n", log);
        EXPECT_TRUE(scene.instances.at(0).mesh->uv[0].empty()) << face;
        EXPECT_TRUE(scene.instances[0].mesh->normals.empty()) << face;
    }
    const Scene textured = loadFaces("vt .25 .5\nf 1/1/ 2/1/ 3/1/\n");
    EXPECT_EQ(textured.instances.at(0).mesh->uv[0].at(2), Vec2(0.25f, 0.5f));
    expectRefused("f 1 2 /1\n", {"a.obj:4: a face has a corner without a vertex", "found /1"});
    expectRefused("f 1 2 3\nl 0 1\n", {"a.obj:5: a line or a point has a corner without a vertex", "found 0"});
    expectRefused("vt 0 0\nvn 0 0 1\nf 1/1/1/1 2/1/1 3/1/1\n", {"a.obj:6: ", "more than three numbers", "1/1/1/1"});
}

TEST(ObjFaces, CoordinatesAndNormalsBeforeTheFirstAreLeftOut) {
    for (const auto& [faces, warning] :
         {std::pair("f 1/-1 2/-1 3/-1\nvt 0 0\n",
                    "a.obj:4: a face refers to a texture coordinate that does not exist; "
                    "it is left out"),
          {"vt 0 0\n\nf 1/-1 2/-2 3/-9\nf 1/-9 2/-9 3/-9\n",
           "a.obj:6: a face refers to a texture coordinate that does "
           "not exist; it is left out, as on 1 more lines"},
          {"f 1/0/0 2/0/0 3/0/0\n", "a.obj:4: a face refers to a normal that does not exist; it is left out"},
          {"f 1//-1 2//-1 3//-1\nvn 0 0 1\n", "a.obj:4: a face refers to a normal"}}) {
        MessageLog log;
        EXPECT_GE(loadText(kThree + faces, log).triangleCount(), 1);
        ASSERT_FALSE(log.warnings().empty()) << faces;
        EXPECT_TRUE(log.warnings().back().starts_with(warning)) << log.warnings().back();
    }
    MessageLog log;
    const Scene scene = loadText(kThree + "vn 0 0 1\nvn 1 0 0\nf 1/-7/2 2/-7/2 3/-7/-1\n", log);
    EXPECT_EQ(scene.instances.at(0).mesh->normals.at(0), Vec3(1, 0, 0)) << "the others stay";
    expectRefused("vt 0 0\nf 1/4 2/1 3/1\n", {"a.obj:5: ", "a texture coordinate", "expected 1 to 1, found 4"});
    expectRefused("f 1 2 -4\n", {"a.obj:4: a face refers to a vertex", "expected -3 to -1, found -4"});
}

TEST(ObjFaces, NumbersBeyondAllCountsAreNoVertices) {
    const std::string huge = "99999999999999999999";
    expectRefused("f 1 2 " + huge + "\n", {"a.obj:4: a face refers to a vertex", "expected 1 to 3, found " + huge});
    expectRefused("f 1 2 -" + huge + "\n", {"a.obj:4: ", "expected -3 to -1, found -" + huge});
    expectRefused("f 1 2 4294967297\n", {"a.obj:4: ", "expected 1 to 3, found 4294967297"});
}

}  // namespace
}  // namespace lumi
