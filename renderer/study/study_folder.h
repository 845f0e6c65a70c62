#pragma once
#include <filesystem>
#include <set>
#include <string>

#include "study/study.h"

namespace lumi {

/// The folder of a study's results, held while this lives; the kernel lets go of it when the process ends, however it ends.
///
/// `study.json` says whose it is: the study's name and preset. A study that was edited goes on in its folder; another study,
/// or another preset, is refused, and so is a folder with files that no study wrote: what is left over is removed at the
/// end, and nobody else's results shall be.
class StudyFolder {
public:
    /// Throws Error(Usage): another process works there, it holds another study or strange files, it cannot be written.
    StudyFolder(const Study& study, std::filesystem::path path);
    ~StudyFolder();
    StudyFolder(const StudyFolder&) = delete;
    StudyFolder& operator=(const StudyFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    /// Removes jobs, references, figures and tables that are not named (file names), and what interruptions left.
    void keepOnly(const std::set<std::string>& jobs, const std::set<std::string>& files) const;

private:
    void claim(const Study& study) const;

    std::filesystem::path path_;
    int lock_ = -1;
};

}  // namespace lumi
