// References of a tiny scene: the same bits by every way, and what is said of their noise is true.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <thread>

#include "base/files.h"
#include "base/memory.h"
#include "reference/block_tracer.h"
#include "reference/finished_reference.h"
#include "reference/reference_key.h"
#include "reference/reference_part.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "support/tiny_scene.h"

namespace lumi {
namespace {

ReferenceSpec tinySpec() {
    static const std::shared_ptr<const Scene> scene = test::tinyScene();
    ReferenceSpec spec;
    spec.scene = scene;
    spec.sceneKey = R"({"digest":"tiny"})";
    spec.camera = poseCamera(scene->cameras[0].camera, {16, 12});
    return spec;
}

Reference make(uint64_t samples, const std::filesystem::path& cache = {}, MessageLog* log = nullptr) {
    ReferenceOptions options;
    options.cache = cache;
    options.log = log;
    return makeReference(tinySpec(), {.samples = samples}, options);
}

/// Stops once `samples` are traced.
void interruptAfter(uint64_t samples, const ReferenceGoal& goal, const std::filesystem::path& cache) {
    std::stop_source stop;
    ReferenceOptions options;
    options.cache = cache;
    options.stop = stop.get_token();
    options.progress = [&](const ReferenceProgress& progress) {
        if (progress.samples >= samples) stop.request_stop();
    };
    test::expectError(ErrorKind::Interrupted, [&] { makeReference(tinySpec(), goal, options); });
}

std::filesystem::path keptFile(const std::filesystem::path& cache, uint64_t samples) {
    return cache / referenceKey(tinySpec()) / (std::to_string(samples) + ".lumiref");
}

bool mentions(const MessageLog& log, const std::string& text) {
    for (const std::string& warning : log.warnings())
        if (warning.find(text) != std::string::npos) return true;
    return false;
}

TEST(Reference, IsTheMeanOfOneFrameOfAsManySamples) {
    for (const uint64_t samples : {1, 5, 16, 100, 128}) {
        const Reference reference = make(samples);
        Tracer tracer;
        const ReferenceSpec spec = tinySpec();
        tracer.bind(poseScene(spec.scene, {0, 0, 0}));
        Signals signals;
        FrameSampling sampling;
        sampling.extent = spec.camera.extent;
        sampling.camera = sampling.previousCamera = spec.camera;
        sampling.samplesPerPixel = static_cast<int>(samples);
        sampling.wanted = {Signal::Noisy, Signal::Depth};
        ASSERT_TRUE(tracer.sample(sampling, signals));
        Image mean(spec.camera.extent, 3);
        for (size_t i = 0; i < mean.size(); ++i)
            mean.data()[i] = static_cast<float>(signals.noisySum().data()[i] * (1 / static_cast<double>(samples)));
        EXPECT_EQ(reference.image, mean) << samples;
        EXPECT_EQ(reference.depth, signals[Signal::Depth]);
        EXPECT_EQ(reference.samples, samples);
    }
}

TEST(Reference, TheCacheHandsOutTheSameBits) {
    const test::TemporaryFolder folder;
    const Reference first = make(272, folder.path()), again = make(272, folder.path()), without = make(272);
    EXPECT_FALSE(first.cached);
    EXPECT_TRUE(again.cached);
    EXPECT_EQ(again.file, keptFile(folder.path(), 272));
    for (const Reference* other : {&again, &without}) {
        EXPECT_EQ(first.image, other->image);
        EXPECT_EQ(first.halves[0], other->halves[0]);
        EXPECT_EQ(first.halves[1], other->halves[1]);
        EXPECT_EQ(first.standardError, other->standardError);
        EXPECT_EQ(first.error, other->error);
        EXPECT_EQ(first.depth, other->depth);
    }
}

TEST(Reference, GoesOnFromWhatIsThere) {
    const test::TemporaryFolder folder;
    interruptAfter(100, {.samples = 500}, folder.path());
    EXPECT_TRUE(std::filesystem::exists(keptFile(folder.path(), 112)));
    uint64_t resumed = 0;
    ReferenceOptions options;
    options.cache = folder.path();
    options.progress = [&](const ReferenceProgress& progress) { resumed = progress.resumed; };
    const Reference whole = makeReference(tinySpec(), {.samples = 500}, options);
    EXPECT_EQ(resumed, 112u);
    EXPECT_EQ(whole.image, make(500).image);
    EXPECT_EQ(whole.standardError, make(500).standardError);
    // What was on the way is gone; what was a goal stays, for a smaller one and as a start for a larger.
    EXPECT_FALSE(std::filesystem::exists(keptFile(folder.path(), 112)));
    EXPECT_EQ(make(64, folder.path()).image, make(64).image);
    EXPECT_EQ(make(520, folder.path()).image, make(520).image);
    for (const uint64_t samples : {64, 500, 520}) EXPECT_TRUE(make(samples, folder.path()).cached) << samples;
}

TEST(Reference, DamagedAndForeignFilesAreNamedAndNotUsed) {
    const test::TemporaryFolder folder;
    make(64, folder.path());
    std::vector<uint8_t> bytes = readFile(keptFile(folder.path(), 64));
    bytes[bytes.size() - 100] ^= 1;
    writeFileAtomically(keptFile(folder.path(), 64), bytes);
    MessageLog log;
    const Reference reference = make(64, folder.path(), &log);
    EXPECT_FALSE(reference.cached);
    EXPECT_EQ(reference.image, make(64).image);
    EXPECT_TRUE(mentions(log, keptFile(folder.path(), 64).string()));
    EXPECT_TRUE(mentions(log, "damaged"));
    EXPECT_TRUE(make(64, folder.path()).cached) << "it was made anew";

    ReferenceState state = readReferenceFile(keptFile(folder.path(), 64));
    ReferenceSpec other = tinySpec();
    other.seed = 7;
    state.key = referenceKeyText(other);
    writeReferenceFile(keptFile(folder.path(), 64), state);
    MessageLog second;
    EXPECT_FALSE(make(64, folder.path(), &second).cached);
    EXPECT_TRUE(mentions(second, "another image (seed: 0 and 7)"));
}

TEST(Reference, TheKeyCoversWhateverChangesTheImage) {
    const ReferenceSpec spec = tinySpec();
    std::vector<ReferenceSpec> others(9, spec);
    others[0].sceneKey = R"({"digest":"other"})";
    others[1].time = 0.5f;
    others[2].camera = poseCamera(spec.scene->cameras[1].camera, {16, 12});
    others[3].camera = poseCamera(spec.scene->cameras[0].camera, {16, 11});
    others[4].path.maxDepth = 3;
    others[5].path.sampler = SamplerKind::Independent;
    others[6].seed = 1;
    others[7].jitter = Jitter::None;
    others[8].camera.aperture = 0.1f;
    std::set<std::string> keys{referenceKey(spec)};
    for (const ReferenceSpec& other : others) {
        keys.insert(referenceKey(other));
        EXPECT_FALSE(keyDifference(referenceKeyText(spec), referenceKeyText(other)).empty());
    }
    EXPECT_EQ(keys.size(), 10u);
    EXPECT_EQ(referenceKey(tinySpec()), referenceKey(spec));
    EXPECT_NE(referenceKeyText(spec).find("\"sources\":\""), std::string::npos);
}

/// Every member of the settings and of a pose stands in the key. A new one makes these sizes change: add it to the key,
/// then here.
TEST(Reference, TheKeyHasEverySettingAndEveryMemberOfThePose) {
    const ReferenceSpec spec = tinySpec();
    EXPECT_EQ(sizeof(CameraPose), 2 * sizeof(Mat4) + 9 * sizeof(float));
    std::set<std::string> keys{referenceKey(spec)};
    size_t variants = 1;
    const auto differs = [&](const ReferenceSpec& other) { keys.insert(referenceKey(other)), ++variants; };
    ReferenceSpec other = spec;
    const auto pose = [&](auto change) { other = spec, change(other.camera), differs(other); };
    pose([](CameraPose& c) { c.worldFromCamera[3][0] += 1; });
    pose([](CameraPose& c) { c.projection = Projection::Orthographic; });
    pose([](CameraPose& c) { c.halfHeight *= 2; });
    pose([](CameraPose& c) { c.aperture = 1; });
    pose([](CameraPose& c) { c.focus *= 2; });
    pose([](CameraPose& c) { c.blades = 5; });
    pose([](CameraPose& c) { c.bladeRotation = 1; });
    other = spec, other.openSeconds = 0.1f, differs(other);  // what the pose's shutter comes to
    other = spec, other.cameraTrack = {spec.camera, spec.camera}, differs(other);
    PathSettings path;
    for (const ParameterInfo& info : listParameters([&](ParameterVisitor& v) { path.describe(v); })) {
        other = spec;
        const Describe describe = [&](ParameterVisitor& v) { other.path.describe(v); };
        std::vector<std::string> texts = info.options;
        if (info.type == ParameterType::Toggle) texts = {"true", "false"};
        if (info.type == ParameterType::Number || info.type == ParameterType::Integer)
            texts = {fmt::format("{}", info.min), fmt::format("{}", info.max)};
        const std::string present = referenceKeyText(spec);
        bool seen = false;
        for (const std::string& text : texts) {
            setParameter(describe, info.id, parseParameter(info, text, ""), "");
            seen = seen || referenceKeyText(other) != present;
        }
        EXPECT_TRUE(seen) << info.id;
    }
    EXPECT_EQ(keys.size(), variants);
}

TEST(Reference, APartThatAnotherProcessWroteMeanwhileIsNotWrittenOver) {
    const test::TemporaryFolder folder;
    makeReferencePart(tinySpec(), {16, 48}, folder / "theirs", "", {});
    const auto meanwhile = [&](SampleRange range) {
        ReferenceOptions options;
        options.progress = [&](const ReferenceProgress&) {
            std::filesystem::copy_file(folder / "theirs", folder / "same",
                                       std::filesystem::copy_options::skip_existing);
        };
        std::filesystem::remove(folder / "same");
        makeReferencePart(tinySpec(), range, folder / "same", "", options);
    };
    test::expectError(ErrorKind::Usage, [&] { meanwhile({0, 32}); }, {"exists", "16..48"});
    meanwhile({16, 48});
    EXPECT_EQ(readFile(folder / "same"), readFile(folder / "theirs"));
}

TEST(Reference, AnErrorAsGoalStopsAtTheFirstStepThatReachesIt) {
    const test::TemporaryFolder folder;
    const double at320 = make(320).error, at256 = make(256).error;
    ASSERT_LT(at320, at256);
    const ReferenceGoal goal{.error = (at256 + at320) / 2};
    interruptAfter(270, goal, folder.path());
    ReferenceOptions options;
    options.cache = folder.path();
    const Reference reference = makeReference(tinySpec(), goal, options);
    EXPECT_EQ(reference.samples, 320u);
    EXPECT_EQ(reference.error, at320);
    EXPECT_EQ(reference.image, make(320).image);
    EXPECT_TRUE(makeReference(tinySpec(), goal, options).cached);
    // A better one in the cache does not change what the same goal gives.
    make(640, folder.path());
    EXPECT_EQ(makeReference(tinySpec(), goal, options).samples, 320u);
    EXPECT_EQ(makeReference(tinySpec(), {.error = at256}, options).samples, 256u);
}

TEST(Reference, TheStandardErrorIsWhatSeedsDifferBy) {
    // Independent samples: the error of one reference, as it sees itself, against the scatter of references of other
    // seeds.
    ReferenceSpec spec = tinySpec();
    spec.path.sampler = SamplerKind::Independent;
    std::vector<Reference> references;
    for (spec.seed = 0; spec.seed < 12; ++spec.seed) references.push_back(makeReference(spec, {.samples = 256}, {}));
    double own = 0, seen = 0, halves = 0;
    const int64_t area = spec.camera.extent.area();
    for (int64_t p = 0; p < area; ++p) {
        double mean = 0;
        const auto light = [&](const Image& image) {
            return luminance(Vec3(image.data()[p], image.data()[area + p], image.data()[2 * area + p]));
        };
        for (const Reference& reference : references) mean += light(reference.image) / 12.0;
        for (const Reference& reference : references) {
            own += std::pow(reference.standardError.data()[p], 2) / 12;
            seen += std::pow(light(reference.image) - mean, 2) / 11;
            halves += std::pow((light(reference.halves[0]) - light(reference.halves[1])) / 2, 2) / 12;
        }
    }
    EXPECT_NEAR(own / seen, 1, 0.15);
    EXPECT_NEAR(halves / seen, 1, 0.2);
}

TEST(Reference, ForSobolSamplesTheStandardErrorIsAnUpperBound) {
    ReferenceSpec spec = tinySpec();
    std::vector<Reference> references;
    for (spec.seed = 0; spec.seed < 12; ++spec.seed) references.push_back(makeReference(spec, {.samples = 256}, {}));
    double own = 0, seen = 0;
    for (size_t i = 0; i < references[0].standardError.size(); ++i) {
        double mean = 0;
        for (const Reference& reference : references) mean += reference.image.data()[i] / 12.0;
        for (const Reference& reference : references) {
            own += std::pow(reference.standardError.data()[i], 2) / 12;
            seen += std::pow(reference.image.data()[i] - mean, 2) / 11;
        }
    }
    EXPECT_GT(own, 0.8 * seen);
}

TEST(Reference, ProcessesThatWantTheSameOneWaitForEachOther) {
    const test::TemporaryFolder folder;
    std::vector<Reference> made(3);
    {
        std::vector<std::jthread> threads;
        for (Reference& reference : made) threads.emplace_back([&] { reference = make(400, folder.path()); });
    }
    int traced = 0;
    for (const Reference& reference : made) {
        traced += !reference.cached;
        EXPECT_EQ(reference.image, made[0].image);
    }
    EXPECT_EQ(traced, 1);
}

TEST(Reference, WithoutAPlaceForItNothingIsKept) {
    const test::TemporaryFolder folder;
    writeFileAtomically(folder / "file", std::string_view("not a folder"));
    MessageLog log;
    EXPECT_EQ(make(32, folder / "file", &log).image, make(32).image);
    EXPECT_TRUE(mentions(log, "not kept"));
}

TEST(Reference, PartsMergeToTheWhole) {
    const test::TemporaryFolder folder;
    std::vector<std::filesystem::path> parts;
    for (const SampleRange range : {SampleRange{96, 320}, {0, 48}, {48, 96}}) {
        parts.push_back(folder / (std::to_string(range.begin) + ".lumiref"));
        makeReferencePart(tinySpec(), range, parts.back(), "note", {});
    }
    const Reference merged = finishedReference(mergeParts(parts)), whole = make(320);
    EXPECT_EQ(merged.image, whole.image);
    EXPECT_EQ(merged.standardError, whole.standardError);
    EXPECT_EQ(merged.depth, whole.depth);

    test::expectError(ErrorKind::BadInput,
                      [&] {
                          mergeParts(std::vector{parts[1], parts[0]});
                      },
                      {"missing", "96..320"});
    test::expectError(ErrorKind::BadInput, [&] { mergeParts(std::vector{parts[1], parts[1]}); }, {"overlaps"});
    ReferenceSpec other = tinySpec();
    other.path.maxDepth = 2;
    makeReferencePart(other, {48, 96}, folder / "other.lumiref", "note", {});
    test::expectError(ErrorKind::BadInput,
                      [&] {
                          mergeParts(std::vector{parts[1], folder / "other.lumiref"});
                      },
                      {"another image", "path.max-depth"});
    test::expectError(ErrorKind::Usage, [&] { makeReferencePart(other, {0, 48}, parts[1], "note", {}); }, {"exists"});
}

TEST(Reference, APartGoesOnWhereItWasStopped) {
    const test::TemporaryFolder folder;
    std::stop_source stop;
    ReferenceOptions options;
    options.stop = stop.get_token();
    options.progress = [&](const ReferenceProgress& progress) {
        if (progress.samples >= 64) stop.request_stop();
    };
    test::expectError(ErrorKind::Interrupted, [&] {
        makeReferencePart(tinySpec(), {32, 160}, folder / "a", "", options);
    });
    EXPECT_TRUE(std::filesystem::exists(folder / "a.partial"));
    makeReferencePart(tinySpec(), {32, 160}, folder / "a", "", {});
    makeReferencePart(tinySpec(), {32, 160}, folder / "b", "", {});
    EXPECT_EQ(readFile(folder / "a"), readFile(folder / "b"));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.partial"));
}

TEST(Reference, WhatPassesTheMemoryLimitIsRefused) {
    const uint64_t limit = memoryLimit();
    setMemoryLimit(residentBytes() + (1 << 20));
    ReferenceSpec spec = tinySpec();
    spec.camera = poseCamera(spec.scene->cameras[0].camera, {2048, 2048});
    test::expectError(ErrorKind::Resources, [&] { makeReference(spec, {.samples = 4096}, {}); },
                      {"2048x2048", "limit"});
    setMemoryLimit(limit);
}

}  // namespace
}  // namespace lumi
