#include "app/help_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "measure/measure.h"
#include "measure/temporal.h"
#include "reconstruct/catalog.h"
#include "scene/load.h"
#include "study/study_file.h"

namespace lumi {
namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0 good; 1 a check did not hold; 2 usage, unknown scene, module, metric or id; 3 bad input, images of\n"
    "different size, replayed scene changed; 4 no display or OpenGL; 5 memory limit, disk full; 130 interrupted.";

using Rows = std::vector<std::pair<std::string, std::string>>;  // names and what they are

/// Two columns, the second two spaces after the longest name.
std::string columns(const Rows& rows) {
    size_t width = 0;
    for (const auto& [name, meaning] : rows) width = std::max(width, name.size());
    std::string text;
    for (const auto& [name, meaning] : rows) text += fmt::format("  {:<{}}{}\n", name, width + 2, meaning);
    return text;
}

std::string sceneList() {
    Rows rows;
    for (const SceneEntry& entry : listScenes())
        rows.emplace_back(entry.name, entry.title + (entry.missing.empty() ? "" : " (needs $LUMISCOPE_ASSETS)"));
    return "Scenes: a path (.json .gltf .glb .obj, or an .hdr/.exr sky), or one of:\n" + columns(rows);
}

std::string moduleList() {
    Rows rows;
    for (const ModuleEntry& entry : moduleCatalog()) rows.emplace_back(entry.id, entry.title);
    return "Modules:\n" + columns(rows) + "  An instance is a module with parameters of its own: svgf, svgf@b.\n";
}

std::string metricList() {
    Rows images, sequences;
    for (const Metric& metric : metricCatalog()) images.emplace_back(metric.id, metric.title);
    for (const SequenceMetric& metric : sequenceMetricCatalog()) sequences.emplace_back(metric.id, metric.title);
    return "Metrics:\n" + columns(images) + "Of frames also:\n" + columns(sequences);
}

std::string studyList() {
    Rows rows;
    for (const StudyListing& study : listStudies()) rows.emplace_back(study.name, study.title);
    return "Studies:\n" + columns(rows);
}

}  // namespace

const char* versionText() { return "lumiscope 0.1.0"; }

std::string mainFooter() {
    return "Examples:\n"
           "  lumiscope                                    the window, on the built-in atrium\n"
           "  lumiscope room                               the window, on another scene\n"
           "  lumiscope render cornell --spp 64 --out cornell.exr --out cornell.png\n"
           "  lumiscope reference cornell --spp 4096 --out reference.exr\n"
           "  lumiscope compare cornell.exr reference.exr  how far one image is from another\n"
           "  lumiscope study convergence --preset quick   methods compared, with a report\n"
           "  lumiscope list parameters                    everything that --set knows\n"
           "  lumiscope list metrics                       everything that compare measures\n\n" +
           sceneList() + "\n" + kExitCodes;
}

std::string renderFooter() {
    return "Examples:\n"
           "  lumiscope render cornell --spp 256 --out cornell.png\n"
           "  lumiscope render parade --frames 0..120 --fps 30 --out parade.mp4\n"
           "  lumiscope render atrium --module none --frames 8 --buffers all --out atrium.%04d.exr\n"
           "  lumiscope render room --set path.max-depth=3 --set camera.aperture=0.02 --size 640x360\n"
           "  lumiscope render room --camera-path walk.json --frames 240 --out walk.%04d.exr\n"
           "  lumiscope render room --stereo --set camera.interaxial=0.1 --out room.png    room.left.png, "
           "room.right.png\n"
           "  lumiscope render --replay cornell.png --out again.png\n\n"
           "Frames that are there with the same state are kept: the same command goes on after an interruption.\n\n" +
           sceneList() + moduleList() + "\n" + kExitCodes;
}

