#include "study/study_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "base/error.h"
#include "base/files.h"

namespace lumi {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

constexpr const char* kLabel = "study.json";

/// What an interrupted writeFileAtomically() left of one of ours.
bool isOurPart(const std::string& name) {
    if (!name.ends_with(".tmp")) return false;
    for (const char* own : {kLabel, "results.json", "results.csv", "timings.json", "report.html"})
        if (name.starts_with(std::string(own) + '.')) return true;
    return false;
}

std::string shownStudy(const std::string& name, const std::string& preset) {
    return preset.empty() ? '"' + name + '"' : fmt::format("\"{}\" at preset \"{}\"", name, preset);
}

}  // namespace

StudyFolder::StudyFolder(const Study& study, fs::path path) : path_(std::move(path)) {
    std::error_code failure;
    fs::create_directories(path_, failure);
    if (!fs::is_directory(path_, failure)) throwUsage({"cannot be made", path_.string(), "a folder for results", ""});
    claim(study);
    const fs::path lock = path_ / ".lock";
    lock_ = ::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (lock_ < 0) throwUsage({"cannot be written", path_.string(), "a folder for results", ""});
    if (::flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
    ::close(lock_);
    throwUsage({"another study runs in this folder", path_.string(), "another folder, or its end", ""});
}

StudyFolder::~StudyFolder() { ::close(lock_); }

void StudyFolder::claim(const Study& study) const {
    const json own = {{"study", study.name}, {"preset", study.preset}};
    const fs::path label = path_ / kLabel;
    if (fs::exists(label)) {
        const json found = json::parse(readTextFile(label, 1 << 16), nullptr, false);
        const auto text = [&](const char* key) {
            return found.is_object() && found.contains(key) && found[key].is_string() ? found[key].get<std::string>() : "";
        };
        if (text("study") == study.name && text("preset") == study.preset) return;
        throwUsage({fmt::format("holds the study {}", shownStudy(text("study"), text("preset"))), path_.string(),
                    "another folder for " + shownStudy(study.name, study.preset), ""});
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(path_))
        if (const std::string name = entry.path().filename().string(); name != ".lock" && !isOurPart(name))
            throwUsage({fmt::format("holds \"{}\", which no study wrote", name), path_.string(), "an empty folder, or a new one", ""});
    writeFileAtomically(label, std::string_view(own.dump(1) + "\n"));
}

void StudyFolder::keepOnly(const std::set<std::string>& jobs, const std::set<std::string>& files) const {
    std::error_code ignored;
    std::vector<fs::path> others;
    for (const fs::directory_entry& entry : fs::directory_iterator(path_, ignored))
        if (isOurPart(entry.path().filename().string())) others.push_back(entry.path());
    for (const fs::directory_entry& entry : fs::directory_iterator(path_ / "jobs", ignored))
        if (!jobs.contains(entry.path().filename().string())) others.push_back(entry.path());
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path_ / "jobs", ignored))
        if (entry.path().extension() == ".tmp") others.push_back(entry.path());
    for (const char* folder : {"references", "figures", "tables"})
        for (const fs::directory_entry& entry : fs::directory_iterator(path_ / folder, ignored))
            if (!files.contains(entry.path().filename().string())) others.push_back(entry.path());
    for (const fs::path& path : others) fs::remove_all(path, ignored);
}

}  // namespace lumi
