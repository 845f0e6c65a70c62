#include "scene/obj/load_obj.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "scene/obj/cage.h"
#include "scene/obj/triangulate.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lumi {
namespace {

using test::expectError;
using test::TemporaryFolder;

Scene loadText(const std::string& obj, MessageLog& log, const std::string& mtl = {}) {
    TemporaryFolder folder;
    writeFileAtomically(folder / "a.obj", std::string_view(obj));
    if (!mtl.empty()) writeFileAtomically(folder / "a.mtl", std::string_view(mtl));
    return loadObj(folder / "a.obj", log);
}
Scene loadText(const std::string& obj, const std::string& mtl = {}) {
    MessageLog log;
    return loadText(obj, log, mtl);
}

// A square of two faces side by side, red and green, textured over all of it; as a cage its edges are creases.
const std::string kTwoFaces =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 2 0\nv 1 2 0\nv 2 2 0\n"
    "vt 0 0\nvt .5 0\nvt 1 0\nvt 0 1\nvt .5 1\nvt 1 1\n"
    "usemtl red\nf 1/1 2/2 5/5 4/4\nusemtl green\nf 2/2 3/3 6/6 5/5\n";
const std::string kRedAndGreen = "newmtl red\nKd 1 0 0\nnewmtl green\nKd 0 1 0\n";
const std::string kTags = "#t interpolateboundary 1/0/0 1\n#t corner 4/1/0 0 2 3 5 10\n";

float area(std::span<const Vec3> corners, const std::vector<UVec3>& triangles) {
    float sum = 0;
    for (const UVec3& t : triangles)
        sum += 0.5f * glm::cross(corners[t.y] - corners[t.x], corners[t.z] - corners[t.x]).z;
    return sum;
}

TEST(Triangulate, ConvexPolygonsAreCovered) {
    std::vector<Vec3> corners;
    for (int i = 0; i < 12; ++i)
        corners.emplace_back(std::cos(2 * kPi * static_cast<float>(i) / 12),
                             std::sin(2 * kPi * static_cast<float>(i) / 12), 0);
    const std::vector<UVec3> triangles = triangulatePolygon(corners);
    EXPECT_EQ(triangles.size(), 10u);
    EXPECT_NEAR(area(corners, triangles), 3, 1e-5f);
    for (uint32_t i = 0; i < 10; ++i) EXPECT_EQ(triangles[i], UVec3(0, i + 1, i + 2)) << "the fan around the first";
}

TEST(Triangulate, ConcavePolygonsKeepTheirShape) {
    // An arrow head: the fan from corner 0 would leave the polygon.
    const std::vector<Vec3> arrow{{2, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, -1, 0}};
    for (size_t turn = 0; turn < 4; ++turn) {
        std::vector<Vec3> corners = arrow;
        std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(turn), corners.end());
        const std::vector<UVec3> triangles = triangulatePolygon(corners);
        ASSERT_EQ(triangles.size(), 2u);
        EXPECT_NEAR(area(corners, triangles), 1, 1e-6f);
        for (const UVec3& t : triangles) EXPECT_GT(area(corners, {t}), 0) << "every triangle faces as the polygon does";
    }
}

/// A spiral has two ears, one at each end, and each cut makes the corner before it the next one.
TEST(Triangulate, SpiralsAreCutFromTheirEnds) {
    constexpr int kHalf = 2000, kTurns = 12;
    std::vector<Vec3> outer, inner;
    for (int i = 0; i < kHalf; ++i) {
        const float part = static_cast<float>(i) / kHalf, angle = 2 * kPi * kTurns * part, radius = 1 + 9 * part;
        const Vec3 direction(std::cos(angle), std::sin(angle), 0);
        outer.push_back(radius * direction);
        inner.push_back((radius - 0.25f) * direction);
    }
    std::vector<Vec3> corners = outer;
    corners.insert(corners.end(), inner.rbegin(), inner.rend());
    float twice = 0;
    for (size_t i = 0; i < corners.size(); ++i) twice += glm::cross(corners[i], corners[(i + 1) % corners.size()]).z;
    const std::vector<UVec3> triangles = triangulatePolygon(corners);
    EXPECT_EQ(triangles.size(), corners.size() - 2);
    EXPECT_NEAR(area(corners, triangles), twice / 2, 0.01f);
}

