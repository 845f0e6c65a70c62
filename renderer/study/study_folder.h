#pragma once
#include <filesystem>
#include <set>
#include <string>

#include "study/study.h"

namespace lumi {

/// The folder of a study's results, held while this lives; the kernel lets go of it when the process ends, however it
/// ends.
///
/// `study.json` says whose it is: the study's name and preset. A study that was edited goes on in its folder; another
/// study, or another preset, is refused, and so is a folder with files that no study wrote. It lists the references,
/// figures and tables that were written: of these what is left over is removed at the end, and nothing that somebody
/// else put beside them.
class StudyFolder {
public:
    /// Throws Error(Usage): another process works there, it holds another study or strange files, it cannot be written.
    StudyFolder(const Study& study, std::filesystem::path path);
    ~StudyFolder();
    StudyFolder(const StudyFolder&) = delete;
    StudyFolder& operator=(const StudyFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    /// Notes references, figures and tables (`tables/all.tex`) as the study's own; to be called before they are
    /// written, or an interruption leaves files that nobody removes.
    void note(const std::set<std::string>& files);
    /// Removes jobs that are not named, of the files that were noted those that are not, and what interruptions left.
    void keepOnly(const std::set<std::string>& jobs, const std::set<std::string>& files);

private:
    void claim();
    void writeLabel() const;

    std::filesystem::path path_;
    std::string study_, preset_;
    std::set<std::string> files_;  ///< that were noted
    int lock_ = -1;
};

}  // namespace lumi
