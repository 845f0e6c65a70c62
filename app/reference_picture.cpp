#include "app/reference_picture.h"

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files.h"
#include "image/exr.h"
#include "image/png.h"
#include "params/json.h"
#include "session/export.h"
#include "session/view_buffers.h"

namespace lumi {
using nlohmann::json;
namespace {

template <class Object>
json valuesOf(Object object) {
    json values = json::object();
    for (const ParameterInfo& info : listParameters([&](ParameterVisitor& v) { object.describe(v); }))
        values[info.id] = toJson(info.value);
    return values;
}

json floatsOf(const Mat4& m) {
    json values = json::array();
    for (int i = 0; i < 16; ++i) values.push_back(m[i / 4][i % 4]);
    return values;
}

Mat4 matrixFrom(const json& values) {
    Mat4 m(1);
    for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = values.at(static_cast<size_t>(i)).get<float>();
    return m;
}

}  // namespace

ReferencePicture ReferencePicture::of(const Document& document, const SceneReference& scene, const std::string& buffers,
                                      bool half) {
    ReferencePicture picture;
    picture.initialSpp = std::get<int>(document.initial("render.spp"));
    auto described = std::make_shared<Document>(document);
    described->set("render.spp", picture.initialSpp);
    FrameOutput frame;
    frame.number = 0;
    frame.changes.cut = true;
    StateLog log(scene);
    log.record(frame, described);
    picture.state = log.json(OutputChoice{0, buffers, half}.json());
    picture.camera = poseCamera(document.camera(), {document.render().width, document.render().height});
    picture.view = document.view(0);
    picture.half = half;
    return picture;
}

std::string ReferencePicture::text() const {
    return json{{"world-from-camera", floatsOf(camera.worldFromCamera)},
                {"camera-from-world", floatsOf(camera.cameraFromWorld)},
                {"size", {camera.extent.width, camera.extent.height}},
                {"orthographic", camera.projection == Projection::Orthographic},
                {"half-height", camera.halfHeight},
                {"view", valuesOf(view)},
                {"half", half},
                {"state", json::parse(state)},
                {"initial-spp", initialSpp}}
        .dump();
}

ReferencePicture ReferencePicture::parse(const std::string& text, const std::string& where) {
    try {
        const json value = json::parse(text);
        ReferencePicture picture;
        picture.camera.worldFromCamera = matrixFrom(value.at("world-from-camera"));
        picture.camera.cameraFromWorld = matrixFrom(value.at("camera-from-world"));
        picture.camera.extent = {value.at("size").at(0).get<int>(), value.at("size").at(1).get<int>()};
        if (value.at("orthographic").get<bool>()) picture.camera.projection = Projection::Orthographic;
        picture.camera.halfHeight = value.at("half-height").get<float>();
        const Describe describe = [&](ParameterVisitor& v) { picture.view.describe(v); };
        for (const ParameterInfo& info : listParameters(describe))
            setParameter(describe, info.id, parameterFromJson(info, value.at("view").at(info.id), where), where);
        picture.half = value.at("half").get<bool>();
        picture.state = value.at("state").dump();
        picture.initialSpp = value.at("initial-spp").get<int>();
        static_cast<void>(json::parse(picture.state).at("start").at("set"));
        return picture;
    } catch (const json::exception&) {
    } catch (const Error&) {
    }
    throwBadInput(
        {"does not tell what its image looks like", where, "a part that `lumiscope reference --samples` wrote", ""});
}

std::string ReferencePicture::stateOf(uint64_t samples) const {
    json value = json::parse(state);
    if (samples != static_cast<uint64_t>(initialSpp)) value["start"]["set"]["render.spp"] = samples;
    return value.dump();
}

Written ReferencePicture::write(const std::filesystem::path& path, const Reference& reference,
                                const std::string& buffers, std::shared_ptr<const Signals> signals) const {
    FrameOutput frame;
    frame.number = 0;
    frame.camera = camera;
    frame.results[view.module] = std::make_shared<Image>(reference.image);
    if (!signals) {
        auto depth = std::make_shared<Signals>();
        depth->reset(camera.extent, {Signal::Depth}, 1);
        (*depth)[Signal::Depth] = reference.depth;
        signals = depth;
    }
    frame.signals = signals;
    BufferSelection selection = BufferSelection::parse(buffers, view.module, "--buffers");
    selection.taps.clear();
    return writeView(path, frame, view, selection, half, stateOf(reference.samples));
}

}  // namespace lumi
