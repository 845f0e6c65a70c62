#include "scene_file_support.h"

#include <string>
#include <utility>
#include <vector>

#include "base/files.h"
#include "support/expect_error.h"
#include "support/memory_limit.h"
#include "support/temporary_folder.h"

// Every way in which a scene file can be wrong, with the exact text that a user reads.
namespace lumi::test {
namespace {

struct Fault {
    const char* text;
    const char* message;
};

void expectFaults(const std::vector<Fault>& faults) {
    for (const Fault& fault : faults) EXPECT_EQ(refusal(fault.text), fault.message) << fault.text;
}

TEST(SceneFileErrors, TextThatIsNotJson) {
    expectFaults({
        {"", "s.json:1:1: file is empty; expected a JSON object"},
        {"[1]", "s.json:1:1: is not a scene file; expected a JSON object, found an array of 1"},
        {"{\"version\": 1,\n  \"title\" \"x\"}", "s.json:2:11: expected \":\" after the key"},
        {"{\"version\": 1,\n  title: 2}", "s.json:2:3: expected a key in quotes"},
        {"{\"version\": 1\n \"title\": 2}", "s.json:2:2: expected \",\" or \"}\""},
        {"{\"version\": [1 2]}", "s.json:1:16: expected \",\" or \"]\""},
        {"{\"version\": 1, \"title\": \"x", "s.json:1:27: string without closing quote"},
        {"{\"version\": 1, \"title\": \"\\q\"}", "s.json:1:26: unknown escape in a string"},
        {"{\"version\": 1.}", "s.json:1:15: expected a digit after the decimal point"},
        {"{\"version\": nan}", "s.json:1:14: not a JSON value"},
        {"{\"version\": 1} x", "s.json:1:16: more text after the end of the JSON value"},
        {"{\"version\": 1, // no\n}", "s.json:1:16: expected a key in quotes"},
        {"{\"version\": 1, \"title\": 1e999}", "s.json:1:25: number is too large"},
        {"{\"version\": 1,\n \"title\": \"a\", \"title\": \"b\"}",
         "s.json:2:16: \"title\" stands twice in one object; found the first in line 2"},
    });
    EXPECT_EQ(refusal("{\"version\": 1, \"title\": \"\xff\"}").substr(0, 12), "s.json:1:26:");
}

TEST(SceneFileErrors, DeepNestingIsRefusedEarly) {
    EXPECT_EQ(refusal(std::string(200000, '[')), "s.json:1:257: nested more than 256 levels deep");
    std::string objects;
    for (int i = 0; i < 100000; ++i) objects += "{\"a\":";
    EXPECT_EQ(refusal(objects), "s.json:1:1281: nested more than 256 levels deep");
}

TEST(SceneFileErrors, TopLevel) {
    expectFaults({
        {"{}", "s.json:1:1: \"scene\" has no \"version\""},
        {"{\"version\": 2}", "s.json:1:13: \"version\" is 2; expected 1"},
        {"{\"version\": \"1\"}", "s.json:1:13: \"version\" is \"1\"; expected 1"},
        {"{\"vershion\": 1}", "s.json:1:2: unknown key \"vershion\"; expected \"version\""},
        {"{\"version\": 1, \"materals\": {}}", "s.json:1:16: unknown key \"materals\"; expected \"materials\""},
        {"{\"version\": 1, \"title\": 3}", "s.json:1:25: \"title\" is 3; expected text in quotes"},
        {"{\"version\": 1, \"lights\": []}", "s.json:1:26: \"lights\" is an array of 0; expected an object"},
        {"{\"version\": 1, \"instances\": {}}", "s.json:1:29: \"instances\" is an object; expected an array"},
    });
}

TEST(SceneFileErrors, ValuesGoThroughTheirDeclarations) {
    expectFaults({
        {"{\"version\": 1, \"materials\": {\"m\": {\"roughness\": 2}}}",
         "s.json:1:49: \"roughness\" is 2; expected 0 to 1"},
        {"{\"version\": 1, \"materials\": {\"m\": {\"roughness\": \"2\"}}}",
         "s.json:1:49: \"roughness\" is \"2\"; expected a number"},
        {"{\"version\": 1, \"materials\": {\"m\": {\"roughness\": 1e300}}}",
         "s.json:1:49: \"roughness\" is 1e300; expected 0 to 1"},
        {"{\"version\": 1, \"materials\": {\"m\": {\"rougness\": 1}}}",
         "s.json:1:36: unknown key \"rougness\"; expected \"roughness\""},
        {"{\"version\": 1, \"materials\": {\"m\": {\"base-color\": [1, 2, 0]}}}",
         "s.json:1:50: \"base-color\" is 1,2,0; expected 0 to 1 for each of three"},
        {"{\"version\": 1, \"materials\": {\"m\": {\"base-color\": [1, 2]}}}",
         "s.json:1:50: \"base-color\" is an array of 2; expected three numbers"},
        {"{\"version\": 1, \"materials\": {\"m\": {\"base-color\": [1, null, 0]}}}",
         "s.json:1:54: \"base-color[1]\" is null; expected a number"},
        {"{\"version\": 1, \"materials\": {\"m\": {\"alpha-mode\": \"mark\"}}}",
         "s.json:1:50: \"alpha-mode\" is \"mark\"; expected \"opaque\", \"mask\" or \"blend\""},
        {"{\"version\": 1, \"materials\": {\"m\": {\"double-sided\": 1}}}",
         "s.json:1:52: \"double-sided\" is 1; expected true or false"},
        {"{\"version\": 1, \"assets\": {\"a\": {\"sphere\": {\"segments\": 2}}}}",
         "s.json:1:56: \"segments\" is 2; expected 3 to 4096"},
        {"{\"version\": 1, \"assets\": {\"a\": {\"sphere\": {\"segments\": 3.5}}}}",
         "s.json:1:56: \"segments\" is 3.5; expected a whole number"},
        {"{\"version\": 1, \"cameras\": {\"c\": {\"fov-y-deg\": 180}}}",
         "s.json:1:47: \"fov-y-deg\" is 180; expected 1 to 170"},
        {"{\"version\": 1, \"render\": {\"size\": [0, 10]}}", "s.json:1:36: \"width\" is 0; expected 1 to 16384"},
        {"{\"version\": 1, \"render\": {\"size\": 10}}", "s.json:1:35: \"size\" is 10; expected two numbers"},
        {"{\"version\": 1, \"render\": {\"set\": {\"a\": {}}}}",
         "s.json:1:40: \"a\" is an object; expected a number, true or false, text or three numbers"},
    });
}

TEST(SceneFileErrors, Assets) {
    expectFaults({
        {"{\"version\": 1, \"assets\": {\"a\": 3}}", "s.json:1:32: \"a\" is 3; expected an object"},
        {"{\"version\": 1, \"assets\": {\"a\": {\"spehre\": {}}}}",
         "s.json:1:33: unknown key \"spehre\"; expected \"sphere\""},
        {"{\"version\": 1, \"assets\": {\"a\": {\"sphere\": {}, \"box\": {}}}}",
         "s.json:1:54: asset \"a\" is both \"sphere\" and \"box\""},
        {"{\"version\": 1, \"assets\": {\"a\": {\"obj\": \"x.obj\", \"scene\": 1}}}",
         "s.json:1:49: unknown key \"scene\"; expected \"cone\""},
        {"{\"version\": 1, \"assets\": {\"a\": {\"box\": {\"bevel\": 0.6}}}, \"instances\": [{\"asset\": \"a\"}]}",
         "s.json:1:40: asset \"a\": \"bevel\" is more than half of the smallest side; expected at most 0.5, found 0.6"},
        {"{\"version\": 1, \"assets\": {\"a\": {\"gltf\": \"no/such.glb\"}}, \"instances\": [{\"asset\": \"a\"}]}",
         "s.json:1:41: asset \"a\": no/such.glb: no such file"},
    });
}

TEST(SceneFileErrors, Instances) {
    const std::string head = "{\"version\": 1, \"assets\": {\"ball\": {\"sphere\": {}}},\n\"instances\": [";
    const std::vector<std::pair<const char*, const char*>> faults{
        {"{\"asset\": \"bal\"}", "s.json:2:25: unknown asset \"bal\"; expected \"ball\""},
        {"{\"asset\": \"ball\", \"material\": \"gold\"}",
         "s.json:2:45: unknown material \"gold\"; expected none, for none is defined"},
        {"{\"asset\": \"ball\", \"parent\": \"x\"}", "s.json:2:43: unknown instance \"x\"; expected \"ball\""},
        {"{\"name\": \"a\", \"parent\": \"a\"}", "s.json:2:39: instance \"a\" is its own ancestor"},
        {"{\"name\": \"a\"}, {\"name\": \"a\"}", "s.json:2:39: two instances are named \"a\""},
        {"{\"scale\": 0}", "s.json:2:25: \"scale\" is 0; expected no zero"},
        {"{\"scale\": [1, 2]}", "s.json:2:25: \"scale\" is an array of 2; expected three numbers"},
        {"{\"look-at\": [0, 0, 0]}",
         "s.json:2:16: unknown key \"look-at\"; expected one of \"asset\", \"interpolation\", \"keys\", \"loop\", "
         "\"name\", \"parent\", \"rotate-deg\", \"scale\" or \"translate\""},
        {"{\"keys\": [{\"translate\": [0, 0, 0]}]}", "s.json:2:25: \"keys\" has no \"time\""},
        {"{\"keys\": [{\"time\": 1}, {\"time\": 1}]}",
         "s.json:2:47: \"time\" is 1; expected more than the previous key's 1"},
        {"{\"keys\": [{\"time\": -1}]}", "s.json:2:34: \"time\" is -1; expected 0 to 1e+06"},
        {"{\"interpolation\": \"cubic\"}",
         "s.json:2:33: \"interpolation\" is \"cubic\"; expected \"step\", \"linear\" or \"catmull-rom\""},
    };
    for (const auto& [entry, message] : faults) EXPECT_EQ(refusal(head + entry + "]}"), message) << entry;
}

TEST(SceneFileErrors, SlotsByName) {
    EXPECT_EQ(refusal(R"({"version": 1, "assets": {"ball": {"sphere": {}}}, "materials": {"gold": {}},
"instances": [{"asset": "ball", "materials": {"surfce": "gold"}}]})"),
              "s.json:2:47: unknown material slot of asset \"ball\" \"surfce\"; expected \"surface\"");
}

TEST(SceneFileErrors, LightsCamerasAndEnvironment) {
    expectFaults({
        {"{\"version\": 1, \"lights\": {\"l\": {}}}",
         "s.json:1:32: light \"l\" has no kind; expected one of \"rectangle\", \"disk\", \"sphere\", \"point\", "
         "\"spot\" or "
         "\"directional\""},
        {"{\"version\": 1, \"lights\": {\"l\": {\"point\": {}, \"spot\": {}}}}",
         "s.json:1:54: light \"l\" has two kinds"},
        {"{\"version\": 1, \"lights\": {\"l\": {\"sphere\": {\"size\": [1, 1]}}}}",
         "s.json:1:44: unknown key \"size\"; expected \"radius\""},
        {"{\"version\": 1, \"lights\": {\"l\": {\"sphere\": {}, \"irradiance\": [1, 1, 1]}}}",
         "s.json:1:47: unknown key \"irradiance\"; expected \"radiance\""},
        {"{\"version\": 1, \"lights\": {\"l\": {\"sphere\": {}, \"radiance\": -1}}}",
         "s.json:1:59: \"radiance\" is -1; expected 0 to 1e+06"},
        {"{\"version\": 1, \"lights\": {\"l\": {\"point\": {}, \"look-at\": [1, 0, 0], \"direction\": [1, 0, 0]}}}",
         "s.json:1:32: \"l\" is turned in two ways; expected one of \"rotate-deg\", \"look-at\" and \"direction\""},
        {"{\"version\": 1, \"lights\": {\"l\": {\"point\": {}, \"direction\": [0, 0, 0]}}}",
         "s.json:1:59: \"direction\" is an array of 3; expected a vector that is not zero"},
        {"{\"version\": 1, \"lights\": {\"l\": {\"spot\": {\"inner-cone-deg\": 50, \"outer-cone-deg\": 40}}}}",
         "s.json:1:41: \"spot\" is an object; expected an inner cone within the outer"},
        {"{\"version\": 1, \"cameras\": {\"c\": {\"eye\": [0, 0, 1], \"look-at\": [0, 0, 1]}}}",
         "s.json:1:33: camera \"c\" looks at its own eye"},
        {"{\"version\": 1, \"cameras\": {\"c\": {\"keys\": [{\"time\": 0, \"up\": [0, 1, 0]}]}}}",
         "s.json:1:55: unknown key \"up\"; expected one of \"eye\", \"focus\", \"fov-y-deg\", \"look-at\" or \"time\""},
        {"{\"version\": 1, \"environment\": {\"file\": \"none.hdr\"}}",
         "s.json:1:40: \"environment\": none.hdr: no such file"},
        {"{\"version\": 1, \"environment\": {\"file\": \"a.hdr\", \"sky\": {}}}",
         "s.json:1:56: \"environment\" has both \"file\" and \"sky\""},
        {"{\"version\": 1, \"environment\": {\"sky\": {\"sun-share\": 2}}}",
         "s.json:1:53: \"sun-share\" is 2; expected 0 to 1"},
    });
}

TEST(SceneFileErrors, Textures) {
    TemporaryFolder folder;
    writeFileAtomically(folder / "broken.png", std::string_view("not a picture"));
    const std::string path = folder.path().string();
    const std::string head = "{\"version\": 1, \"materials\": {\"m\": {\"base-color-texture\": ";
    EXPECT_EQ(refusal(head + "3}}}"), "s.json:1:58: \"base-color-texture\" is 3; expected a file name or an object");
    EXPECT_EQ(refusal(head + "{}}}}"),
              "s.json:1:58: \"base-color-texture\" names no image; expected \"file\" or a generator");
    EXPECT_EQ(refusal(head + "{\"file\": \"a\", \"checker\": {}}}}}"),
              "s.json:1:58: \"base-color-texture\" names two images; expected one of \"file\" or a generator");
    EXPECT_EQ(refusal(head + "{\"chekker\": {}}}}}"), "s.json:1:59: unknown key \"chekker\"; expected \"checker\"");
    EXPECT_EQ(refusal(head + "\"none.png\"}}}", folder.path()),
              "s.json:1:58: \"base-color-texture\": " + path + "/none.png: no such file");
    EXPECT_NE(refusal(head + "\"broken.png\"}}}", folder.path()).find("broken.png"), std::string::npos);
    EXPECT_EQ(refusal(head + "\".\"}}}", folder.path()).substr(0, 12), "s.json:1:58:");
}

TEST(SceneFileErrors, TheTreeOfTheJsonCountsAgainstTheMemoryLimit) {
    std::string items;
    for (int i = 0; i < 100000; ++i) items += i == 0 ? "1" : ",1";
    const std::string text = "{\"version\": 1, \"title\": [" + items + "]}";
    EXPECT_EQ(refusal(text), "s.json:1:25: \"title\" is an array of 100000; expected text in quotes");
    const MemoryLimit limit(uint64_t(1) << 20);
    expectError(ErrorKind::Resources, [&] { parseScene(text); }, {"the JSON of s.json needs ", "memory limit"});
}

}  // namespace
}  // namespace lumi::test
