#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/reference_command.h"
#include "app/reference_picture.h"
#include "base/error.h"
#include "base/files.h"
#include "params/json_text.h"
#include "reference/finished_reference.h"
#include "reference/reference_part.h"

namespace lumi {
namespace {

/// Parts may be called anything, but what comes out is an image or clearly another part.
bool writesPart(const MergeCommand& options) {
    const std::string extension = lowerExtension(options.out);
    if (extension == ".exr" || extension == ".png") return false;
    if (extension == ".lumiref") return true;
    for (const std::string& part : options.parts)
        if (lowerExtension(part) == extension) return true;
    throwUsage({"cannot write this kind of file", options.out, ".exr, .png or .lumiref", '"' + extension + '"'});
}

}  // namespace

int runMerge(const MergeCommand& options, const MachineOptions& machine) {
    const bool part = writesPart(options);
    const std::vector<std::filesystem::path> files(options.parts.begin(), options.parts.end());
    const ReferenceState state = mergeParts(files);
    const SampleRange range = state.blocks.range();
    nlohmann::json result = {{"first_sample", range.begin}, {"samples", range.count()}, {"files", {options.out}}};
    if (part) {
        writeReferenceFile(options.out, state);
    } else {
        if (range.begin != 0)
            throwBadInput({"the first samples are missing", options.parts.front(), "parts from sample 0 on",
                           fmt::format("{}..{}", range.begin, range.end)});
        const Reference reference = finishedReference(state);
        MessageLog log;
        ReferencePicture::parse(state.note, options.parts.front()).write(options.out, reference, "", nullptr).warn(log);
        for (const std::string& text : log.warnings())
            if (!machine.quiet) std::fputs(("warning: " + text + '\n').c_str(), stderr);
        result["error"] = std::isfinite(reference.error) ? nlohmann::json(reference.error) : nlohmann::json();
    }
    if (machine.json) std::puts(jsonText(result, 2).c_str());
    if (!machine.quiet)
        std::fputs(fmt::format("Wrote {}: samples {}..{}\n", options.out, range.begin, range.end).c_str(), stderr);
    return 0;
}

}  // namespace lumi
