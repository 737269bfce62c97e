#pragma once

#include <string>
#include <vector>

#include "analysis/document/document.h"
#include "analysis/psychophysics/study/trials_result.h"

namespace haptrial::analysis::trials {

/// The part of a report on functions of several stimulus variables, without its heading.
void add_surfaces(Document& document, const TrialsResult& result,
                  const std::vector<Drawing>& drawings);

/// The threshold over two variables with its band and what was presented: "surface-P01".
std::vector<Figure> surface_figures(const TrialsResult& result);

/// The threshold of every function: "surfaces.csv". NaN is empty; over three variables and four,
/// `first` has the levels of all others.
std::string surfaces_csv(const TrialsResult& result);

/// The part "surfaces" of results.json.
std::string surfaces_json(const TrialsResult& result);

}  // namespace haptrial::analysis::trials
