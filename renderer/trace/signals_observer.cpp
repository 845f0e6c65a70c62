#include "trace/signals_observer.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "frame/motion.h"
#include "frame/stored_albedo.h"
#include "trace/surface.h"

namespace lumi {
namespace {

const SignalSet kDemodulated{Signal::DirectDiffuse, Signal::IndirectDiffuse, Signal::DirectSpecular,
                             Signal::IndirectSpecular};
const SignalSet kSplit = kDemodulated | SignalSet{Signal::Emission, Signal::Direct, Signal::Indirect};
const SignalSet kFirstVertex{Signal::Visibility, Signal::Albedo, Signal::SpecularAlbedo};
const SignalSet kGeometry{Signal::Normal,       Signal::GeometricNormal, Signal::ObjectNormal, Signal::Depth,
                          Signal::InverseDepth, Signal::DepthGradient,   Signal::Position,     Signal::Motion,
                          Signal::Roughness,    Signal::ObjectId,        Signal::MaterialId,   Signal::Surface};

}  // namespace

bool isGeometryOnly(SignalSet signals) { return kGeometry.contains(signals); }

SignalSet withDependencies(SignalSet wanted) {
    if (wanted.hasAny(kDemodulated)) wanted |= SignalSet{Signal::Albedo, Signal::SpecularAlbedo};
    return wanted;
}

SignalsObserver::SignalsObserver(const TraceScene& scene, const FrameSampling& sampling, Signals& signals)
    : scene_(scene), sampling_(sampling), signals_(signals), wanted_(signals.available()) {
    split_ = wanted_.hasAny(kSplit);
    geometry_ = wanted_.hasAny(kGeometry);
    albedos_ = wanted_.has(Signal::Albedo) || wanted_.has(Signal::SpecularAlbedo);
    const bool first = geometry_ || wanted_.hasAny(kFirstVertex);
    needs_.vertexDepths = split_ ? ObserverNeeds::kAll : first ? 1 : 0;
    needs_.albedoDepths = albedos_ ? 1 : 0;
    needs_.normalDepths = wanted_.has(Signal::ObjectNormal) ? 1 : 0;
    needs_.shareDepths = split_ ? 1 : 0;
    radianceOnly_ = needs_.vertexDepths == 0 && sampling.samplesPerPixel == 1 && !wanted_.has(Signal::SampleVariance);
    columns_ = (sampling.extent.width + kTile - 1) / kTile;
    rows_ = (sampling.extent.height + kTile - 1) / kTile;
    tiles_.resize(static_cast<size_t>(columns_) * static_cast<size_t>(rows_));
}

void SignalsObserver::beginTile(int tile) {
    std::unique_ptr<TileSums> sums;
    {
        std::lock_guard lock(mutex_);
        if (!spare_.empty()) {
            sums = std::move(spare_.back());
            spare_.pop_back();
        }
    }
    if (!sums) sums = std::make_unique<TileSums>();
    // Without vertices only the radiance is written, by finished().
    if (needs_.vertexDepths > 0) sums->pixels.assign(kTile * kTile, PixelSums());
    else if (!radianceOnly_) sums->pixels.resize(kTile * kTile);
    if (sampling_.samplesPerPixel > 1) {
        sums->radiance.resize(kTile * kTile);
        for (auto& sum : sums->radiance) sum.clear();
        if (wanted_.has(Signal::SampleVariance)) sums->moments.assign(kTile * kTile, {});
    }
    tiles_[static_cast<size_t>(tile)] = std::move(sums);
}

SignalsObserver::PixelSums& SignalsObserver::sumsOf(uint32_t slot, size_t& local, TileSums*& tile) {
    const int width = sampling_.extent.width;
    const int x = static_cast<int>(slot) % width, y = static_cast<int>(slot) / width;
    tile = tiles_[static_cast<size_t>(y / kTile * columns_ + x / kTile)].get();
    local = static_cast<size_t>(y % kTile * kTile + x % kTile);
    return tile->pixels[local];
}

void SignalsObserver::bounce(const BounceBatch& batch) {
    for (size_t i = 0; i < batch.slots.size(); ++i) {
        const PathVertex& v = batch.vertices[i];
        size_t local = 0;
        TileSums* tile = nullptr;
        PixelSums& sums = sumsOf(batch.slots[i], local, tile);
        const Vec3 emitted = v.throughput * v.emitted;
        const Vec3 diffuse = v.throughput * v.directDiffuse, specular = v.throughput * v.directSpecular;
        if (batch.depth == 0) {
            if (geometry_ && batch.samples[i] == static_cast<uint32_t>(sampling_.firstSample)) {
                if (v.point.valid()) writeGeometry(batch.slots[i], v);
                else writeSky(batch.slots[i], v);
            }
            const bool sky = !v.point.valid();
            sums.albedo += sky ? Vec3(1) : v.albedo;
            sums.specularAlbedo += sky ? Vec3(1) : v.specularAlbedo;
            sums.lightSamples += v.lightSampled;
            sums.lightsSeen += v.lightVisible;
            sums.share = v.diffuseShare;
            sums.emission += emitted;
            sums.directDiffuse += diffuse;
            sums.directSpecular += specular;
            continue;
        }
        const Vec3 share = sums.share, rest = Vec3(1) - share;
        Vec3 beyond = diffuse + specular;
        if (batch.depth == 1) {
            sums.directDiffuse += emitted * share;
            sums.directSpecular += emitted * rest;
        } else {
            beyond += emitted;
        }
        sums.indirectDiffuse += beyond * share;
        sums.indirectSpecular += beyond * rest;
    }
}

void SignalsObserver::finished(std::span<const uint32_t> slots, std::span<const uint32_t> samples,
                               std::span<const Vec3> radiance) {
    if (radianceOnly_) return writeRadiance(slots, radiance);
    for (size_t i = 0; i < slots.size(); ++i) {
        size_t local = 0;
        TileSums* tile = nullptr;
        PixelSums& sums = sumsOf(slots[i], local, tile);
        sums.radiance = radiance[i];
        if (tile->radiance.empty()) continue;
        tile->radiance[local].add(sampling_.firstSample + (samples[i] - static_cast<uint32_t>(sampling_.firstSample)),
                                  Colour(radiance[i]));
        if (tile->moments.empty()) continue;
        for (int c = 0; c < 3; ++c) tile->moments[local][static_cast<size_t>(c)].add(radiance[i][c]);
    }
}

/// A slot is its pixel's place in a plane.
void SignalsObserver::writeRadiance(std::span<const uint32_t> slots, std::span<const Vec3> radiance) {
    if (!wanted_.has(Signal::Noisy)) return;
    for (int c = 0; c < 3; ++c) {
        float* noisy = signals_[Signal::Noisy].plane(c).data;
        double* sums = signals_.noisySum().plane(c).data;
        for (size_t i = 0; i < slots.size(); ++i) sums[slots[i]] = noisy[slots[i]] = radiance[i][c];
    }
}

void SignalsObserver::set3(Signal signal, int x, int y, const Vec3& value) {
    if (!wanted_.has(signal)) return;
    Image& image = signals_[signal];
    for (int c = 0; c < 3; ++c) image.at(c, x, y) = value[c];
}

void SignalsObserver::writeGeometry(uint32_t slot, const PathVertex& v) {
    const int width = sampling_.extent.width;
    const int x = static_cast<int>(slot) % width, y = static_cast<int>(slot) / width;
    const CameraPose moved = sampling_.cameraTrack.empty() ? CameraPose() : sampling_.cameraAt(v.point.time);
    const CameraPose& camera = sampling_.cameraTrack.empty() ? sampling_.camera : moved;
    set3(Signal::Normal, x, y, v.normal);
    set3(Signal::GeometricNormal, x, y, v.geometricNormal);
    set3(Signal::ObjectNormal, x, y, v.objectNormal);
    set3(Signal::Position, x, y, v.position);
    const float depth = -transformPoint(camera.cameraFromWorld, v.position).z;
    if (wanted_.has(Signal::Depth)) signals_[Signal::Depth].at(0, x, y) = depth;
    if (wanted_.has(Signal::InverseDepth)) signals_[Signal::InverseDepth].at(0, x, y) = 1 / depth;
    if (wanted_.has(Signal::DepthGradient)) {
        const Vec2 gradient = inverseDepthGradient(camera, v.position, v.geometricNormal);
        signals_[Signal::DepthGradient].at(0, x, y) = gradient.x;
        signals_[Signal::DepthGradient].at(1, x, y) = gradient.y;
    }
    if (wanted_.has(Signal::Motion))
        set3(Signal::Motion, x, y,
             surfaceMotion(camera, sampling_.previousCameraAt(v.point.time), v.position,
                           previousSurfacePosition(scene_.tables, *scene_.posed, v.point)));
    if (wanted_.has(Signal::Roughness)) signals_[Signal::Roughness].at(0, x, y) = v.roughness;
    if (wanted_.has(Signal::ObjectId)) signals_.ids(Signal::ObjectId).at(0, x, y) = v.point.instance + 1;
    if (wanted_.has(Signal::MaterialId)) signals_.ids(Signal::MaterialId).at(0, x, y) = v.material + 1;
    if (wanted_.has(Signal::Surface)) {
        IdImage& surface = signals_.ids(Signal::Surface);
        surface.at(0, x, y) = v.point.instance;
        surface.at(1, x, y) = v.point.primitive;
        surface.at(2, x, y) = std::bit_cast<uint32_t>(v.point.barycentrics.x);
        surface.at(3, x, y) = std::bit_cast<uint32_t>(v.point.barycentrics.y);
    }
}

void SignalsObserver::writeSky(uint32_t slot, const PathVertex& v) {
    const int width = sampling_.extent.width;
    const int x = static_cast<int>(slot) % width, y = static_cast<int>(slot) / width;
    for (const Signal s : {Signal::Normal, Signal::GeometricNormal, Signal::ObjectNormal, Signal::Position})
        set3(s, x, y, Vec3(0));
    if (wanted_.has(Signal::Depth)) signals_[Signal::Depth].at(0, x, y) = kInfinity;
    if (wanted_.has(Signal::InverseDepth)) signals_[Signal::InverseDepth].at(0, x, y) = 0;
    if (wanted_.has(Signal::DepthGradient))
        for (int c = 0; c < 2; ++c) signals_[Signal::DepthGradient].at(c, x, y) = 0;
    set3(Signal::Motion, x, y,
         skyMotion(sampling_.cameraAt(v.point.time), sampling_.previousCameraAt(v.point.time), -v.wo));
    if (wanted_.has(Signal::Roughness)) signals_[Signal::Roughness].at(0, x, y) = 1;
    if (wanted_.has(Signal::ObjectId)) signals_.ids(Signal::ObjectId).at(0, x, y) = 0;
    if (wanted_.has(Signal::MaterialId)) signals_.ids(Signal::MaterialId).at(0, x, y) = 0;
    if (wanted_.has(Signal::Surface)) {
        IdImage& surface = signals_.ids(Signal::Surface);
        surface.at(0, x, y) = kNoInstance;
        for (int c = 1; c < 4; ++c) surface.at(c, x, y) = 0;
    }
}

void SignalsObserver::writePixel(int x, int y, const TileSums& tile, size_t local) {
    const PixelSums& sums = tile.pixels[local];
    const double scale = 1.0 / sampling_.samplesPerPixel;
    const Colour radiance = tile.radiance.empty() ? sums.radiance : tile.radiance[local].total();
    if (wanted_.has(Signal::Noisy)) {
        set3(Signal::Noisy, x, y, Vec3(radiance * scale));
        for (int c = 0; c < 3; ++c) signals_.noisySum().at(c, x, y) = radiance[c];
    }
    if (wanted_.has(Signal::SampleVariance)) {
        Vec3 spread(0);
        if (!tile.moments.empty())
            for (int c = 0; c < 3; ++c)
                spread[c] = static_cast<float>(tile.moments[local][static_cast<size_t>(c)].sampleVariance());
        set3(Signal::SampleVariance, x, y, spread);
    }
    if (needs_.vertexDepths == 0) return;
    if (wanted_.has(Signal::Visibility))
        signals_[Signal::Visibility].at(0, x, y) =
            sums.lightSamples > 0 ? static_cast<float>(sums.lightsSeen) / static_cast<float>(sums.lightSamples) : 1.0f;

    set3(Signal::Emission, x, y, Vec3(sums.emission * scale));
    set3(Signal::Direct, x, y, Vec3((sums.directDiffuse + sums.directSpecular) * scale));
    set3(Signal::Indirect, x, y, Vec3((sums.indirectDiffuse + sums.indirectSpecular) * scale));
    if (!albedos_) return;
    // Demodulation, channel by channel; what is hardly reflected stays undivided.
    Vec3 albedo(sums.albedo * scale), specularAlbedo(sums.specularAlbedo * scale);
    for (int c = 0; c < 3; ++c) {
        if (albedo[c] >= 1 && specularAlbedo[c] >= 1) {  // together more than a surface can have: the sky
            albedo[c] = specularAlbedo[c] = 1;
            continue;
        }
        albedo[c] = storedAlbedo(albedo[c]);
        specularAlbedo[c] = storedAlbedo(specularAlbedo[c]);
    }
    set3(Signal::Albedo, x, y, albedo);
    set3(Signal::SpecularAlbedo, x, y, specularAlbedo);
    set3(Signal::DirectDiffuse, x, y, Vec3(sums.directDiffuse * scale / Colour(albedo)));
    set3(Signal::IndirectDiffuse, x, y, Vec3(sums.indirectDiffuse * scale / Colour(albedo)));
    set3(Signal::DirectSpecular, x, y, Vec3(sums.directSpecular * scale / Colour(specularAlbedo)));
    set3(Signal::IndirectSpecular, x, y, Vec3(sums.indirectSpecular * scale / Colour(specularAlbedo)));
}

void SignalsObserver::endTile(int index) {
    std::unique_ptr<TileSums> tile = std::move(tiles_[static_cast<size_t>(index)]);
    const int left = index % columns_ * kTile, top = index / columns_ * kTile;
    const int bottom = radianceOnly_ ? top : std::min(top + kTile, sampling_.extent.height);
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < std::min(left + kTile, sampling_.extent.width); ++x)
            writePixel(x, y, *tile, static_cast<size_t>((y - top) * kTile + (x - left)));
    std::lock_guard lock(mutex_);
    spare_.push_back(std::move(tile));
}

}  // namespace lumi
