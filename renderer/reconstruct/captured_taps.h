#pragma once
#include <map>
#include <string>

#include "reconstruct/module.h"

namespace lumi {

/// The tap of those who drop what is no number.
inline Tap droppedTap() {
    return {.name = "dropped",
            .channels = "Y",
            .range = ValueRange{0, 1},
            .colourMap = "magma",
            .help = "1 where a value of the input was NaN or infinite and was dropped"};
}

/// The taps of a module's last completed run. Those of a run that is under way become visible when it is complete.
class CapturedTaps {
public:
    explicit CapturedTaps(std::vector<Tap> declared) : declared_(std::move(declared)) {}
    std::span<const Tap> declared() const { return declared_; }

    void begin(const TapSet& wanted) {
        wanted_ = &wanted;
        pending_.clear();
    }
    bool wants(const std::string& name) const { return wanted_->count(name) > 0; }
    /// Where a wanted tap is to be written; null for one that nobody wants.
    Image* target(const std::string& name) { return wants(name) ? &pending_[name] : nullptr; }
    void keep(const std::string& name, const Image& image) {
        if (wants(name)) pending_[name] = image;
    }
    void commit() {
        shown_.swap(pending_);
        pending_.clear();
    }
    void clear() {
        pending_.clear();
        shown_.clear();
    }
    /// Null if it was not wanted.
    const Image* find(const std::string& name) const {
        const auto found = shown_.find(name);
        return found == shown_.end() ? nullptr : &found->second;
    }
    size_t bytes() const {
        size_t sum = 0;
        for (const auto& entry : shown_) sum += entry.second.bytes();
        for (const auto& entry : pending_) sum += entry.second.bytes();
        return sum;
    }

private:
    std::vector<Tap> declared_;
    const TapSet* wanted_ = nullptr;
    std::map<std::string, Image> shown_, pending_;
};

}  // namespace lumi
