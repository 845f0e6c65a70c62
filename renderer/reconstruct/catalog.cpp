#include "reconstruct/catalog.h"

#include <vector>

#include "base/error.h"
#include "reconstruct/aaf/aaf.h"
#include "reconstruct/accumulate/accumulate.h"
#include "reconstruct/asvgf/asvgf.h"
#include "reconstruct/eaw/eaw.h"
#include "reconstruct/martin2002/martin2002.h"
#include "reconstruct/none/none.h"
#include "reconstruct/sbf/sbf.h"
#include "reconstruct/stable/stable.h"
#include "reconstruct/supersampling/supersampling.h"
#include "reconstruct/svgf/svgf.h"
#include "reconstruct/taa/taa.h"
#include "reconstruct/temporal/temporal.h"
#include "trace/tracer.h"

namespace lumi {
namespace {

template <class T>
std::unique_ptr<Module> make() {
    return std::make_unique<T>();
}

/// Of methods whose samples have one place on the screen.
std::string pinholeAdvice(const Module&, const FrameSampling& sampling) {
    const bool lens = sampling.camera.aperture > 0, shutter = sampling.shutterOpen;
    if (!lens && !shutter) return "";
    return std::string("does without ") + (lens ? "camera.aperture" : "") + (lens && shutter ? " and " : "") +
           (shutter ? "camera.shutter" : "") + ": it sees through a pinhole, at the instant when the shutter opens";
}

std::vector<ModuleEntry>& catalog() {
    static std::vector<ModuleEntry> entries{
        {"none", "Raw frame", "", make<NoneModule>},
        {"accumulate", "Progressive mean", "", make<AccumulateModule>},
        {"svgf", "Spatiotemporal variance-guided filtering", "Schied17", make<SvgfModule>},
        {"asvgf", "Adaptive SVGF", "Schied18", make<AsvgfModule>},
        {"eaw", "Edge-avoiding à-trous wavelets", "Dammertz10", make<EawModule>},
        {"sbf", "SURE-based cross-bilateral bank", "Li12", make<SbfModule>},
        {"aaf", "Axis-aligned filtering of soft shadows", "Mehta12", make<AafModule>},
        {"stable", "Interactive stable ray tracing", "DalCorso17", make<StableModule>,
         [](const Module& module, const FrameSampling& sampling) {
             const std::string own = static_cast<const StableModule&>(module).advice();
             return own.empty() ? pinholeAdvice(module, sampling) : own;
         }},
        {"supersampling", "Supersampling", "DalCorso17", make<SupersamplingModule>, pinholeAdvice},
        {"martin2002", "Temporally coherent ray tracing", "Martin02", make<Martin2002Module>, pinholeAdvice},
        {"temporal", "Temporal accumulation", "Schied17", make<TemporalModule>},
        {"taa", "Temporal antialiasing", "Karis14", make<TaaModule>},
    };
    return entries;
}

}  // namespace

std::span<const ModuleEntry> moduleCatalog() { return catalog(); }

CatalogAddition::CatalogAddition(const ModuleEntry& entry) { catalog().push_back(entry); }
CatalogAddition::~CatalogAddition() { catalog().pop_back(); }

const ModuleEntry& findModule(const std::string& instanceName, const std::string& where) {
    const std::string id = instanceName.substr(0, instanceName.find('@'));
    std::vector<std::string> ids;
    for (const ModuleEntry& entry : moduleCatalog()) {
        if (id == entry.id) return entry;
        ids.push_back(entry.id);
    }
    const std::string near = nearestName(id, ids);
    std::string all;
    for (const std::string& known : ids) all += (all.empty() ? "" : ", ") + known;
    throwUsage({"unknown module \"" + id + '"', where, near.empty() ? "one of " + all : '"' + near + '"', ""});
}

}  // namespace lumi
