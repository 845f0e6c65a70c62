#include "scene/obj/obj_text.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <utility>
#include <vector>

namespace lumi {
namespace {

constexpr std::string_view kSpace = " \t";

std::vector<std::string_view> wordsOf(std::string_view line) {
    std::vector<std::string_view> words;
    for (size_t at = line.find_first_not_of(kSpace); at != line.npos; at = line.find_first_not_of(kSpace, at)) {
        const size_t end = std::min(line.find_first_of(kSpace, at), line.size());
        words.push_back(line.substr(at, end - at));
        at = end;
    }
    return words;
}

bool isNumber(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    return code == std::errc() && end == word.data() + word.size();
}

/// Is the end of `line`, which continues what has `begun`, a comment? Behind names, a # is part of them.
bool endsInComment(std::string_view begun, std::string_view line) {
    constexpr std::string_view kNumeric[] = {"f", "l", "p", "v", "vt", "vn"};
    const std::string_view start = begun.empty() ? line : begun;
    const size_t begin = std::min(start.find_first_not_of(kSpace), start.size());
    const std::string_view kind = start.substr(begin, start.find_first_of(kSpace, begin) - begin);
    if (std::ranges::find(kNumeric, kind) != std::end(kNumeric)) return line.find('#') != line.npos;
    return begun.empty() && kind.starts_with('#');
}

/// Calls visit(line, result) for the whole lines of `text`, without their ends, to append what takes their place.
/// Comments end with their line.
template <class Visit>
std::string mapLines(std::string_view text, Visit&& visit) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    std::string result, whole;
    result.reserve(text.size() + 1);
    size_t continued = 0;
    while (!text.empty()) {
        const size_t end = std::min(text.find_first_of("\r\n"), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(end);
        text.remove_prefix(text.starts_with("\r\n") ? 2 : std::min<size_t>(1, text.size()));
        if (line.ends_with('\\') && !text.empty() && !endsInComment(whole, line)) {
            whole += line.substr(0, line.size() - 1);
            whole += ' ';
            ++continued;
            continue;
        }
        visit(continued > 0 ? std::string_view(whole += line) : line, result);
        result.append(continued + 1, '\n');
        whole.clear(), continued = 0;
    }
    return result;
}

/// A name as tinyobj takes it for one: spaces escaped.
std::string escaped(std::string_view name) {
    std::string result;
    for (const char c : name) {
        if (c == ' ' || c == '\t') result += '\\';
        result += c;
    }
    return result;
}

/// The rest of a line as one name of a file, with slashes; a backslash before a space means the space.
std::string nameOf(std::string_view words) {
    std::string name;
    for (size_t i = 0; i < words.size(); ++i) {
        if (words[i] != '\\') name += words[i];
        else if (i + 1 == words.size() || words[i + 1] != ' ') name += '/';
    }
    return name;
}

/// `names`: what follows the `mtllib`. The lines of several files end with a carriage return, so that line feeds count
/// the lines of the file.
void addMaterialFiles(std::string_view names, const std::function<bool(const std::string&)>& exists,
                      std::string& result) {
    const std::vector<std::string_view> words = wordsOf(names);
    if (words.empty()) return;
    const std::string whole =
        nameOf({words[0].data(), static_cast<size_t>(&words.back().back() + 1 - words[0].data())});
    if (exists(whole)) {
        result += "mtllib " + escaped(whole);
        return;
    }
    std::string name;
    const char* separator = "mtllib ";
    for (const std::string_view word : words) {
        if (word.starts_with('#')) break;
        name += word;
        if (word.ends_with('\\')) {
            name += ' ';
            continue;
        }
        result += separator + escaped(nameOf(name));
        separator = "\rmtllib ";
        name.clear();
    }
    if (!name.empty()) result += separator + escaped(nameOf(name.substr(0, name.size() - 1)));
}

/// How many words follow an option of a texture, at most; -1 for what is none.
int argumentsOf(std::string_view word) {
    constexpr std::pair<std::string_view, int> kOptions[] = {
        {"-blendu", 1},  {"-blendv", 1}, {"-bm", 1},     {"-boost", 1}, {"-cc", 1}, {"-clamp", 1}, {"-colorspace", 1},
        {"-imfchan", 1}, {"-mm", 2},     {"-texres", 1}, {"-type", 1},  {"-o", 3},  {"-s", 3},     {"-t", 3}};
    for (const auto& [option, count] : kOptions)
        if (word == option) return count;
    return -1;
}

void addTexture(std::string_view line, std::string& result) {
    const std::vector<std::string_view> words = wordsOf(line);
    result += words[0];
    size_t i = 1;
    for (int arguments = 0; i < words.size() && (arguments = argumentsOf(words[i])) >= 0;) {
        const std::string_view option = words[i++];
        const bool kept = option != "-cc";
        if (kept) result += ' ', result += option;
        for (int k = 0; k < arguments; ++k) {
            const bool there = i < words.size() && (arguments < 3 || isNumber(words[i]));
            const std::string_view word = there ? words[i++] : option == "-s" ? "1" : "0";
            if (kept) result += ' ', result += word;
        }
    }
    if (i >= words.size()) return;
    result += ' ';
    result += line.substr(static_cast<size_t>(words[i].data() - line.data()));
}

}  // namespace

std::string plainObj(std::string_view text, const std::function<bool(const std::string&)>& exists) {
    return mapLines(text, [&](std::string_view line, std::string& result) {
        constexpr std::string_view kKeyword = "mtllib";
        const std::string_view begun = line.substr(std::min(line.find_first_not_of(kSpace), line.size()));
        const bool named = begun.starts_with(kKeyword) && begun.find_first_of(kSpace) == kKeyword.size();
        if (named) addMaterialFiles(begun.substr(kKeyword.size()), exists, result);
        else result += line;
    });
}

std::string plainMtl(std::string_view text) {
    constexpr std::string_view kColours[] = {"Ka", "Kd", "Ks", "Ke", "Tf"};
    return mapLines(text, [&](std::string_view line, std::string& result) {
        const std::vector<std::string_view> words = wordsOf(line);
        const auto begins = [&](const auto& names) {
            return words.size() >= 2 && std::find(std::begin(names), std::end(names), words[0]) != std::end(names);
        };
        constexpr std::string_view kTextures[] = {"bump", "disp", "norm", "refl"};
        if (begins(kColours) && isNumber(words[1]) && (words.size() == 2 || words[2].starts_with('#'))) {
            result += words[0];
            for (int c = 0; c < 3; ++c) result += ' ', result += words[1];
        } else if (begins(kTextures) || (words.size() >= 2 && words[0].starts_with("map_"))) {
            addTexture(line, result);
        } else {
            result += line;
        }
    });
}

}  // namespace lumi