TEST(Triangulate, BadPolygonsStillGiveTriangles) {
    const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
    EXPECT_EQ(triangulatePolygon(line).size(), 2u);
    const std::vector<Vec3> bow{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_EQ(triangulatePolygon(bow).size(), 2u);
    EXPECT_TRUE(triangulatePolygon(std::span(line).first(2)).empty());
}

TEST(Obj, SharesVerticesAndFlipsV) {
    const Scene scene = loadText(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
        "f 1/1/1 2/2/1 3/3/1 4/4/1\n");
    const Mesh& mesh = *scene.instances.at(0).mesh;
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.uv[0][0], Vec2(0, 1)) << "v grows downwards here";
    EXPECT_EQ(mesh.normals[0], Vec3(0, 0, 1));
    EXPECT_EQ(scene.materials.size(), 1u);
}

TEST(Obj, GroupsBecomeInstances) {
    const Scene scene = loadText("v 0 0 0\nv 1 0 0\nv 1 1 0\no first\nf 1 2 3\no second\nf 3 2 1\n");
    ASSERT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(scene.instances[0].name, "first");
    EXPECT_EQ(scene.instances[1].mesh->positions.size(), 3u);
    EXPECT_TRUE(scene.instances[0].mesh->normals.empty()) << "no normals: flat";
}

TEST(Obj, SmoothingGroupsShareNormals) {
    const std::string roof = "v 0 0 0\nv 1 0 0\nv 0 1 1\nv 1 1 1\nv 0 2 0\nv 1 2 0\n";
    const Scene smooth = loadText(roof + "s 1\nf 1 2 4 3\nf 3 4 6 5\n");
    const Mesh& mesh = *smooth.instances.at(0).mesh;
    ASSERT_EQ(mesh.positions.size(), 6u);
    EXPECT_NEAR(glm::length(mesh.normals[2] - Vec3(0, 0, 1)), 0, 1e-5f);
    const Scene creased = loadText(roof + "s 1\nf 1 2 4 3\ns 2\nf 3 4 6 5\n");
    EXPECT_EQ(creased.instances.at(0).mesh->positions.size(), 8u) << "the ridge is split";
}

TEST(Obj, MaterialsOfTheirFaces) {
    const Scene scene =
        loadText("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl lamp\nf 1 2 3\nusemtl chrome\nf 3 2 1\n",
                 "newmtl chrome\nKd 0 0 0\nKs 0.9 0.8 0.7\nNs 1000\n"
                 "newmtl lamp\nKd 0.5 0.5 0.5\nKe 3 2 1\nNs 10\nKs 0 0 0\nd 0.5\n"
                 "newmtl pbr\nKd 1 0 0\nPr 0.3\nPm 1\n");
    ASSERT_EQ(scene.materials.size(), 3u);
    EXPECT_EQ(scene.instances[0].mesh->triangleMaterial, (std::vector<uint32_t>{1, 0}));
    EXPECT_EQ(scene.materials[0].metallic, 1);
    EXPECT_NEAR(scene.materials[0].roughness, std::pow(2.0f / 1002, 0.25f), 1e-5f);
    EXPECT_EQ(scene.materials[1].emission, Vec3(3, 2, 1));
    EXPECT_EQ(scene.materials[1].specular, 0);
    EXPECT_EQ(scene.materials[1].alphaMode, AlphaMode::Blend);
    EXPECT_EQ(scene.materials[2].metallic, 1);
    EXPECT_FLOAT_EQ(scene.materials[2].roughness, 0.3f);
}

