#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "session/changes.h"
#include "session/session_impl.h"

namespace lumi {

void Session::Impl::stepBack(const Work& work) {
    const StateLog& before = work.states;
    if (before.size() < 2) return log.info("There is no earlier frame.");
    const size_t target = before.size() - 1 - std::min<size_t>(before.size() - 1, static_cast<size_t>(work.stepsBack));
    const size_t start = before.startOf(target);
    std::optional<FrameOutput> frame;
    StateLog::Entry reached;
    size_t done = 0;
    for (size_t i = start; i <= target; ++i, ++done) {
        {
            std::lock_guard lock(mutex);
            replayed = static_cast<float>(i - start) / static_cast<float>(target - start + 1);
        }
        StateLog::Entry entry = before.entry(i);
        const bool cut = i == start;
        std::optional<FrameOutput> next =
            engine.advance(i == target ? requestOf(work, *entry.document, entry.frame, cut)
                                       : FrameRequest{*entry.document, entry.frame, cut, {}, {}},
                           work.stop, work.sceneStop);
        if (!next) break;
        next->changes.cut = entry.cut;  // the log keeps what was, not that a replay begins with a cut
        next->historyDropped = entry.historyDropped;
        frame = std::move(next);
        reached = std::move(entry);
    }
    std::lock_guard lock(mutex);
    if (work.sceneNumber != sceneNumber) return;
    if (frame) {
        states.truncate(start + done);
        shown = std::move(*frame);
        shownDocument = reached.document;
        resting = shown.rests();
        completedMs.clear();
    }
    if (start + done <= target) giveUp(work);
    if (frame) {
        adoptSteppedBack(work);
    } else if (revision == work.revision) {
        ++revision;
        pending = std::max(pending, std::optional(Redo::Display));
    }
}

/// The document becomes that of the frame stepped back to; edits that came meanwhile stay on top of it. The caller
/// holds the lock.
void Session::Impl::adoptSteppedBack(const Work& work) {
    Document next = *shownDocument;
    if (revision != work.revision) {
        const nlohmann::json edits = Document::difference(*work.document, *document);
        try {
            next.apply(edits);
        } catch (const Error&) {  // a buffer of a module that was not there yet
            next = *document;
            if (!edits.contains("time")) next.setTime(shownDocument->time());
        }
    }
    nlohmann::json undone = Document::difference(*document, next);
    undone.erase("time");
    // What the frame stepped back to had not seen yet is a step of undo.
    if (!undone.empty()) history.begin(*document, "step-back"), history.end();
    document = next;
    ++revision;
    pending = std::max(pending, std::optional(worstDifference(*shownDocument, *document)));
}

}  // namespace lumi
