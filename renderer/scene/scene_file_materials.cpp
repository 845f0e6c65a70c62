#include <fmt/format.h>

#include <memory>
#include <tuple>

#include "base/error.h"
#include "base/files.h"
#include "base/parallel.h"
#include "image/decode.h"
#include "scene/procedural/procedural.h"
#include "scene/scene_file_parts.h"

namespace lumi {

const std::vector<TextureKey> kTextureKeys{
    {"base-color-texture", true, &Material::baseColorTexture, "RGB colour (sRGB), A alpha; multiplies base-color."},
    {"metallic-roughness-texture", false, &Material::metallicRoughnessTexture, "G roughness, B metallic."},
    {"normal-texture", false, &Material::normalTexture, "Tangent-space normals."},
    {"emission-texture", true, &Material::emissionTexture, "RGB (sRGB); multiplies emission."},
    {"specular-texture", false, &Material::specularTexture, "A weighs the dielectric reflection."},
    {"specular-color-texture", true, &Material::specularColorTexture, "RGB (sRGB); multiplies specular-color."},
    {"transmission-texture", false, &Material::transmissionTexture, "R; multiplies transmission."},
    {"clearcoat-texture", false, &Material::clearcoatTexture, "R; multiplies clearcoat."},
    {"clearcoat-roughness-texture", false, &Material::clearcoatRoughnessTexture, "G; multiplies clearcoat-roughness."},
    {"clearcoat-normal-texture", false, &Material::clearcoatNormalTexture, "Tangent-space normals of the clearcoat."},
    {"sheen-color-texture", true, &Material::sheenColorTexture, "RGB (sRGB); multiplies sheen-color."},
    {"sheen-roughness-texture", false, &Material::sheenRoughnessTexture, "A; multiplies sheen-roughness."},
    {"anisotropy-texture", false, &Material::anisotropyTexture, "RG direction, B multiplies anisotropy."},
    {"iridescence-texture", false, &Material::iridescenceTexture, "R; multiplies iridescence."},
    {"iridescence-thickness-texture", false, &Material::iridescenceThicknessTexture,
     "G; from the least to the full film thickness."},
};

void TexturePlacement::describe(ParameterVisitor& v) {
    v.number("scale-u", scale.x,
             {.label = "Scale u",
              .min = -1e4,
              .max = 1e4,
              .help = "Repetitions along u for each unit of uv.",
              .redo = Redo::Samples});
    v.number("scale-v", scale.y,
             {.label = "Scale v",
              .min = -1e4,
              .max = 1e4,
              .help = "Repetitions along v for each unit of uv.",
              .redo = Redo::Samples});
    v.number("offset-u", offset.x,
             {.label = "Offset u", .min = -1e4, .max = 1e4, .help = "Shift along u.", .redo = Redo::Samples});
    v.number("offset-v", offset.y,
             {.label = "Offset v", .min = -1e4, .max = 1e4, .help = "Shift along v.", .redo = Redo::Samples});
    v.number("rotate-deg", rotateDeg,
             {.label = "Rotation",
              .min = -360,
              .max = 360,
              .unit = "deg",
              .help = "Counter-clockwise, as KHR_texture_transform defines it.",
              .redo = Redo::Samples});
    v.integer(
        "uv-set", uvSet,
        {.label = "UV set", .min = 0, .max = 1, .help = "Which texture coordinates to use.", .redo = Redo::Samples});
    v.choice("wrap", wrap,
             {.label = "Wrap",
              .options = {"repeat", "mirror", "clamp"},
              .help = "What lies outside of 0 to 1.",
              .redo = Redo::Samples});
    v.choice("filter", filter,
             {.label = "Filter",
              .options = {"nearest", "linear"},
              .help = "How texels are interpolated.",
              .redo = Redo::Samples});
    v.toggle("mipmaps", mipmaps,
             {.label = "Mip maps",
              .help = "Average texels that a pixel's footprint covers; without, every "
                      "lookup is at full resolution and fine detail aliases.",
              .redo = Redo::Samples});
}

namespace {

using ImagePtr = std::shared_ptr<const TextureImage>;

/// A texture that some material asked for. Images are decoded together, in parallel, once all materials are read.
struct TextureRequest {
    const JsonValue* value;  ///< for messages
    std::string file;        ///< as written, or empty
    std::unique_ptr<ProceduralTexture> generator;
    std::string generated;  ///< the generator's name and all its parameters
    bool srgb;
    int material;  ///< index into scene.materials
    const TextureKey* key;
    bool mipmaps = true;
    Texture placement;  ///< the image comes with loadTextures()

