#include "scene/json_tree.h"

#include <fmt/format.h>
#include <rapidjson/error/error.h>
#include <rapidjson/memorystream.h>
#include <rapidjson/reader.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "base/memory.h"

namespace lumi {
namespace {

constexpr size_t kMaxDepth = 256;

/// Line and column of byte offsets that mostly ascend.
class PositionFinder {
public:
    explicit PositionFinder(std::string_view text) : text_(text) {}

    TextPosition at(size_t offset) {
        offset = std::min(offset, text_.size());
        if (offset < offset_) offset_ = 0, position_ = {};
        for (; offset_ < offset; ++offset_) {
            const auto byte = static_cast<unsigned char>(text_[offset_]);
            if (byte == '\n') ++position_.line, position_.column = 1;
            else if ((byte & 0xc0) != 0x80) ++position_.column;
        }
        return position_;
    }

private:
    std::string_view text_;
    size_t offset_ = 0;
    TextPosition position_;
};

/// Receives rapidjson's events, which come right after the token they stand for, and builds the tree.
class TreeBuilder {
public:
    using Ch = char;
    TreeBuilder(std::string_view text, const rapidjson::MemoryStream& stream, JsonTree& tree)
        : text_(text), stream_(stream), tree_(tree), positions_(text) {}

    bool Null() { return add(JsonValue::Type::Null, stream_.Tell() - 4); }
    bool Bool(bool value) {
        return add(JsonValue::Type::Boolean, stream_.Tell() - (value ? 4 : 5),
                   [&](JsonValue& v) { v.boolean = value; });
    }
    bool RawNumber(const char* token, rapidjson::SizeType length, bool) {
        return add(JsonValue::Type::Number, stream_.Tell() - length, [&](JsonValue& v) {
            v.text.assign(token, length);
            const auto [end, code] = std::from_chars(token, token + length, v.number);
            // Too small for a double is zero; too large is nothing that a scene could mean.
            if (code == std::errc::result_out_of_range && v.text.find("e-") == std::string::npos &&
                v.text.find("E-") == std::string::npos)
                refuse(v.at, "number is too large", v.text);
            if (code != std::errc() || !std::isfinite(v.number)) v.number = 0;
        });
    }
    bool String(const char* chars, rapidjson::SizeType length, bool) {
        return add(JsonValue::Type::String, openingQuote(), [&](JsonValue& v) { v.text.assign(chars, length); });
    }
    bool StartObject() { return open(JsonValue::Type::Object, '{'); }
    bool EndObject(rapidjson::SizeType) {
        refuseTwins(*open_.back());
        return close();
    }
    bool StartArray() { return open(JsonValue::Type::Array, '['); }
    bool EndArray(rapidjson::SizeType) { return close(); }

    bool Key(const char* chars, rapidjson::SizeType length, bool) {
        makeRoom(open_.back()->members);
        open_.back()->members.push_back({std::string(chars, length), positions_.at(openingQuote()), {}});
        return true;
    }

    // Numbers arrive as RawNumber only.
    bool Int(int) { return false; }
    bool Uint(unsigned) { return false; }
    bool Int64(int64_t) { return false; }
    bool Uint64(uint64_t) { return false; }
    bool Double(double) { return false; }

    [[noreturn]] void refuse(const TextPosition& at, const std::string& what, const std::string& found) const {
        throwBadInput({what, tree_.where(at), "", found});
    }
    TextPosition position(size_t offset) { return positions_.at(offset); }

private:
    /// Start of the string that ends where the stream is: the last quote that no odd run of backslashes escapes.
    size_t openingQuote() const {
        size_t i = stream_.Tell() - 2;
        for (;; --i) {
            if (text_[i] != '"') continue;
            size_t slashes = 0;
            while (slashes < i && text_[i - 1 - slashes] == '\\') ++slashes;
            if (slashes % 2 == 0) return i;
        }
    }

    void refuseTwins(const JsonValue& object) const {
        std::unordered_map<std::string_view, int> lines;
        for (const JsonMember& member : object.members) {
            const auto [first, isNew] = lines.emplace(member.key, member.at.line);
            if (!isNew)
                refuse(member.at, fmt::format("\"{}\" stands twice in one object", member.key),
                       fmt::format("the first in line {}", first->second));
        }
    }

