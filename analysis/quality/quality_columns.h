#pragma once

#include <optional>
#include <span>

#include "analysis/quality/trial_quality.h"

namespace haptrial::analysis {

/// A number of a trial's quality as a column of scores.csv.
struct QualityColumn {
  const char* name;
  const char* unit;  // "" of a share
  const char* description;
  std::optional<double>& (*field)(TrialQuality&);

  const std::optional<double>& of(const TrialQuality& quality) const {
    return field(const_cast<TrialQuality&>(quality));  // field() only finds the place
  }
};

/// Columns in the order of the table; a column `flags` with flag_names() follows them there.
std::span<const QualityColumn> quality_columns();

}  // namespace haptrial::analysis
