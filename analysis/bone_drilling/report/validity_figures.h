#pragma once

#include <vector>

#include "analysis/bone_drilling/report/validity_result.h"
#include "analysis/document/document.h"
#include "analysis/document/figure.h"

namespace haptrial::analysis::drilling {

/// Figures 16, 19 to 21 and the ROC curves, as far as there is something to draw.
std::vector<Figure> validity_figures(const ValidityResult& result);

/// A PNG file inside an SVG, for a document. @throws InputError where it cannot be read.
Drawing drawing_of(const StudyPicture& picture, bool simulated);

/// The name of the metric behind a figure, or nothing there.
const MetricValidity* metric_of(const Validity& v, std::string_view name);

}  // namespace haptrial::analysis::drilling