    template <class Fill>
    bool add(JsonValue::Type type, size_t offset, const Fill& fill) {
        JsonValue& value = place();
        value.type = type;
        value.at = positions_.at(offset);
        fill(value);
        return true;
    }
    bool add(JsonValue::Type type, size_t offset) {
        return add(type, offset, [](JsonValue&) {});
    }
    bool open(JsonValue::Type type, char bracket) {
        const size_t here = stream_.Tell();
        const size_t offset = here > 0 && text_[here - 1] == bracket ? here - 1 : here;
        if (open_.size() >= kMaxDepth)
            refuse(positions_.at(offset), fmt::format("nested more than {} levels deep", kMaxDepth), "");
        JsonValue& value = place();
        value.type = type;
        value.at = positions_.at(offset);
        open_.push_back(&value);
        return true;
    }
    bool close() {
        open_.pop_back();
        return true;
    }
    /// Where the next value goes. Containers that are open do not grow while a child is open, so pointers hold.
    JsonValue& place() {
        if (open_.empty()) return tree_.root;
        JsonValue& parent = *open_.back();
        if (!parent.isArray()) return parent.members.back().value;
        makeRoom(parent.items);
        return parent.items.emplace_back();
    }
    /// For one more; the tree takes many times the bytes of its text.
    template <class Things>
    void makeRoom(Things& things) const {
        if (things.size() < things.capacity()) return;
        const size_t room = std::max<size_t>(2 * things.size(), 1);
        checkMemory("the JSON of " + tree_.file, room * sizeof(things[0]));
        things.reserve(room);
    }

    std::string_view text_;
    const rapidjson::MemoryStream& stream_;
    JsonTree& tree_;
    PositionFinder positions_;
    std::vector<JsonValue*> open_;
};

std::string explain(rapidjson::ParseErrorCode code) {
    switch (code) {
        case rapidjson::kParseErrorDocumentEmpty: return "file is empty; expected a JSON object";
        case rapidjson::kParseErrorDocumentRootNotSingular: return "more text after the end of the JSON value";
        case rapidjson::kParseErrorValueInvalid: return "not a JSON value";
        case rapidjson::kParseErrorObjectMissName: return "expected a key in quotes";
        case rapidjson::kParseErrorObjectMissColon: return "expected \":\" after the key";
        case rapidjson::kParseErrorObjectMissCommaOrCurlyBracket: return "expected \",\" or \"}\"";
        case rapidjson::kParseErrorArrayMissCommaOrSquareBracket: return "expected \",\" or \"]\"";
        case rapidjson::kParseErrorStringMissQuotationMark: return "string without closing quote";
        case rapidjson::kParseErrorStringInvalidEncoding: return "not valid UTF-8";
        case rapidjson::kParseErrorStringEscapeInvalid: return "unknown escape in a string";
        case rapidjson::kParseErrorStringUnicodeEscapeInvalidHex:
        case rapidjson::kParseErrorStringUnicodeSurrogateInvalid: return "broken \\u escape in a string";
        case rapidjson::kParseErrorNumberTooBig: return "number is too large";
        case rapidjson::kParseErrorNumberMissFraction: return "expected a digit after the decimal point";
        case rapidjson::kParseErrorNumberMissExponent: return "expected a digit in the exponent";
        default: return "not valid JSON";
    }
}

}  // namespace

std::string JsonValue::shown() const {
    switch (type) {
        case Type::Null: return "null";
        case Type::Boolean: return boolean ? "true" : "false";
        case Type::Number: return text;
        case Type::String: return '"' + text + '"';
        case Type::Array: return fmt::format("an array of {}", items.size());
        case Type::Object: return "an object";
    }
    return "";
}

std::string JsonTree::where(const TextPosition& at) const { return fmt::format("{}:{}:{}", file, at.line, at.column); }

JsonTree parseJsonTree(const std::string& text, const std::string& file) {
    JsonTree tree;
    tree.file = file;
    // A byte order mark is no part of the text.
    std::string_view body(text);
    if (body.starts_with("\xef\xbb\xbf")) body.remove_prefix(3);

    constexpr unsigned flags = rapidjson::kParseNumbersAsStringsFlag | rapidjson::kParseValidateEncodingFlag;
    rapidjson::MemoryStream stream(body.data(), body.size());
    TreeBuilder builder(body, stream, tree);
    rapidjson::Reader reader;
    const rapidjson::ParseResult result = reader.Parse<flags>(stream, builder);
    if (result.IsError())
        throwBadInput({explain(result.Code()), tree.where(builder.position(result.Offset())), "", ""});
    return tree;
}

}  // namespace lumi
