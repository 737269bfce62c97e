#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/psychometric/fit/contour.h"
#include "analysis/psychophysics/data/trials_data.h"
#include "analysis/statistics/base/defined.h"
#include "core/psychometric/procedure/procedure.h"

namespace haptrial::analysis::trials {

/// A threshold of the first variable without a formula; NaN beyond its levels.
struct PlacedThreshold {
  psychometric::Level others;  // levels of the other variables
  double median, low, high;    // of 95 %
};

/// A function of several stimulus variables, of one participant under one condition.
struct SurfaceCondition {
  std::string participant;
  std::vector<std::string> levels;  // of the factors
  std::string condition;            // the levels joined by ", "
  std::string track;
  std::vector<std::string> variables;  // of the stimulus
  bool shares_unit{true};              // both have that of the procedure; else the last one alone
  std::vector<SurfaceTrial> trials;
  Defined<SurfaceFit> fit{Undefined{"nothing was fitted"}};
  double share{0.5};  // of answers 1 at the threshold
  std::optional<Contour> contour;
  std::vector<ContourPoint> points;
  std::vector<PlacedThreshold> placed;  // of three variables or four, without a formula
  std::string no_contour;               // why there is none
};

/// Whether a trial's level has several dimensions.
bool has_surface(const StudyTrial& trial);

/// Fits the trials that count and whose level has several dimensions: one function for each
/// participant, track and combination of factors, over all sessions.
/// @param by     factors
/// @param share  of answers 1 at the threshold, 0 to 1
/// @param begin  a procedure as the definition begins it, by the name of a track
std::vector<SurfaceCondition> surface_conditions(
    const TrialsData& data, const std::vector<std::string>& by, double share,
    const std::function<std::unique_ptr<psychometric::Procedure>(const std::string&)>& begin);

}  // namespace haptrial::analysis::trials
