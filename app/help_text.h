#pragma once
#include <string>

namespace lumi {

/// What --version prints, without the line's end.
const char* versionText();
/// What stands below the options: examples, what there is to choose from, exit codes.
std::string mainFooter();
std::string renderFooter();
std::string benchFooter();
std::string compareFooter();
std::string referenceFooter();
std::string viewFooter();
std::string studyFooter();

}  // namespace lumi
