#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "app/cli.h"
#include "base/messages.h"
#include "session/frame_engine.h"

namespace lumi {

/// What a `render` tells at its end, gathered frame by frame; frames of both eyes of a pair count.
class RenderSummary {
public:
    void add(const FrameOutput& frame);
    /// Frames that were there already.
    void keep(int64_t frames) { kept_ += frames; }
    /// One JSON value on standard output if the machine's options ask for it; a few lines on standard error unless they
    /// ask for quiet.
    void print(const std::vector<std::string>& files, const MachineOptions& machine, MessageLog& log,
               double seconds) const;

private:
    int64_t frames_ = 0, kept_ = 0;
    uint64_t rays_ = 0, nonFinite_ = 0;
    double traceMs_ = 0;
    std::map<std::string, int64_t> dropped_;     ///< over all frames, by instance
    std::map<std::string, size_t> moduleBytes_;  ///< after the last frame, by instance
    int64_t pixels_ = 1;
    std::map<std::string, std::vector<double>> stages_;
    std::vector<std::string> order_;
};

}  // namespace lumi
