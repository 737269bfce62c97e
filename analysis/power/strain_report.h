#pragma once

#include "analysis/document/document.h"
#include "analysis/power/power_result.h"

namespace haptrial::analysis {

/// What becomes of the watched test where something goes wrong: its level, then its share of
/// rejections beside that of the study as planned. Nothing for a result without strains.
void add_strains(Document& report, const PowerResult& result);

}  // namespace haptrial::analysis
