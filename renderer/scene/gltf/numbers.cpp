#include "scene/gltf/numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "scene/gltf/json_walk.h"
#include "scene/gltf/structure_table.h"

namespace lumi::gltf {
namespace {

using Json = nlohmann::json;

constexpr double kHuge = 1e9, kInfinite = std::numeric_limits<double>::infinity();

/// A number of a material, or `size` of them in an array.
struct Range {
    std::string_view path;
    double least, most, otherwise;  ///< the last: the default
    size_t size = 1;
};

constexpr Range kCore[] = {
    {"pbrMetallicRoughness/baseColorFactor", 0, 1, 1, 4},
    {"pbrMetallicRoughness/metallicFactor", 0, 1, 1},
    {"pbrMetallicRoughness/roughnessFactor", 0, 1, 1},
    {"normalTexture/scale", -16, 16, 1},
    {"emissiveFactor", 0, kHuge, 0, 3},
    {"alphaCutoff", 0, kHuge, 0.5},
    {"extensions/KHR_materials_anisotropy/anisotropyStrength", 0, 1, 0},
    {"extensions/KHR_materials_anisotropy/anisotropyRotation", -kHuge, kHuge, 0},
    {"extensions/KHR_materials_clearcoat/clearcoatFactor", 0, 1, 0},
    {"extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", 0, 1, 0},
    {"extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale", -16, 16, 1},
    {"extensions/KHR_materials_emissive_strength/emissiveStrength", 0, 3e38, 1},
    {"extensions/KHR_materials_ior/ior", 1, kHuge, 1.5},
    {"extensions/KHR_materials_iridescence/iridescenceFactor", 0, 1, 0},
    {"extensions/KHR_materials_iridescence/iridescenceIor", 1, 10, 1.3},
    {"extensions/KHR_materials_iridescence/iridescenceThicknessMinimum", 0, 1e5, 100},
    {"extensions/KHR_materials_iridescence/iridescenceThicknessMaximum", 0, 1e5, 400},
    {"extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor", 0, 1, 1, 4},
    {"extensions/KHR_materials_pbrSpecularGlossiness/specularFactor", 0, 1, 1, 3},
    {"extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor", 0, 1, 1},
    {"extensions/KHR_materials_sheen/sheenColorFactor", 0, 1, 0, 3},
    {"extensions/KHR_materials_sheen/sheenRoughnessFactor", 0, 1, 0},
    {"extensions/KHR_materials_specular/specularFactor", 0, 1, 1},
    {"extensions/KHR_materials_specular/specularColorFactor", 0, 1e4, 1, 3},
    {"extensions/KHR_materials_transmission/transmissionFactor", 0, 1, 0},
    {"extensions/KHR_materials_volume/thicknessFactor", 0, kHuge, 0},
    {"extensions/KHR_materials_volume/attenuationColor", 0, 1, 1, 3},
    {"extensions/KHR_materials_volume/attenuationDistance", 0, kInfinite, kInfinite},
};

/// Of KHR_texture_transform, in each texture.
constexpr Range kTransform[] = {
    {"offset", -kHuge, kHuge, 0, 2}, {"scale", -kHuge, kHuge, 1, 2}, {"rotation", -kHuge, kHuge, 0}};

/// All of them, and their places in a file.
struct Ranges {
    std::vector<const Range*> ranges;
    JsonPatterns patterns;

    void add(const Range& range, const std::string& place) {
        patterns.add("materials/[]/" + place + std::string(range.path), ranges.size());
        ranges.push_back(&range);
    }
};

const Ranges& allRanges() {
    static const Ranges all = [] {
        Ranges made;
        for (const Range& range : kCore) made.add(range, "");
        for (const std::string_view texture : texturePaths())
            for (const Range& range : kTransform)
                made.add(range, std::string(texture) + "/extensions/KHR_texture_transform/");
        return made;
    }();
    return all;
}

class NumberChecker final : JsonWalk {
public:
    explicit NumberChecker(FileWarnings& warnings) : warnings_(warnings) {}

    void check(Json& tree) { walk(tree, allRanges().patterns); }
    bool hasChanged() const { return hasChanged_; }

private:
    // An extension that is no object is left out.
    Seen onOtherType(const Json&, const char*) override { return Seen::Stays; }

    Seen onValue(size_t number, Json& value) override {
        range_ = allRanges().ranges[number];
        if (range_->size == 1) checkNumber(value);
        else if (!value.is_array() || value.size() != range_->size)
            replace(value, path(), fmt::format("not {} numbers", range_->size),
                    std::vector<double>(range_->size, range_->otherwise));
        else
            for (size_t i = 0; i < value.size(); ++i) checkNumber(value[i], i);
        return Seen::Stays;
    }

    /// An entry of an array has its place in it.
    void checkNumber(Json& value, std::optional<size_t> entry = std::nullopt) {
        const auto where = [&] { return entry ? path() + "/" + std::to_string(*entry) : path(); };
        if (!value.is_number()) return replace(value, where(), "not a number", range_->otherwise);
        const double given = value.get<double>();
        if (const double taken = nearest(given); std::abs(taken - given) > 1e-6)
            replace(value, where(), "out of range", taken);
    }

    /// An index of refraction of 0 reflects everything; a distance of 0 is none.
    double nearest(double given) const {
        if (given == 0 && range_->path.ends_with("/ior")) return given;
        if (given <= 0 && range_->otherwise == kInfinite) return kInfinite;
        return std::clamp(given, range_->least, range_->most);
    }

    void replace(Json& value, const std::string& where, const std::string& fault, Json taken) {
        const Json& first = taken.is_array() ? taken.front() : taken;
        const std::string given = value.is_number() ? fmt::format("{:.4g}", value.get<double>()) : shown(value);
        warnings_.warn(fmt::format("{}: {} is {}; {:.4g} is taken", where, given, fault, first.get<double>()));
        value = std::move(taken);  // infinity becomes null, which is as if it were not there
        hasChanged_ = true;
    }

    FileWarnings& warnings_;
    const Range* range_ = nullptr;
    bool hasChanged_ = false;
};

}  // namespace

bool checkNumbers(Json& tree, FileWarnings& warnings) {
    NumberChecker checker(warnings);
    checker.check(tree);
    return checker.hasChanged();
}

}  // namespace lumi::gltf
