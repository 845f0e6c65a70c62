// Kernels of plain surfaces against the classes that do the same one by one, and against themselves on every
// instruction set.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "base/isa.h"
#include "math/hash.h"
#include "math/transform.h"
#include "math/warp.h"
#include "trace/albedo_table.h"
#include "trace/bsdf.h"
#include "trace/plain_kernels.h"
#include "trace/sampler.h"
#include "trace/sampler_kernels.h"
#include "trace/texture_view.h"

namespace lumi {
namespace {

constexpr int kLanes = PlainLanes::kMost - 3;  // not a multiple of any vector's width

class Numbers {
public:
    explicit Numbers(uint32_t seed) : state_(seed) {}
    float next() { return unitFloat(state_ = pcgHash(state_ + 1)); }
    Vec2 next2() { return {next(), next()}; }
    Vec3 next3() { return {next(), next(), next()}; }

private:
    uint32_t state_;
};

BsdfInputs materialOf(int i, Numbers& u) {
    BsdfInputs in;
    in.baseColor = u.next3();
    in.metallic = i % 3 == 0 ? 0.0f : i % 3 == 1 ? 1.0f : u.next();
    in.roughness = i % 7 == 0 ? 0.0f : u.next();
    in.ior = i % 11 == 0 ? 1e4f : 1 + u.next();  // what reflects everything is far off the others
    in.specular = i % 5 == 0 ? 0.0f : u.next();
    in.specularColor = u.next3();
    in.multipleScattering = true;
    return in;
}

/// Lanes of all kinds of materials, lit from and seen from anywhere.
std::unique_ptr<PlainLanes> makeLanes(std::vector<BsdfInputs>& materials) {
    auto lanes = std::make_unique<PlainLanes>();
    Numbers u(7);
    lanes->count = kLanes;
    for (int i = 0; i < kLanes; ++i) {
        materials.push_back(materialOf(i, u));
        const BsdfInputs& in = materials.back();
        const Vec3 normal = sampleSphere(u.next2());
        const Frame frame(normal);
        lanes->normal.set(i, normal), lanes->geometricNormal.set(i, normal);
        lanes->wo.set(i, frame.toWorld(sampleCosineHemisphere(u.next2())));
        lanes->position.set(i, 10.0f * (u.next3() - Vec3(0.5f)));
        lanes->throughput.set(i, Vec3(1));
        lanes->offset[i] = 0;
        lanes->baseColor.set(i, in.baseColor), lanes->specularColor.set(i, in.specularColor);
        lanes->metallic[i] = in.metallic, lanes->roughness[i] = in.roughness;
        lanes->ior[i] = in.ior, lanes->specular[i] = in.specular;
        lanes->lobes[i] = PlainLanes::kDiffuseLobe | PlainLanes::kSpecularLobe;
        lanes->lobeX[i] = u.next(), lanes->bsdfX[i] = u.next(), lanes->bsdfY[i] = u.next(),
        lanes->rouletteX[i] = u.next();
        lanes->lightDirection.set(i, frame.toWorld(sampleCosineHemisphere(u.next2())));
        lanes->lightTarget.set(i, Vec3(0)), lanes->lightRadiance.set(i, Vec3(1));
        lanes->lightDistance[i] = kInfinity, lanes->lightPdf[i] = 1, lanes->lightWeighs[i] = 0;
    }
    return lanes;
}

void run(const PlainLobeKernels& kernels, PlainLanes& lanes) {
    const AlbedoView albedos = SchlickAlbedo::get().view();
    const PlainSettings settings;
    kernels.prepare(lanes, albedos, settings);
    kernels.light(lanes, albedos, settings);
    kernels.scatter(lanes, albedos, settings);
}

void expectNear(const Vec3& found, const Vec3& expected, int lane) {
    for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(found[c], expected[c], 2e-4f * std::abs(expected[c]) + 2e-5f) << "lane " << lane;
}

}  // namespace

TEST(PlainKernels, AgreeWithBsdf) {
    std::vector<BsdfInputs> materials;
    const auto lanes = makeLanes(materials);
    run(plainLobeKernels(), *lanes);
    int deltas = 0, ends = 0;
    for (int i = 0; i < kLanes; ++i) {
        const Frame frame(lanes->normal.get<Vec3>(i));
        Vec3 wo = frame.toLocal(lanes->wo.get<Vec3>(i));
        const Bsdf bsdf(materials[static_cast<size_t>(i)], wo);
        expectNear(lanes->diffuseAlbedo.get<Vec3>(i), bsdf.albedo(Lobe::Diffuse), i);
        expectNear(lanes->specularAlbedo.get<Vec3>(i), bsdf.specularAlbedo(), i);
        const BsdfValue lit = bsdf.evaluate(frame.toLocal(lanes->lightDirection.get<Vec3>(i)));
        expectNear(lanes->lightDiffuse.get<Vec3>(i), lit.diffuse, i);
        expectNear(lanes->lightSpecular.get<Vec3>(i), lit.specular, i);

        const BsdfSample sample = bsdf.sample(lanes->lobeX[i], {lanes->bsdfX[i], lanes->bsdfY[i]});
        if (lanes->next[i] == PlainLanes::kEnds) {
            EXPECT_TRUE(sample.lobe == Lobe::None || isBlack(sample.weight)) << "lane " << i;
            ++ends;
            continue;
        }
        deltas += lanes->next[i] == PlainLanes::kMirrors;
        EXPECT_EQ(lanes->next[i] == PlainLanes::kMirrors, sample.delta);
        EXPECT_EQ(lanes->next[i] == PlainLanes::kDiffuse, sample.lobe == Lobe::Diffuse);
        const float pdf = sample.delta ? 0 : sample.pdf;
        ASSERT_NEAR(lanes->pdf[i], pdf, 1e-3f * pdf) << "lane " << i;
        expectNear(lanes->weight.get<Vec3>(i), sample.weight, i);
        expectNear(lanes->nextDirection.get<Vec3>(i), frame.toWorld(sample.wi), i);
    }
    EXPECT_GT(deltas, 5);
    EXPECT_LT(ends, kLanes / 4);
}

TEST(PlainKernels, SameBytesOnEveryInstructionSet) {
    std::vector<BsdfInputs> materials;
    const auto expected = makeLanes(materials);
    run(baseline::plainLobeTable(), *expected);
    const auto check = [&](const PlainLobeKernels& kernels) {
        std::vector<BsdfInputs> again;
        const auto lanes = makeLanes(again);
        run(kernels, *lanes);
        EXPECT_EQ(std::memcmp(lanes.get(), expected.get(), sizeof(PlainLanes)), 0);
    };
    if (detectIsa() >= Isa::V3) check(v3::plainLobeTable());
    if (detectIsa() >= Isa::V4) check(v4::plainLobeTable());
}

std::unique_ptr<PlainLanes> diffuseLanes(const PlainLobeKernels& kernels) {
    std::vector<BsdfInputs> materials;
    auto lanes = makeLanes(materials);
    for (int i = 0; i < kLanes; ++i) {
        lanes->metallic[i] = lanes->specular[i] = 0;
        if (i % 9 == 0) lanes->baseColor.set(i, Vec3(0));
        if (i % 13 == 0) lanes->lobes[i] = PlainLanes::kSpecularLobe;
    }
    run(kernels, *lanes);
    return lanes;
}

/// A path may be shaded beside glossy ones or among diffuse ones alone: it may not matter which.
TEST(PlainKernels, DiffuseLanesHaveTheBitsOfGeneralOnes) {
    const auto expectSame = [](const PlainLobeKernels& general, const PlainLobeKernels& diffuse) {
        const auto a = diffuseLanes(general), b = diffuseLanes(diffuse);
        const auto same = [](const auto& x, const auto& y) { return std::memcmp(&x, &y, sizeof(float) * kLanes) == 0; };
        const auto same3 = [&](const PlainLanes::Column3& x, const PlainLanes::Column3& y) {
            return same(x.x, y.x) && same(x.y, y.y) && same(x.z, y.z);
        };
        EXPECT_TRUE(same3(a->start, b->start));
        EXPECT_TRUE(same3(a->diffuseAlbedo, b->diffuseAlbedo));
        EXPECT_TRUE(same3(a->specularAlbedo, b->specularAlbedo));
        EXPECT_TRUE(same3(a->lightDiffuse, b->lightDiffuse));
        EXPECT_TRUE(same3(a->lightSpecular, b->lightSpecular));
        EXPECT_TRUE(same3(a->lightContribution, b->lightContribution));
        EXPECT_TRUE(same3(a->shadowDirection, b->shadowDirection));
        EXPECT_TRUE(same(a->shadowLength, b->shadowLength));
        EXPECT_TRUE(same(a->lightValid, b->lightValid));
        int goOn = 0;
        for (int i = 0; i < kLanes; ++i) {
            ASSERT_EQ(a->next[i], b->next[i]) << i;
            if (a->next[i] == PlainLanes::kEnds) continue;
            ++goOn;
            EXPECT_EQ(a->nextDirection.get<Vec3>(i), b->nextDirection.get<Vec3>(i)) << i;
            EXPECT_EQ(a->weight.get<Vec3>(i), b->weight.get<Vec3>(i)) << i;
            EXPECT_EQ(a->diffuseShare.get<Vec3>(i), b->diffuseShare.get<Vec3>(i)) << i;
            EXPECT_EQ(a->pdf[i], b->pdf[i]) << i;
        }
        EXPECT_GT(goOn, kLanes / 2);
    };
    expectSame(baseline::plainLobeTable(), baseline::plainDiffuseTable());
    if (detectIsa() >= Isa::V3) expectSame(v3::plainLobeTable(), v3::plainDiffuseTable());
    if (detectIsa() >= Isa::V4) expectSame(v4::plainLobeTable(), v4::plainDiffuseTable());
}

TEST(SamplerKernels, AreTheStreamsNumbers) {
    const auto check = [](const SamplerKernels& kernels) {
        uint32_t scramble[kLanes], index[kLanes];
        uint64_t seeds[kLanes];
        float x[kLanes], y[kLanes], alone[kLanes];
        std::vector<SampleStream> streams;
        for (uint32_t i = 0; i < kLanes; ++i) {
            streams.emplace_back(SamplerKind::Sobol, 16, 3u, RandomKey{i, 2 * i, 37 * i});
            scramble[i] = streams.back().scramble(), index[i] = streams.back().index();
        }
        for (const uint32_t pair : {0u, 4u, 17u}) {
            kernels.pairs(scramble, index, kLanes, pair, seeds, x, y);
            kernels.pairs(scramble, index, kLanes, pair, seeds, alone, nullptr);
            for (size_t i = 0; i < kLanes; ++i) {
                const Vec2 expected = streams[i].get2(2 * pair);
                ASSERT_EQ(x[i], expected.x);
                ASSERT_EQ(y[i], expected.y);
                ASSERT_EQ(alone[i], expected.x);
            }
        }
    };
    check(baseline::samplerTable());
    if (detectIsa() >= Isa::V3) check(v3::samplerTable());
    if (detectIsa() >= Isa::V4) check(v4::samplerTable());
}

TEST(TextureView, LooksUpWhatTheTextureHolds) {
    auto image = std::make_shared<TextureImage>();
    image->srgb = true;
    image->levels.push_back({{13, 8}, std::vector<uint8_t>(13 * 8 * 4), {}});
    Numbers u(3);
    for (uint8_t& byte : image->levels[0].bytes) byte = static_cast<uint8_t>(255.99f * u.next());
    buildMips(*image);
    for (const Wrap wrap : {Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge}) {
        Texture texture;
        texture.image = image;
        texture.wrapU = texture.wrapV = wrap;
        texture.scale = {2, 0.5f}, texture.offset = {0.3f, -0.2f}, texture.rotation = 0.4f;
        const TextureView view = makeTextureView(texture);
        for (int i = 0; i < 2000; ++i) {
            const Vec2 uv = 8.0f * u.next2() - Vec2(4);
            const float width = 0.3f * u.next() * u.next();
            const Vec4 nearest = blend(view, findTaps(view, uv.x, uv.y, width));
            float fraction = 0;
            const TexelTaps fine = findTaps(view, uv.x, uv.y, width, &fraction);
            const Vec4 a = blend(view, fine), b = blend(view, coarser(view, uv.x, uv.y, fine.level));
            for (int c = 0; c < 4; ++c) {
                ASSERT_NEAR(nearest[c], texture.sampleNearestLevel(uv, width)[c], 2e-4f);
                ASSERT_NEAR(a[c] + (b[c] - a[c]) * fraction, texture.sample(uv, width)[c], 2e-4f);
            }
        }
        for (const Vec2 far : {Vec2(NAN, kInfinity), Vec2(1e12f, -1e12f), Vec2(3e38f, 16777217.0f)}) {
            EXPECT_TRUE(isFinite(Vec3(blend(view, findTaps(view, far.x, far.y, 0.1f)))));
            EXPECT_TRUE(isFinite(Vec3(texture.sample(far, 0.1f))));
        }
    }
}

}  // namespace lumi
