// libFuzzer target of one kind of file that tells what to do with scenes: LUMI_FUZZ_KIND chooses a study, the state
// inside an image, or a part of a reference.
#include "fuzz/fuzz_target.h"
#include "reference/reference_file.h"
#include "scene/load.h"
#include "session/document.h"
#include "session/replay.h"
#include "study/study_file.h"

namespace lumi::fuzz {
namespace {

const std::string kKind = LUMI_FUZZ_KIND;

/// A scene with one of each thing that a state can speak of.
std::shared_ptr<const Scene> smallScene() {
    static const std::shared_ptr<const Scene> scene = [] {
        const std::string json = R"({"version": 1, "assets": {"ball": {"sphere": {}}}, "materials": {"red": {}},
            "instances": [{"name": "ball", "asset": "ball", "material": "red"}],
            "lights": {"lamp": {"rectangle": {}}}, "cameras": {"main": {}}, "environment": {"constant": [1, 1, 1]}})";
        MessageLog log;
        return loadScene(fileOf({reinterpret_cast<const uint8_t*>(json.data()), json.size()}, "scene.json"), log);
    }();
    return scene;
}

void replay(Bytes bytes) {
    const Replay replay = parseReplay(text(bytes), "fuzz");
    Document document(smallScene());
    document.apply(replay.start, "fuzz");
    for (const auto& [frame, values] : replay.sets) document.apply(*replay.valuesOf(frame), "fuzz");
    if (!replay.ticks.empty()) document.apply(*replay.valuesOf(replay.ticks.front().first), "fuzz");
}

}  // namespace

void load(Bytes bytes) {
    if (kKind == "study") parseStudy(text(bytes), "fuzz.json", "");
    else if (kKind == "state") replay(bytes);
    else readReferenceFile(fileOf(bytes, "fuzz.part"));
}

}  // namespace lumi::fuzz
