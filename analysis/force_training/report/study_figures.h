#pragma once

#include <cstddef>
#include <vector>

#include "analysis/document/figure.h"
#include "analysis/force_training/study/study_result.h"

namespace haptrial::analysis {

/// Look of a condition by its place among them: marks, dashes and colours differ.
Look condition_look(std::size_t index);

/// The figures of a study, those that its data allow, in the order of the report.
/// Source: Morris 2006, Figures 22, 23 and 26 to 28.
std::vector<Figure> study_figures(const StudyResult& study);

}  // namespace haptrial::analysis