    SceneFileContext::ImageKey imageKey() const { return {file, generated, srgb && !generator, mipmaps}; }
};

Texture placedTexture(const TexturePlacement& placement) {
    Texture texture;
    texture.wrapU = texture.wrapV = placement.wrap;
    texture.filter = placement.filter;
    texture.uvSet = placement.uvSet;
    texture.offset = placement.offset;
    texture.scale = placement.scale;
    texture.rotation = radians(placement.rotateDeg);
    return texture;
}

/// `"wood.png"`, or `{"file": "wood.png", "scale": [2, 2]}`, or `{"checker": {"squares": 8}, "scale": [2, 2]}`.
TextureRequest readRequest(SceneFileContext& context, const JsonValue& value, const TextureKey& key, int material) {
    TextureRequest request{&value, {}, nullptr, {}, key.srgb, material, &key, true, {}};
    if (value.isString()) {
        request.file = readText(context.tree, value, key.key);
        return request;
    }
    if (!value.isObject()) refuseValue(context.tree, value, key.key, "a file name or an object");
    ObjectReader reader(context.tree, value, key.key);
    TexturePlacement placement;
    if (const auto file = reader.text("file")) request.file = *file;
    for (const ProceduralTextureEntry& entry : proceduralTextureCatalog()) {
        const JsonValue* settings = reader.find(entry.name);
        if (!settings) continue;
        if (request.generator || !request.file.empty())
            reader.fail(value.at, fmt::format("\"{}\" names two images", key.key), "one of \"file\" or a generator");
        request.generator = entry.make();
        ObjectReader parameters(context.tree, *settings, entry.name);
        const auto describe = [&](ParameterVisitor& v) { request.generator->describe(v); };
        parameters.parameters(describe);
        parameters.finish();
        request.generated = entry.name;
        for (const ParameterInfo& info : listParameters(describe))
            request.generated += '\n' + formatParameter(info.value);
    }
    if (const JsonValue* scale = reader.find("scale"); scale && scale->isNumber())
        placement.scale = Vec2(static_cast<float>(readNumber(context.tree, *scale, "scale", -1e4, 1e4)));
    else if (scale) placement.scale = *reader.pair("scale", -1e4, 1e4);
    placement.offset = reader.pair("offset", -1e4, 1e4).value_or(Vec2(0));
    reader.parameters([&](ParameterVisitor& v) { placement.describe(v); }, {},
                      {"scale-u", "scale-v", "offset-u", "offset-v"});
    reader.finish();
    if (!request.generator && request.file.empty())
        reader.fail(value.at, fmt::format("\"{}\" names no image", key.key), "\"file\" or a generator");
    request.mipmaps = placement.mipmaps;
    request.placement = placedTexture(placement);
    return request;
}

std::shared_ptr<TextureImage> decodeFile(const std::vector<uint8_t>& bytes, const std::string& name, bool srgb) {
    Image8 decoded = decodeImage8(bytes, name);
    auto image = std::make_shared<TextureImage>();
    image->name = name;
    image->srgb = srgb;
    image->levels.push_back({decoded.extent, std::move(decoded.rgba), {}});
    return image;
}

/// Loads or generates each image that is not there yet; a file used both as colour and as data counts twice.
void loadTextures(SceneFileContext& context, std::vector<TextureRequest>& requests) {
    std::vector<const TextureRequest*> distinct;
    for (const TextureRequest& request : requests)
        if (context.images.try_emplace(request.imageKey()).second) distinct.push_back(&request);

    std::vector<ImagePtr> images(distinct.size());
    std::vector<std::string> digests(distinct.size());
    std::vector<std::optional<Error>> errors(distinct.size());
    parallelFor(static_cast<int64_t>(distinct.size()), [&](int64_t index) {
        const auto i = static_cast<size_t>(index);
        const TextureRequest& request = *distinct[i];
        try {
            std::shared_ptr<TextureImage> image;
            if (request.generator) {
                image = std::make_shared<TextureImage>(request.generator->build());
            } else {
                const std::filesystem::path path = context.resolve(request.file);
                const std::vector<uint8_t> bytes = readFile(path);
                digests[i] = digest(bytes);
                image = decodeFile(bytes, path.string(), request.srgb);
            }
            if (request.mipmaps) buildMips(*image);
            images[i] = std::move(image);
        } catch (const Error& error) {
            errors[i] = error;
        }
    });
    // The first in document order is reported, whichever thread met its error first.
    for (size_t i = 0; i < errors.size(); ++i)
        if (errors[i])
            throw Error(errors[i]->kind(), {fmt::format("\"{}\": {}", distinct[i]->key->key, errors[i]->what()),
                                            context.tree.where(distinct[i]->value->at), "", ""});
    for (const std::string& text : digests) context.digests += text;
    for (size_t i = 0; i < distinct.size(); ++i) context.images[distinct[i]->imageKey()] = std::move(images[i]);
    for (TextureRequest& request : requests) request.placement.image = context.images.at(request.imageKey());
}

}  // namespace

const TextureKey kRadianceTexture{"radiance-texture", true, nullptr,
                                  "Multiplies radiance; upright seen from the front."};

Texture readTexture(SceneFileContext& context, const JsonValue& value, const TextureKey& key) {
    std::vector<TextureRequest> requests;
    requests.push_back(readRequest(context, value, key, -1));
    loadTextures(context, requests);
    return requests[0].placement;
}

void readMaterials(SceneFileContext& context, const JsonValue* section) {
    std::vector<TextureRequest> requests;
    for (const JsonMember& member : membersOf(context, section, "materials")) {
        const int index = static_cast<int>(context.scene.materials.size());
        context.scene.materials.emplace_back();
        ObjectReader reader(context.tree, member.value, member.key);
        Material& material = context.scene.materials.back();
        material.name = member.key;
        for (const TextureKey& key : kTextureKeys)
            if (const JsonValue* value = reader.find(key.key))
                requests.push_back(readRequest(context, *value, key, index));
        reader.parameters([&](ParameterVisitor& v) { material.describe(v); });
        reader.finish();
        context.materials[member.key] = index;
    }
    if (!requests.empty()) context.report(0.05f, fmt::format("decoding {} textures", requests.size()));
    loadTextures(context, requests);
    for (const TextureRequest& request : requests)
        context.scene.materials[static_cast<size_t>(request.material)].*request.key->member = request.placement;
    context.checkStop();
}

}  // namespace lumi
