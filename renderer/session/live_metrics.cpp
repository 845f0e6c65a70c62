#include "session/live_metrics.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "image/hdr.h"
#include "measure/map_range.h"

namespace lumi {
namespace {

constexpr size_t kMostPoints = 400;

void lowerPriority() {
    flushDenormals();
    setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), 10);
}

/// Values on which depends to what, and how, an image of the module converges.
std::string settingsOf(const Document& document, const std::string& module) {
    std::string text;
    for (const std::string& group :
         {module + ".", std::string("path."), std::string("sampler."), std::string("render.spp")})
        for (const ParameterInfo& info : document.list(group))
            text += info.id + '=' + formatParameter(info.value) + '\n';
    return text;
}

}  // namespace

/// A reference, and what it is one of; without a scene it came from a file.
struct LiveMetrics::Held {
    Image image;
    ReferenceSpec spec;
    bool asShown = false;  ///< a picture with its exposure in it
};

struct LiveMetrics::Made {
    std::shared_ptr<Held> held;
    ReferenceStatus status;
};

LiveMetrics::LiveMetrics(MessageLog& log) : log_(log) {
    thread_ = std::jthread([this](std::stop_token quit) { run(quit); });
}

LiveMetrics::~LiveMetrics() {
    stopMaking();
    thread_.request_stop();
    wake_.notify_all();
}

/// Asks what makes a reference to stop, and lets go of what has.
void LiveMetrics::stopMaking() {
    std::erase_if(makers_, [](const Maker& maker) { return maker.done.load(); });
    for (Maker& maker : makers_) maker.thread.request_stop();
}

/// Runs `make` aside; what it gives becomes the reference unless something else was asked for since. Never waits: a
/// thread that is to stop is joined when it has, or at the end.
void LiveMetrics::inBackground(std::function<Made(std::stop_token)> make) {
    uint64_t generation = 0;
    {
        std::lock_guard lock(mutex_);
        generation = ++generation_;
        status_.working = true;
        status_.progress = {};
    }
    stopMaking();
    Maker& maker = makers_.emplace_back();
    maker.thread = std::jthread([this, &maker, generation, make = std::move(make)](std::stop_token stop) {
        lowerPriority();
        std::optional<Made> made;
        try {
            made = make(stop);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::Interrupted) log_.error(error.what());
        } catch (const std::exception& error) {
            log_.error(std::string("the reference could not be made: ") + error.what());
        }
        {
            std::lock_guard lock(mutex_);
            if (generation == generation_) {
                if (made) adopt(std::move(*made));
                status_.working = false;
            }
        }
        maker.done = true;
    });
}

void LiveMetrics::loadReference(const std::filesystem::path& file) {
    inBackground([file](std::stop_token) {
        Made made{std::make_shared<Held>(), {}};
        made.held->image = loadImage(file);
        made.held->asShown = !isLinearFile(file);
        made.status.name = file.filename().string();
        return made;
    });
}

void LiveMetrics::makeReference(const Document& document, uint64_t samples) {
    inBackground([this, spec = referenceSpec(document), samples](std::stop_token stop) {
        ReferenceOptions options;
        options.cache = defaultReferenceCache();
        options.log = &log_;
        options.stop = stop;
        options.progress = [this, stop](const ReferenceProgress& progress) {
            std::lock_guard lock(mutex_);
            if (!stop.stop_requested()) status_.progress = progress;
        };
        Reference reference = lumi::makeReference(spec, {samples, 0}, options);
        Made made{std::make_shared<Held>(), {}};
        made.status.name = fmt::format("{} spp{}", reference.samples, reference.cached ? ", from the cache" : "");
        made.status.samples = reference.samples;
        made.status.error = reference.error > 0 ? reference.error : 0;
        made.held->image = std::move(reference.image);
        made.held->spec = spec;
        return made;
    });
}

/// The caller holds the lock.
void LiveMetrics::adopt(Made made) {
    status_ = std::move(made.status);
    status_.present = true;
    status_.extent = made.held->image.extent();
    status_.image = {made.held, &made.held->image};
    status_.asShown = made.held->asShown;
    reference_ = std::move(made.held);
    latest_ = nullptr;
    curves_ = nullptr;
    curvesOf_.clear();
    chosenAnew_ = true;
    wake_.notify_all();
}

void LiveMetrics::cancelReference() {
    stopMaking();
    std::lock_guard lock(mutex_);
    ++generation_;
    status_.working = false;
}

void LiveMetrics::clearReference() {
    cancelReference();
    std::lock_guard lock(mutex_);
    reference_ = nullptr;
    latest_ = nullptr;
    curves_ = nullptr;
    curvesOf_.clear();
    status_ = {};
}

ReferenceStatus LiveMetrics::reference() const {
    std::lock_guard lock(mutex_);
    return status_;
}

bool LiveMetrics::fits(const Snapshot& snapshot) const {
    std::lock_guard lock(mutex_);
    if (!reference_ || reference_->image.extent() != snapshot.extent) return false;
    const ReferenceSpec& spec = reference_->spec;
    return !spec.scene || (snapshot.document && isReferenceOf(spec, *snapshot.document));
}

void LiveMetrics::choose(std::vector<std::string> metrics, const std::string& map) {
    std::lock_guard lock(mutex_);
    if (metrics == metrics_ && map == map_) return;
    metrics_ = std::move(metrics);
    map_ = map;
    chosenAnew_ = true;
    wake_.notify_all();
}

