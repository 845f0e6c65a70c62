#pragma once
#include "app/window.h"
#include "session/session.h"
#include "ui/interface.h"

namespace lumi {

/// Opens what the options name, with their parameters.
void openAtStart(Session& session, AppState& state, const StartOptions& start);

/// Are the parameters that the options set those of the scene? It loads aside and leaves such failures in the log; a
/// program that was asked for something it cannot do ends instead.
class StartCheck {
public:
    StartCheck(const Session& session, const MessageLog& log, const StartOptions& start)
        : session_(session), log_(log), values_(start.set) {}
    /// To be called now and then, after openAtStart(); acts once, when the scene is there. Throws the first value's
    /// Error that names its option.
    void check();

private:
    const Session& session_;
    const MessageLog& log_;
    const std::vector<TypedValue> values_;
    bool done_ = false;
};

}  // namespace lumi