TEST(Obj, MissingFilesAreWarnings) {
    MessageLog log;
    loadText("mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n", log);
    ASSERT_EQ(log.warnings().size(), 1u);
    EXPECT_NE(log.warnings()[0].find("none.mtl"), std::string::npos);
    log.clear();
    const Scene scene = loadText("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl m\nf 1 2 3\n", log,
                                 "newmtl m\nKd 1 1 1\nmap_Kd ../out.png\nmap_bump none.png\n");
    EXPECT_EQ(log.warnings().size(), 2u);
    EXPECT_FALSE(scene.materials[0].baseColorTexture);
}

TEST(Obj, OfManyFaultsTheFirstAreListed) {
    std::string text = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    for (int i = 0; i < 1000; ++i) text += "mtllib none" + std::to_string(i) + ".mtl\n";
    MessageLog log;
    EXPECT_EQ(loadText(text + "f 1 2 3\n", log).triangleCount(), 1);
    ASSERT_EQ(log.warnings().size(), 201u);
    EXPECT_EQ(log.warnings().back(), "a.obj: and 800 more faults");
}

TEST(Obj, WhatIsLeftOutIsSaidOnce) {
    MessageLog log;
    loadText("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl m\nf 1 2 3\nl 1 2\np 1\nl 2 3\n", log,
             "newmtl m\nKd 1 1 1\nmap_Ka a.png\nmap_Ks b.png\nmap_Ns c.png\nrefl d.png\ndisp e.png\n"
             "newmtl n\nmap_Ks f.png\nmap_Ps g.png\n");
    const std::vector<std::string> warnings = log.warnings();
    ASSERT_EQ(warnings.size(), 6u);
    EXPECT_EQ(warnings[0], "a.obj: lines and points are not drawn");
    EXPECT_EQ(warnings[1], "a.obj: textures of map_Ks are left out, as that of \"m\"");
    EXPECT_EQ(warnings[3], "a.obj: textures of map_Ps are left out, as that of \"n\"");
    EXPECT_NE(warnings[5].find("disp"), std::string::npos);
}

TEST(Obj, NumbersThatAreNoneAreRefusedOrCleanedWithTheirLine) {
    const char* rest = "v 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (const auto& [line, found] : {std::pair("v 1 nan x", "nan"),
                                      {"v 1 2", "too few"},
                                      {"v 0 0 1e99", "1e99"},
                                      {"v 0 inf 0", "inf"},
                                      {"v 1,5 0 0", "1,5"},
                                      {"v", "too few"}})
        expectError(ErrorKind::BadInput, [&] { loadText(std::string("# one\n\t") + line + "\n" + rest); },
                    {"a.obj:2", found});
    MessageLog log;
    const Scene scene = loadText(
        "v +0 -.5 1e-400 # a place\r\nv 1 0. 0 0.5 .5 1E-1\nv 0 1 0\nvt nan 0\nvt 1 0\nvn -nan(ind) 0 0\n"
        "vn 0 0\nf 1/1/1 2/2/1 3/2/2\n",
        log);
    EXPECT_EQ(scene.instances.at(0).mesh->positions[0], Vec3(0, -0.5f, 0));
    for (const Vec3& n : scene.instances[0].mesh->normals) EXPECT_NEAR(glm::length(n), 1, 1e-6f);
    ASSERT_EQ(log.warnings().size(), 1u);
    EXPECT_EQ(log.warnings()[0], "a.obj:4: not finite numbers, read as 0, as on 2 more lines");
}