void LiveMetrics::offer(std::shared_ptr<const Snapshot> snapshot) {
    std::lock_guard lock(mutex_);
    if (!snapshot || snapshot->preview || (offered_ && offered_->serial == snapshot->serial)) return;
    offered_ = std::move(snapshot);
    if (reference_) wake_.notify_all();
}

std::shared_ptr<const LiveMeasurement> LiveMetrics::latest() const {
    std::lock_guard lock(mutex_);
    return latest_;
}

std::shared_ptr<const ConvergenceCurves> LiveMetrics::curves() const {
    std::lock_guard lock(mutex_);
    return curves_;
}

bool LiveMetrics::hasWork() const {
    return reference_ && offered_ && (chosenAnew_ || !latest_ || latest_->serial != offered_->serial);
}

void LiveMetrics::run(std::stop_token quit) {
    lowerPriority();
    while (!quit.stop_requested()) {
        std::unique_lock lock(mutex_);
        wake_.wait(lock, quit, [this] { return hasWork(); });
        if (quit.stop_requested()) return;
        const auto snapshot = offered_;
        const auto reference = reference_;
        const auto metrics = metrics_;
        const std::string map = map_;
        chosenAnew_ = false;
        lock.unlock();
        auto measured = std::make_shared<LiveMeasurement>();
        try {
            if (fits(*snapshot)) *measured = measure(*snapshot, *reference, metrics, map);
            else
                measured->problem = reference->image.extent() == snapshot->extent
                                        ? "The reference is of another camera, time, scene or light transport."
                                        : fmt::format("The reference has {} x {} pixels, the picture {} x {}.",
                                                      reference->image.width(), reference->image.height(),
                                                      snapshot->extent.width, snapshot->extent.height);
        } catch (const std::exception& error) {  // an image or a map for which there is no memory
            measured->problem = std::string("Nothing could be measured: ") + error.what();
        }
        measured->serial = snapshot->serial;
        measured->samples = snapshot->accumulatedSamples;
        measured->frame = snapshot->frame;
        lock.lock();
        if (reference != reference_) continue;
        note(*measured);
        latest_ = std::move(measured);
    }
}

LiveMeasurement LiveMetrics::measure(const Snapshot& snapshot, const Held& reference,
                                     const std::vector<std::string>& metrics, const std::string& map) const {
    Timer timer;
    LiveMeasurement result;
    std::vector<Image> maps;
    for (const PaneSnapshot& shownPane : snapshot.panes) {
        PaneMeasurement& pane = result.panes.emplace_back();
        pane.module = shownPane.module;
        pane.settings = settingsOf(*snapshot.document, shownPane.module);
        const auto image = snapshot.results.find(shownPane.module);
        if (image == snapshot.results.end() || image->second->extent() != reference.image.extent()) continue;
        ImagePair pair;
        pair.image = *image->second;
        pair.reference = reference.image;
        pair.exposureEv = snapshot.scene->scene->render.exposureEv;
        if (reference.asShown) takeBackExposure(pair.reference, pair.exposureEv);
        pair.prepare();
        pane.nonFinitePixels = pair.nonFinitePixels;
        for (const std::string& id : metrics) {
            const Measurement measured = findMetric(id).measure(pair, false);
            pane.values[id] = measured.value;
            if (!measured.reason.empty()) pane.reasons[id] = measured.reason;
        }
        if (!map.empty()) maps.push_back(findMetric(map).measure(pair, true).map);
    }
    if (!map.empty() && maps.size() == result.panes.size()) showMaps(findMetric(map), maps, result.panes);
    result.ms = timer.elapsedMs();
    return result;
}

/// Adds a point to each pane's curve; the caller holds the lock. Where samples go back, or something else converges, a
/// curve begins again.
void LiveMetrics::note(const LiveMeasurement& measurement) {
    if (!measurement.problem.empty()) return;
    auto curves = curves_ ? std::make_shared<ConvergenceCurves>(*curves_) : std::make_shared<ConvergenceCurves>();
    curves->resize(measurement.panes.size());
    curvesOf_.resize(measurement.panes.size());
    for (size_t i = 0; i < measurement.panes.size(); ++i) {
        std::vector<ConvergencePoint>& curve = (*curves)[i];
        const std::string now = measurement.panes[i].module + '\n' + measurement.panes[i].settings;
        if (curvesOf_[i] != now || (!curve.empty() && curve.back().samples > measurement.samples)) curve.clear();
        curvesOf_[i] = now;
        if (!curve.empty() && curve.back().samples == measurement.samples) curve.pop_back();
        curve.push_back({measurement.samples, measurement.panes[i].values});
        if (curve.size() <= kMostPoints) continue;
        // On logarithmic axes early points say more: of the later half every second one goes.
        std::vector<ConvergencePoint> thinned(curve.begin(), curve.begin() + kMostPoints / 2);
        for (size_t k = kMostPoints / 2; k < curve.size(); k += 2) thinned.push_back(curve[k]);
        curve = std::move(thinned);
    }
    curves_ = std::move(curves);
}

void showMaps(const Metric& metric, const std::vector<Image>& maps, std::vector<PaneMeasurement>& panes) {
    MapRange range(metric);
    for (const Image& map : maps) range.add(map);
    for (size_t i = 0; i < maps.size(); ++i) {
        if (maps[i].empty()) continue;
        auto pixels = std::make_shared<Image8>();
        panes[i].mapInfo = convert(maps[i], "Y", "none", range.display(), *pixels);
        panes[i].map = std::move(pixels);
    }
}

}  // namespace lumi
