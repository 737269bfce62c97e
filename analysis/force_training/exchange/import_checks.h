#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/force_training/exchange/import_trials.h"
#include "analysis/force_training/score/score.h"

namespace haptrial::exchange {

/// Figures of a curve of a trial.
struct CurveLook {
  std::size_t rows{0};
  double duration{0.0};  // [s]
  double rate{0.0};      // rows a second, on the average [Hz]
  double gap{0.0};       // the longest step between two rows [s]
  double low{0.0};       // [N]
  double high{0.0};      // [N]

  double peak() const;  // the largest magnitude [N]
};

/// Figures of the curves of a trial together.
struct TrialLook {
  CurveLook target;
  CurveLook applied;
  bool equal{false};                    // row by row
  std::optional<double> correlation{};  // of both on one time base; nothing for constant ones
  bool better_reversed{false};          // the applied force is nearer to the target when negated
};

/// @param detail  the same curves, aligned.
TrialLook look_at(const ImportedCurves& curves, const analysis::RecallDetail& detail);

/// A warning about times that can hardly be seconds; empty when all is well. Neither curve may be
/// one that duration_of() refuses.
std::string time_warning(const analysis::TableCurve& target, const analysis::TableCurve& applied);

/// Warnings about data that can hardly be what the import takes them for: times that are not
/// seconds, forces that are not newtons, a reversed sign, a constant force, a handful of rows,
/// curves or rates that do not fit each other, names that differ in blanks or case. One sentence
/// for each kind with how many trials it is about and the first of them; empty when all is well.
/// @param looks  of trials.trials()
std::vector<std::string> import_warnings(const ImportedTrials& trials,
                                         std::span<const TrialLook> looks);

}  // namespace haptrial::exchange
