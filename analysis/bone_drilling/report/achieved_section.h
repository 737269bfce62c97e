#pragma once

#include "analysis/bone_drilling/report/validity_result.h"
#include "analysis/document/document.h"

namespace haptrial::analysis::drilling {

/// Adds means of each group in what was achieved (metrics/achieved.h). They are not tested.
void add_achieved_section(Document& document, const ValidityResult& result);

}  // namespace haptrial::analysis::drilling
