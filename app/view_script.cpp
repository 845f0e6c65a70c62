#include "app/view_script.h"

#include <array>
#include <sstream>

#include "base/error.h"
#include "base/files.h"

namespace lumi {

namespace {

struct Known {
    const char* command;
    int least, most;  ///< arguments; -1: any number
};
constexpr std::array kKnown{
    Known{"size", 2, 2},          Known{"scale", 1, 1},        Known{"mouse", 2, 2},
    Known{"hover", 1, -1},        Known{"press", 1, 1},        Known{"release", 1, 1},
    Known{"wheel", 1, 1},         Known{"click", 1, -1},       Known{"double-click", 1, -1},
    Known{"drag", 3, 3},          Known{"key", 1, 1},          Known{"hold", 1, 1},
    Known{"lift", 1, 1},          Known{"text", 1, -1},        Known{"drop", 1, -1},
    Known{"set", 2, -1},          Known{"pause", 1, 1},        Known{"wait-load", 0, 0},
    Known{"wait-shown", 0, 0},    Known{"wait-frames", 1, 1},  Known{"wait-frame", 1, 1},
    Known{"wait-signals", 0, 0},  Known{"wait-metrics", 0, 0}, Known{"wait-spp", 1, 1},
    Known{"wait-message", 1, -1}, Known{"shot", 1, -1},        Known{"dump-ui", 1, -1},
    Known{"dump-lineage", 1, -1},
};

void check(const ScriptLine& line) {
    std::vector<std::string> names;
    for (const Known& known : kKnown) {
        names.emplace_back(known.command);
        if (line.command != known.command) continue;
        const int count = static_cast<int>(line.arguments.size());
        if (count < known.least || (known.most >= 0 && count > known.most))
            throwBadInput({.what = '"' + line.command + "\" has the wrong number of arguments",
                           .where = line.where,
                           .expected = std::to_string(known.least) + (known.most < 0 ? " or more" : ""),
                           .found = std::to_string(count)});
        return;
    }
    const std::string nearest = nearestName(line.command, names);
    throwBadInput({.what = "unknown command \"" + line.command + '"' +
                           (nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"),
                   .where = line.where});
}

}  // namespace

std::vector<ScriptLine> parseViewScript(const std::string& text, const std::string& name) {
    std::vector<ScriptLine> lines;
    std::istringstream stream(text);
    std::string written;
    for (int number = 1; std::getline(stream, written); ++number) {
        ScriptLine line;
        line.where = name + ":" + std::to_string(number);
        std::istringstream words(written);
        if (!(words >> line.command) || line.command[0] == '#') continue;
        std::getline(words >> std::ws, line.rest);
        while (!line.rest.empty() && std::isspace(static_cast<unsigned char>(line.rest.back()))) line.rest.pop_back();
        std::istringstream arguments(line.rest);
        for (std::string argument; arguments >> argument;) line.arguments.push_back(argument);
        check(line);
        lines.push_back(std::move(line));
    }
    return lines;
}

std::vector<ScriptLine> readViewScript(const std::filesystem::path& path) {
    return parseViewScript(readTextFile(path), path.filename().string());
}

}  // namespace lumi
