#include "study/study_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/files.h"

namespace lumi {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

constexpr const char* kLabel = "study.json";
constexpr const char* kFolders[] = {"references", "figures", "tables"};

/// May the label speak of this file? Whatever stands in it, nothing outside these folders is touched.
bool isInOurFolders(const std::string& file) {
    const fs::path path(file);
    for (const char* folder : kFolders)
        if (path.parent_path() == folder && path.filename() != ".." && path.filename() != ".") return true;
    return false;
}

/// Is it an unfinished one of our own files?
bool isOurPart(const fs::path& name) {
    const std::optional<Unfinished> part = unfinishedFile(name);
    if (!part) return false;
    for (const char* own : {kLabel, "results.json", "results.csv", "timings.json", "report.html"})
        if (part->whole == own) return true;
    return false;
}

std::string shownStudy(const std::string& name, const std::string& preset) {
    return preset.empty() ? '"' + name + '"' : fmt::format("\"{}\" at preset \"{}\"", name, preset);
}

}  // namespace

StudyFolder::StudyFolder(const Study& study, fs::path path)
    : path_(std::move(path)), study_(study.name), preset_(study.preset) {
    std::error_code failure;
    fs::create_directories(path_, failure);
    if (!fs::is_directory(path_, failure)) throwUsage({"cannot be made", path_.string(), "a folder for results", ""});
    claim();
    const fs::path lock = path_ / ".lock";
    lock_ = ::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (lock_ < 0) throwUsage({"cannot be written", path_.string(), "a folder for results", ""});
    if (::flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
    ::close(lock_);
    throwUsage({"another study runs in this folder", path_.string(), "another folder, or its end", ""});
}

StudyFolder::~StudyFolder() { ::close(lock_); }

void StudyFolder::claim() {
    const fs::path label = path_ / kLabel;
    if (fs::exists(label)) {
        const json found = json::parse(readTextFile(label, 1 << 24), nullptr, false);
        const auto text = [&](const char* key) {
            return found.is_object() && found.contains(key) && found[key].is_string() ? found[key].get<std::string>()
                                                                                      : "";
        };
        if (text("study") != study_ || text("preset") != preset_)
            throwUsage({fmt::format("holds the study {}", shownStudy(text("study"), text("preset"))), path_.string(),
                        "another folder for " + shownStudy(study_, preset_), ""});
        if (found.contains("files") && found["files"].is_array())
            for (const json& file : found["files"])
                if (file.is_string() && isInOurFolders(file)) files_.insert(file.get<std::string>());
        return;
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(path_))
        if (const fs::path name = entry.path().filename(); name != ".lock" && !isOurPart(name))
            throwUsage({fmt::format("holds \"{}\", which no study wrote", name.string()), path_.string(),
                        "an empty folder, or a new one", ""});
    writeLabel();
}

void StudyFolder::writeLabel() const {
    const json own = {{"study", study_}, {"preset", preset_}, {"files", files_}};
    writeFileAtomically(path_ / kLabel, std::string_view(own.dump(1) + "\n"));
}

void StudyFolder::note(const std::set<std::string>& files) {
    const size_t before = files_.size();
    files_.insert(files.begin(), files.end());
    if (files_.size() > before) writeLabel();
}

void StudyFolder::keepOnly(const std::set<std::string>& jobs, const std::set<std::string>& files) {
    note(files);
    std::error_code ignored;
    std::vector<fs::path> others;
    for (const fs::directory_entry& entry : fs::directory_iterator(path_, ignored))
        if (isOurPart(entry.path().filename())) others.push_back(entry.path());
    for (const fs::directory_entry& entry : fs::directory_iterator(path_ / "jobs", ignored))
        if (!jobs.contains(entry.path().filename().string())) others.push_back(entry.path());
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path_ / "jobs", ignored))
        if (entry.path().extension() == ".tmp") others.push_back(entry.path());
    for (const char* folder : kFolders)
        for (const fs::directory_entry& entry : fs::directory_iterator(path_ / folder, ignored))
            if (const auto part = unfinishedFile(entry.path().lexically_relative(path_));
                part && files_.contains(part->whole.generic_string()))
                others.push_back(entry.path());
    for (const std::string& file : files_)
        if (!files.contains(file)) others.push_back(path_ / file);
    for (const fs::path& path : others) fs::remove_all(path, ignored);
    if (files_ == files) return;
    files_ = files;
    writeLabel();
}

}  // namespace lumi
