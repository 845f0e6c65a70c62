#pragma once
#include "study/run_study.h"

namespace lumi {

/// Prints what a study found on standard output: a table a scene and sample count with intervals and places, pixels
/// that are not finite, what stages are worth, equal time and equal error. Nothing is ranked that the intervals do not
/// tell apart.
void printStudy(const StudyOutcome& outcome);

}  // namespace lumi
