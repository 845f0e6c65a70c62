#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "session/session_impl.h"

namespace lumi {
namespace {

/// How a state names the scene: a built-in scene by its name, others by their path.
std::string referenceName(const std::filesystem::path& path) {
    for (const SceneEntry& entry : listScenes()) {
        std::error_code failure;
        if (std::filesystem::equivalent(entry.path, path, failure)) return entry.name;
    }
    return path.string();
}

/// Values that the new document takes over from the one before: how things are shown and traced, not what is there.
bool outlivesScene(const std::string& id) {
    for (const std::string head : {"path.", "sampler.", "render.spp", "view.layout"})
        if (id.compare(0, head.size(), head) == 0) return true;
    return false;
}

/// The scene's own size, made smaller to be drawn several times a second; the aspect stays.
void takeInteractiveSize(Document& document) {
    constexpr double kPixels = 640 * 360;
    const RenderSettings& render = document.render();
    const double scale = std::sqrt(kPixels / (static_cast<double>(render.width) * render.height));
    if (scale >= 1) return;
    const int width = static_cast<int>(std::lround(render.width * scale)),
              height = static_cast<int>(std::lround(render.height * scale));
    document.set("render.width", std::max(width, 1));
    document.set("render.height", std::max(height, 1));
}

/// The document of a new scene, with what outlives the one before, then what was asked for, and without what is to be
/// as the scene has it; refusals go to `log`.
void prepare(Document& next, const std::optional<Document>& before,
             const std::vector<std::pair<std::string, std::string>>& wanted, const std::vector<std::string>& reset,
             MessageLog& log) {
    takeInteractiveSize(next);
    if (before) {
        const nlohmann::json kept = before->changedValues();
        for (const auto& [id, value] : kept.items())
            if (outlivesScene(id)) next.apply({{id, value}});
    }
    for (const auto& [id, text] : wanted) {
        try {
            next.setText(id, text);
        } catch (const Error& error) {
            log.error(error.what());
        }
    }
    for (const std::string& id : reset) {
        if (id.compare(0, 6, "scene.") == 0) continue;
        try {
            next.reset({id});
        } catch (const Error&) {  // it went with the scene before
        }
    }
}

}  // namespace

void Session::Impl::runAside(std::function<void(std::stop_token)> body) {
    reapThreads(false);
    std::lock_guard lock(asideMutex);
    Aside& aside = asides.emplace_back();
    aside.thread = std::jthread([&aside, body = std::move(body)](std::stop_token stop) {
        body(stop);
        aside.done = true;
    });
}

void Session::Impl::reapThreads(bool all) {
    std::list<Aside> finished;
    {
        std::lock_guard lock(asideMutex);
        for (auto aside = asides.begin(); aside != asides.end();) {
            const auto next = std::next(aside);
            if (all || aside->done) finished.splice(finished.end(), asides, aside);
            aside = next;
        }
    }
    // Their destructors join here, without the lock.
}

void Session::Impl::startLoading(const Origin& wanted, const std::vector<std::string>& reset) {
    uint64_t generation = 0;
    std::stop_token stop;
    {
        std::lock_guard lock(mutex);
        loadStop.request_stop();
        loadStop = std::stop_source();
        stop = loadStop.get_token();
        generation = ++loadGeneration;
        loading = {true, 0, "opening", wanted.path.string()};
    }
    runAside([this, wanted, reset, generation, stop](std::stop_token) { load(wanted, reset, generation, stop); });
}

void Session::Impl::load(const Origin& wanted, const std::vector<std::string>& reset, uint64_t generation,
                         std::stop_token stop) {
    LoadOptions options;
    options.choice = wanted.choice;
    options.stop = stop;
    options.progress = [this, generation](float fraction, const std::string& step) {
        std::lock_guard lock(mutex);
        if (generation == loadGeneration) loading.fraction = fraction, loading.step = step;
    };
    std::optional<Document> loaded;
    std::string failure;
    try {
        const auto scene = loadScene(wanted.path, log, options);
        loaded.emplace(scene);
        loaded->set("scene.index", wanted.choice.index);
        loaded->set("scene.variant", wanted.choice.variant);
        loaded->set("scene.animation", wanted.choice.animation);
        std::unique_lock lock(mutex);
        const std::optional<Document> before = document;
        lock.unlock();
        prepare(*loaded, before, wanted.set, reset, log);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::Interrupted) failure = error.what();
    } catch (const std::exception& error) {
        failure = wanted.path.string() + ": " + error.what();
    }
    if (!failure.empty() && !stop.stop_requested()) log.error(failure);

    std::lock_guard lock(mutex);
    if (generation != loadGeneration) return;
    loading = {};
    if (!loaded || !failure.empty()) return;
    document = std::move(loaded);
    sceneStop.request_stop();
    sceneStop = std::stop_source();
    ++sceneNumber;
    ++environmentGeneration;
    origin = wanted;
    history.clear();
    states = StateLog({referenceName(wanted.path), document->loadedScene()->contentDigest});
    restartWanted = true;
    restartFrame = 0;
    guarded = false;
    signalCheck = nullptr;
    checkWanted = checkingScenes;
    msPerSample = 0;
    noteChange(Redo::Build);
}

void Session::Impl::loadEnvironment(const std::string& file, uint64_t generation) {
    runAside([this, file, generation](std::stop_token) {
        try {
            std::unique_lock lock(mutex);
            Document copy = requireDocument();
            lock.unlock();
            copy.set("environment.file", file);
            lock.lock();
            if (generation != environmentGeneration) return;  // another was asked for since
            history.begin(*document, "environment.file ");
            document->adoptSkyImage(copy);
            noteChange(Redo::Samples);
        } catch (const std::exception& error) {
            log.error(error.what());
        }
    });
}

}  // namespace lumi