TEST(Obj, BadIndicesAreRefused) {
    expectError(ErrorKind::BadInput, [] { loadText("v 0 0 0\nv 1 0 0\nf 1 2 9\n"); }, {"a.obj"});
    expectError(ErrorKind::BadInput, [] { loadText("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/4 2/5 3/6\n"); }, {"a.obj"});
    const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const auto refused = [](const std::string& text, const std::initializer_list<std::string>& parts) {
        expectError(
            ErrorKind::BadInput, [&] { loadText(text); }, parts);
    };
    refused(three + "f 1 2 3\nf -1 -2 -9\n", {"a.obj:5: a face refers to a vertex", "expected -3 to -1, found -9"});
    refused(three + "f 1 2 3\nf 1 2 4 # 9\nf 2 3 1\n", {"a.obj:5: ", "expected 1 to 3, found 4"});
    refused(three + "vt 0 0\nf 1/1 2/1 3/7\n", {"a.obj:5: ", "texture coordinate", "1 to 1, found 7"});
    refused(three + "f 1//1 2//1 3//1\n", {"a.obj:4: ", "a normal", "expected none", "found 1"});
    refused(three + "f 1 2 0/1\n", {"a.obj:4: ", "without a vertex", "found 0/1"});
    refused(three + "f 1 2 c\n", {"a.obj:4: ", "without a vertex", "found c"});
    EXPECT_EQ(loadText("f 1//1 2//1 3//1\n" + three + "vn 0 0 1\nf -3 -2 -1\n").triangleCount(), 2);

    std::string wide = "v 0 0 0\n";
    std::string face = "f";
    for (int i = 0; i < 300; ++i) {
        wide += "v " + std::to_string(i) + " 1 0\n";
        face += " " + std::to_string(i + 1);
    }
    expectError(ErrorKind::BadInput, [&] { loadText(wide + face + "\n"); }, {"a.obj", "255"});
    TemporaryFolder folder;
    MessageLog log;
    expectError(ErrorKind::BadInput, [&] { loadObj(folder / "none.obj", log); }, {"none.obj"});
}

TEST(ObjCage, TagsMakeItOne) {
    MessageLog log;
    const Scene plain = loadText(kTwoFaces, log, kRedAndGreen);
    EXPECT_EQ(plain.instances[0].mesh->triangles.size(), 4u);
    const Scene smooth = loadText(kTwoFaces + kTags, log, kRedAndGreen);
    ASSERT_EQ(smooth.instances.size(), 1u);
    EXPECT_EQ(smooth.instances[0].mesh->triangles.size(), 2u * 2 * 8 * 8);
    EXPECT_TRUE(log.warnings().empty());
}

// v of an OBJ goes up, that of our textures down.
TEST(ObjCage, HasTheMaterialsAndTexturesOfItsPolygons) {
    const Scene scene = loadText(kTwoFaces + kTags, kRedAndGreen);
    const Mesh& mesh = *scene.instances[0].mesh;
    ASSERT_EQ(mesh.uv[0].size(), mesh.positions.size());
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        EXPECT_NEAR(mesh.uv[0][v].x, mesh.positions[v].x / 2, 1e-5f);
        EXPECT_NEAR(mesh.uv[0][v].y, 1 - mesh.positions[v].y / 2, 1e-5f);
    }
    ASSERT_EQ(mesh.triangleMaterial.size(), mesh.triangles.size());
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const UVec3& corners = mesh.triangles[t];
        const float x = (mesh.positions[corners.x].x + mesh.positions[corners.y].x + mesh.positions[corners.z].x) / 3;
        EXPECT_EQ(scene.materials[mesh.triangleMaterial[t]].baseColor, x < 1 ? Vec3(1, 0, 0) : Vec3(0, 1, 0));
    }
}

TEST(ObjCage, TellsOfTagsThatItLeavesOut) {
    MessageLog log;
    loadText(kTwoFaces + "t creese 2/1/0 0 1 3\nt creese 2/1/0 1 2 3\n", log, kRedAndGreen);
    ASSERT_EQ(log.warnings().size(), 1u);
    EXPECT_NE(log.warnings()[0].find("creese"), std::string::npos);
}

