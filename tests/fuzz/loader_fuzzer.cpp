// libFuzzer target of one loader of scenes and images: LUMI_FUZZ_KIND chooses which.
#include "fuzz/fuzz_target.h"
#include "image/decode.h"
#include "image/exr.h"
#include "image/hdr.h"
#include "image/png.h"
#include "robustness/trace_few.h"
#include "scene/camera_path.h"
#include "scene/gltf/load_gltf.h"
#include "scene/load.h"
#include "scene/obj/cage.h"
#include "scene/obj/load_obj.h"
#include "scene/subdivision.h"

namespace lumi::fuzz {
namespace {

const std::string kKind = LUMI_FUZZ_KIND;

/// What a session does with a file, down to a few rays; but for the sky that files without light get, which takes
/// longer than all the rest.
void open(const std::filesystem::path& path) {
    MessageLog log;
    const std::string kind = path.extension();
    std::shared_ptr<const Scene> scene;
    if (kind == ".obj") scene = std::make_shared<const Scene>(loadObj(path, log));
    else if (kind == ".json") scene = loadScene(path, log);
    else scene = std::make_shared<const Scene>(loadGltf(path, log));
    traceAFew(scene);
}

void openWithMaterials(Bytes mtl) {
    fileOf(mtl, "fuzz.mtl");
    static const std::string obj =
        "mtllib fuzz.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 3/3 "
        "2/2 1/1\n";
    open(fileOf({reinterpret_cast<const uint8_t*>(obj.data()), obj.size()}, "fuzz.obj"));
}

}  // namespace

void load(Bytes bytes) {
    MessageLog log;
    if (kKind == "exr") decodeExr(bytes, "fuzz.exr");
    else if (kKind == "hdr") decodeHdr(bytes, "fuzz.hdr");
    else if (kKind == "png") decodePng(bytes, "fuzz.png");
    else if (kKind == "jpg") decodeImage8(bytes, "fuzz.jpg");
    else if (kKind == "cage") tessellate(parseCage(text(bytes), "fuzz", log), 2, "fuzz");
    else if (kKind == "mtl") openWithMaterials(bytes);
    else if (kKind == "path") readCameraPath(fileOf(bytes, "fuzz.json"));
    else open(fileOf(bytes, "fuzz." + kKind));
}

}  // namespace lumi::fuzz
