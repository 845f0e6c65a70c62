#pragma once
#include <memory>
#include <mutex>
#include <vector>

#include "math/block_sum.h"
#include "math/statistics.h"
#include "trace/observer.h"
#include "trace/trace_scene.h"
#include "trace/tracer.h"

namespace lumi {

/// Writes a frame's Signals (frame/signals.h) from what the integrator reports. Slots are y * width + x; the frame is
/// made in square tiles, one thread a tile: beginTile(), all samples of its pixels in order, endTile().
///
/// The lighting split: emission found at the first vertex is emission; light sampled at the first vertex is direct
/// light of the lobe that scattered it; emission that the continued path finds at once is direct light too, and all
/// light from further on is indirect, both shared between the lobes as they share the path's weight at the first
/// vertex.
class SignalsObserver : public PathObserver {
public:
    static constexpr int kTile = 32;

    SignalsObserver(const TraceScene& scene, const FrameSampling& sampling, Signals& signals);

    ObserverNeeds needs() const override { return needs_; }
    void bounce(const BounceBatch& batch) override;
    void finished(std::span<const uint32_t> slots, std::span<const uint32_t> samples,
                  std::span<const Vec3> radiance) override;

    int tileColumns() const { return columns_; }
    int tileRows() const { return rows_; }
    void beginTile(int tile);
    void endTile(int tile);

private:
    using Colour = glm::dvec3;
    struct PixelSums {
        Colour radiance{0}, emission{0};
        Colour directDiffuse{0}, directSpecular{0}, indirectDiffuse{0}, indirectSpecular{0};
        Colour albedo{0}, specularAlbedo{0};
        uint32_t lightSamples = 0, lightsSeen = 0;
        Vec3 share{0};  ///< the present sample's diffuse share at its first vertex
    };
    struct TileSums {
        std::vector<PixelSums> pixels;
        std::vector<BlockSum<Colour, 48>> radiance;  ///< at more than one sample a pixel
        std::vector<std::array<RunningMoments, 3>> moments;
    };

    PixelSums& sumsOf(uint32_t slot, size_t& local, TileSums*& tile);
    void writeGeometry(uint32_t slot, const PathVertex& vertex);
    void writeSky(uint32_t slot, const PathVertex& vertex);
    void writePixel(int x, int y, const TileSums& tile, size_t local);
    void writeRadiance(std::span<const uint32_t> slots, std::span<const Vec3> radiance);
    void set3(Signal signal, int x, int y, const Vec3& value);

    const TraceScene& scene_;
    const FrameSampling& sampling_;
    Signals& signals_;
    const SignalSet wanted_;
    ObserverNeeds needs_;
    bool split_ = false, geometry_ = false, albedos_ = false;
    bool radianceOnly_ = false;  ///< one sample a pixel, and nothing else of it: finished() writes it
    int columns_ = 0, rows_ = 0;
    std::vector<std::unique_ptr<TileSums>> tiles_;  ///< of tiles in work
    std::mutex mutex_;
    std::vector<std::unique_ptr<TileSums>> spare_;
};

/// Does nothing of it need more than the surfaces that the camera sees?
bool isGeometryOnly(SignalSet signals);

/// `wanted` and what it depends on: demodulated light comes with its albedos.
SignalSet withDependencies(SignalSet wanted);

}  // namespace lumi