TEST(ObjCage, TellsOfTagsThatMeanNothing) {
    const auto warning = [](const std::string& tags) {
        MessageLog log;
        loadText(kTwoFaces + tags, log, kRedAndGreen);
        return log.warnings().empty() ? std::string() : log.warnings()[0];
    };
    const auto expectTold = [&](const std::string& tags, const std::string& part) {
        EXPECT_NE(warning(tags).find(part), std::string::npos) << tags << warning(tags);
    };
    expectTold("t interpolateboundary 1/0/0 3\n", "\"interpolateboundary\" has no rule 3 (0 to 2)");
    expectTold("t facevaryinginterpolateboundary 1/0/0 -1\n", "has no rule -1 (0 to 5)");
    expectTold("t creasemethod 0/0/1 chaikn\n", "\"chaikn\"");
    expectTold("t crease 2/1/0 0 4 3\n", "a crease along no edge, between vertices 0 and 4");
    expectTold("t crease 3/1/0 0 1 3 2\nt crease 2/1/0 0 4 3\n", "2 creases along no edge, the first between");
    EXPECT_EQ(warning("t crease 2/1/0 1 0 3\nt crease 2/1/0 4 1 2\n"), "");
    for (const std::string vertex : {"-1", "99"}) {
        const std::string told = warning("t crease 2/1/0 0 " + vertex + " 3\n");
        EXPECT_TRUE(told.starts_with("a.obj: a crease index is out of range") &&
                    told.find("found " + vertex + ";") != told.npos)
            << told;
    }
}

TEST(ObjCage, CommentsAreNoTags) {
    const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    for (const char* comment : {"#t he model, made by me\n", "#t corner of the room\n", "#t crease\n", "#t hole \n"}) {
        MessageLog log;
        EXPECT_EQ(loadText(comment + square, log).triangleCount(), 2) << comment;
        EXPECT_EQ(loadText(square + comment, log).triangleCount(), 2) << comment;
        EXPECT_TRUE(log.warnings().empty());
    }
    EXPECT_GT(loadText(square + "#t interpolateboundary 1/0/0 1\n").triangleCount(), 2);
}

/// A saddle: of the bilinear patch over its corners, z = x y.
const std::string kSaddle = "v 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 1 0\nf 1 2 3 4\n";

TEST(ObjCage, CommentsSayTheScheme) {
    const Scene bilinear = loadText("# made by hand\n# scheme: bilinear; and more\n" + kSaddle);
    const Mesh& mesh = *bilinear.instances.at(0).mesh;
    EXPECT_GT(mesh.positions.size(), 16u);
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        const Vec3& p = mesh.positions[v];
        EXPECT_NEAR(p.z, p.x * p.y, 1e-6f);
        EXPECT_LT(glm::distance(mesh.normals[v], glm::normalize(Vec3(-p.y, -p.x, 1))), 1e-5f);
    }
    const std::string cube =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
        "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    EXPECT_LT(loadText("# scheme: catmark\n" + cube).restBounds().upper.x, 0.95f);
    EXPECT_EQ(loadText("# scheme: bilinear\r\n" + cube).restBounds().upper.x, 1);
    for (const char* plain : {"# scheme: loop\n", "# the scheme: catmark\n", "# scheme\n", "# scheme: "})
        EXPECT_EQ(loadText(cube + plain).triangleCount(), 12) << plain;
    MessageLog log;
    loadText(cube + "# scheme: loop\n", log);
    EXPECT_NE(log.warnings().at(0).find("the subdivision scheme \"loop\" is not supported"), std::string::npos);
}

TEST(ObjCage, TheSceneFileHasTheLastWordOnTheScheme) {
    TemporaryFolder folder;
    writeFileAtomically(folder / "a.obj", "# scheme: catmark\n" + kSaddle);
    MessageLog log;
    LoadOptions options;
    options.subdivision.scheme = SubdivisionScheme::None;
    EXPECT_EQ(loadObj(folder / "a.obj", log, options).triangleCount(), 2);
    options.subdivision.scheme = SubdivisionScheme::Bilinear;
    const Scene patch = loadObj(folder / "a.obj", log, options);
    for (const Vec3& p : patch.instances.at(0).mesh->positions) EXPECT_NEAR(p.z, p.x * p.y, 1e-6f);
}

