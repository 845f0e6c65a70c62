#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "base/messages.h"
#include "image/image.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "trace/settings.h"

namespace lumi {

/// Everything that determines a converged image, but for the number of samples. session/reference_spec.h makes one of
/// a Document.
struct ReferenceSpec {
    std::shared_ptr<const Scene> scene;
    std::string sceneKey;   ///< tells scenes apart: content digest, and edits to it as text
    float time = 0;         ///< seconds
    float openSeconds = 0;  ///< that the shutter is open from then on
    CameraPose camera;
    CameraTrack cameraTrack;  ///< over the open shutter; empty: the camera stands still
    PathSettings path;
    uint32_t seed = 0;
    Jitter jitter = Jitter::PerPixel;  ///< not Auto
};

/// How far to converge: to a number of samples a pixel, or to an error.
struct ReferenceGoal {
    uint64_t samples = 1024;
    /// Above 0: instead of to `samples`, to the first number of samples of a fixed ladder (four steps an octave, from
    /// 256 on) at which Reference::error is at most this.
    double error = 0;

    static constexpr uint64_t kMostSamples = 65536;  ///< of either kind
};

/// What makeReference() is doing, for a progress bar.
struct ReferenceProgress {
    uint64_t samples = 0, target = 0;  ///< a pixel; `target` is 0 while it is unknown
    uint64_t resumed = 0;              ///< samples that were there before
    double error = 0;                  ///< present estimate; 0 while unknown
    bool waiting = false;              ///< another process makes the same reference
};

class BlockTeam;

struct ReferenceOptions {
    /// Where references are kept; empty: nothing is kept. See defaultReferenceCache().
    std::filesystem::path cache;
    MessageLog* log = nullptr;  ///< damaged and foreign cache files are named here
    std::function<void(const ReferenceProgress&)>
        progress{};  ///< called after every block of samples, on the calling thread
    std::stop_token stop{};
    BlockTeam* team = nullptr;  ///< other processes that trace blocks of samples (block_team.h); null: this one alone
};

/// A converged image and what is known of its noise.
struct Reference {
    Image image;  ///< RGB, scene-linear: the mean of all samples
    /// Means of the first and of the second half of the samples (of each power-of-two block of them); empty below 32
    /// samples. Their errors have about the same size, so that half of their difference, in the mean over pixels, is
    /// the error of `image`; with Sobol samples rather more, since two halves together are better stratified than
    /// apart.
    Image halves[2];
    Image standardError;  ///< of each pixel's luminance, from 16 to 31 blocks of samples; empty below 256 samples
    Image depth;          ///< Z, linear view depth of each pixel's first sample; +inf on the sky
    uint64_t samples = 0;
    /// Relative standard error: root of the mean over pixels of (standard error)^2 / (luminance^2 + 0.001); NaN below
    /// 256 samples. relMSE adds three channels up, so the reference's own part in it is about three times the square.
    double error = 0;
    bool cached = false;         ///< nothing had to be traced
    std::filesystem::path file;  ///< where it is kept; empty without a cache
};

/// The reference from the cache, or traced from where the cache has come to, and kept there. The same spec and goal
/// give the same bits whatever was interrupted, resumed or done on how many threads; image equals the accumulate
/// module's mean of one frame of as many samples. Several processes may ask for one reference: one traces, the others
/// wait. Throws Error(Interrupted) if stopped, Error(Resources) if it does not fit the memory limit or the disk is
/// full; what is done so far is kept. After SIGKILL at most the last seconds are lost.
Reference makeReference(const ReferenceSpec& spec, const ReferenceGoal& goal, const ReferenceOptions& options);

/// `$XDG_CACHE_HOME/lumiscope/references`, else `~/.cache/lumiscope/references`; empty if neither is set.
std::filesystem::path defaultReferenceCache();

/// Name under which the cache keeps references of this spec: a digest of the spec, the instruction set in use, the
/// sources that the image depends on, and the compiler, its flags and the libraries.
std::string referenceKey(const ReferenceSpec& spec);

}  // namespace lumi