std::string benchFooter() {
    return "Examples:\n"
           "  lumiscope bench                              everything; some minutes\n"
           "  lumiscope bench --filter trace/path\n"
           "  lumiscope bench --filter 'sponza$' --json\n"
           "  lumiscope bench --filter '^(metric|filter)/'\n"
           "  lumiscope list benches                       the names of all entries\n\n"
           "trace/primary, bounce, shadow and path: Mray/s; the limit is one call of Embree a ray over the same rays.\n"
           "trace/frame: frames a second at 640x360, one sample a pixel, one bounce; the limit is its bare rays.\n"
           "trace/emitters: frames a second under 100,352 triangles that shine; the limit is the same under ten.\n"
           "trace/embree-pathtracer: Mray/s; the limit is Embree's own path tracer (Debian's embree-tools).\n"
           "load, build: seconds to read a scene and to make it ready for rays. memory: peak of loading and "
           "rendering;\n"
           "the limit is twice what scene and tracer hold. Sponza is measured where $LUMISCOPE_ASSETS holds it.\n"
           "metric/ID: Mpixel/s on 1920x1080. filter/MODULE, filter/MODULE/STAGE: frames a second at 1280x720. The "
           "limit of\n"
           "both streams what they read through memory once, in the same run; memory/metric/ID and "
           "memory/filter/MODULE tell\n"
           "their peak memory beside it. The stage `filter` is all stages but antialiasing. size/svgf: that stage in "
           "Mpixel/s at\n"
           "two other sizes; the limit is the same at 1280x720. Medians of 5 to 25 runs; spread is (slowest - fastest) "
           "/ median.\n"
           "mark/svgf: what the project claims on two cores, at most the limit: ms of a frame at 1280x720, and times a "
           "pixel at\n"
           "other sizes by that at 1280x720. With --check the exit code is 1 where one is missed.\n";
}

std::string referenceFooter() {
    return "Examples:\n"
           "  lumiscope reference cornell --spp 4096 --out cornell.exr\n"
           "  lumiscope reference room --error 0.02 --camera main --out room.exr\n"
           "  lumiscope reference parade --frames 0..60 --fps 30 --spp 512 --buffers motion --out ref.%04d.exr\n"
           "  lumiscope reference cornell --samples 0..2048 --out a.lumiref      on one machine\n"
           "  lumiscope reference cornell --samples 2048..4096 --out b.lumiref   on another, then\n"
           "  lumiscope merge a.lumiref b.lumiref --out cornell.exr              gives the same bytes\n\n"
           "The relative standard error is the root of the mean over pixels of (standard error of luminance)^2 /\n"
           "(luminance^2 + 0.001), measured at four steps an octave from 256 samples on.\n"
           "References are kept in $XDG_CACHE_HOME/lumiscope/references, else ~/.cache/lumiscope/references. What was\n"
           "interrupted goes on from there; delete the folder to have the space back.\n\n" +
           sceneList() + "\n" + kExitCodes;
}

std::string viewFooter() {
    return "Examples:\n"
           "  lumiscope view cornell --offscreen --out shots --module accumulate --module none\n"
           "  lumiscope view parade --offscreen --out shots --module none --frames 0..24 --buffers all\n"
           "  lumiscope view room --offscreen --out shots --script tour.txt\n\n"
           "With --frames there is one PNG of each frame, named by its number. The commands of a script, one a line:\n"
           "  size W H  scale N  mouse X Y  hover NAME  press|release BUTTON  wheel N  click|double-click NAME\n"
           "  drag NAME DX DY  key CHORD  hold|lift KEY  text WORDS  drop PATH  set ID VALUE  pause N\n"
           "  wait-load  wait-shown  wait-frame N  wait-frames N  wait-spp N  wait-signals  wait-metrics\n"
           "  wait-message TEXT  shot NAME  dump-ui NAME  dump-lineage NAME";
}

std::string compareFooter() {
    return "Examples:\n"
           "  lumiscope compare noisy.exr reference.exr\n"
           "  lumiscope compare noisy.exr reference.exr --metrics rmse,flip --maps errors --crop 0,0,256,256\n"
           "  lumiscope compare out.%04d.exr ref.%04d.exr --metrics relmse,temporal_reprojected,lag\n\n" +
           metricList() + "\n" + kExitCodes;
}

std::string studyFooter() {
    return "Writes results.json, results.csv, timings.json, report.html, figures/ (inset strips as SVG and PNG) and "
           "tables/ (LaTeX).\n"
           "Run it again after an interruption, and it goes on; results.json and results.csv come out the same bytes "
           "as without.\n"
           "Run it again with other figures, and only those are drawn. References are kept for the next study. A "
           "folder belongs to\n"
           "one study and preset.\n\n"
           "Examples:\n"
           "  lumiscope study convergence --preset quick\n"
           "  lumiscope study my-study.json --out my-results --json\n\n" +
           studyList() + "\n" + kExitCodes;
}

}  // namespace lumi