SubdivisionCage cageWith(const std::string& tags) {
    MessageLog log;
    const SubdivisionCage cage =
        parseCage("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nf 1 2 3 4\nf 1 5 2\nf 2 5 3\n" + tags, "a.obj", log);
    EXPECT_TRUE(log.warnings().empty());
    return cage;
}

TEST(ObjCage, ChainsTakeOneSharpnessOrOneAnEdge) {
    for (const auto& [tag, second] :
         {std::pair("#t crease 3/1/0 0 1 2 4.5\n", 4.5f), {"t crease 3/2/0 0 1 2 4.5 3\n", 3.0f}}) {
        const SubdivisionCage cage = cageWith(tag);
        ASSERT_EQ(cage.creases.size(), 2u) << tag;
        EXPECT_EQ(cage.creases[0].a, 0u);
        EXPECT_EQ(cage.creases[0].b, 1u);
        EXPECT_EQ(cage.creases[0].sharpness, 4.5f);
        EXPECT_EQ(cage.creases[1].a, 1u);
        EXPECT_EQ(cage.creases[1].b, 2u);
        EXPECT_EQ(cage.creases[1].sharpness, second);
    }
    const SubdivisionCage corner = cageWith("#t corner 1/1/0 4 2.5\n");
    ASSERT_EQ(corner.corners.size(), 1u);
    EXPECT_EQ(corner.corners[0].vertex, 4u);
    EXPECT_EQ(corner.corners[0].sharpness, 2.5f);
}

TEST(ObjCage, RulesAreThoseOfTheirTags) {
    using Boundary = SubdivisionCage::Boundary;
    EXPECT_EQ(cageWith("").boundary, Boundary::EdgeOnly);
    EXPECT_EQ(cageWith("#t interpolateboundary 1/0/0 0\n").boundary, Boundary::None);
    EXPECT_EQ(cageWith("#t interpolateboundary 1/0/0 1\n").boundary, Boundary::EdgeAndCorner);
    EXPECT_EQ(cageWith("#t interpolateboundary 1/0/0 2\n").boundary, Boundary::EdgeOnly);
    for (int rule = 0; rule < 6; ++rule)
        EXPECT_EQ(
            static_cast<int>(cageWith(fmt::format("#t facevaryinginterpolateboundary 1/0/0 {}\n", rule)).faceVarying),
            rule);
    EXPECT_TRUE(cageWith("#t creasemethod 0/0/1 chaikin\n").chaikin);
    EXPECT_FALSE(cageWith("#t creasemethod 0/0/1 normal\n").chaikin);
    EXPECT_TRUE(cageWith("#t smoothtriangles 0/0/1 smooth\n").smoothTriangles);
    EXPECT_FALSE(cageWith("#t smoothtriangles 0/0/1 catmark\n").smoothTriangles);
    EXPECT_TRUE(cageWith("#t smoothtriangles 1/0/0 1\n").smoothTriangles);
}

TEST(ObjCage, OneTagCutsSeveralHoles) {
    const std::string strip =
        "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 3 1 0\n"
        "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\n#t interpolateboundary 1/0/0 1\n";
    const int64_t whole = loadText(strip).triangleCount();
    EXPECT_EQ(3 * loadText(strip + "#t hole 1/0/0 1\n").triangleCount(), 2 * whole);
    const Scene middle = loadText(strip + "#t hole 2/0/0 0 2\n");
    EXPECT_EQ(3 * middle.triangleCount(), whole);
    EXPECT_NEAR(middle.restBounds().size().x, 1, 1e-5);
}

TEST(ObjCage, WithoutALimitSurfaceItsPolygonsAreShown) {
    MessageLog log;
    const Scene scene = loadText("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nt corner 1/1/0 77 10\n", log);
    EXPECT_EQ(scene.instances[0].mesh->triangles.size(), 1u);
    ASSERT_EQ(log.warnings().size(), 1u);
    EXPECT_NE(log.warnings()[0].find("as they are"), std::string::npos);
}

}  // namespace
}  // namespace lumi
