#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "analysis/force_training/exchange/curve_study.h"
#include "analysis/force_training/score/curve_csv.h"
#include "analysis/force_training/score/trial_score.h"

namespace haptrial::exchange {

/// A test of an imported study, without its score.
struct ImportedTrial {
  analysis::TrialScore score;
  bool simulated{false};
};

struct ImportedCurves {
  analysis::TableCurve target;
  analysis::TableCurve applied;
};

/// The tests of an imported study and their curves.
class ImportedTrials {
 public:
  virtual ~ImportedTrials() = default;

  const std::vector<ImportedTrial>& trials() const { return trials_; }  // by subject, then trial
  const std::vector<std::string>& factors() const { return factors_; }
  /// The curves of trials()[i]. Any thread. @throws InputError with file and line.
  virtual ImportedCurves curves(std::size_t i) const = 0;
  /// Place of a trial's rows, for sentences about them.
  virtual std::string place(std::size_t i) const = 0;

 protected:
  std::vector<ImportedTrial> trials_;
  std::vector<std::string> factors_;
};

/// @param study  outlives what is returned.
/// @throws InputError for a table that is not as CurveStudy says.
std::unique_ptr<ImportedTrials> read_trials(const CurveStudy& study);

}  // namespace haptrial::exchange
