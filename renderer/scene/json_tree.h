#pragma once
#include <string>
#include <vector>

namespace lumi {

/// Where something stands in a text: line and column count from 1, columns in characters (UTF-8 code points).
struct TextPosition {
    int line = 1, column = 1;
};

struct JsonMember;

/// A JSON value that remembers where it begins.
struct JsonValue {
    enum class Type { Null, Boolean, Number, String, Array, Object };
    Type type = Type::Null;
    TextPosition at;
    bool boolean = false;
    double number = 0;                ///< finite
    std::string text;                 ///< a string's contents, a number as it is written
    std::vector<JsonValue> items;     ///< of an array
    std::vector<JsonMember> members;  ///< of an object, in document order, keys unique

    bool isNumber() const { return type == Type::Number; }
    bool isString() const { return type == Type::String; }
    bool isArray() const { return type == Type::Array; }
    bool isObject() const { return type == Type::Object; }
    /// For messages: `12`, `"text"`, `true`, `null`, `an array of 2`, `an object`.
    std::string shown() const;
};

struct JsonMember {
    std::string key;
    TextPosition at;  ///< of the key
    JsonValue value;
};

/// A parsed JSON file: strict JSON in UTF-8, at most 256 levels deep, numbers finite, keys of an object unique.
struct JsonTree {
    std::string file;  ///< for messages
    JsonValue root;

    /// "atrium.json:12:9".
    std::string where(const TextPosition& at) const;
};

/// Throws Error(BadInput) headed by file:line:column, Error(Resources) where the tree would pass the memory limit.
JsonTree parseJsonTree(const std::string& text, const std::string& file);

}  // namespace lumi
