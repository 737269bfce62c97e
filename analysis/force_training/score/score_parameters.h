#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/alignment/options.h"
#include "core/base/definition/schema.h"

namespace haptrial::analysis {

/// How a recall is scored. The source says that its weights were set by eye and does not print
/// them; docs/algorithms/alignment.md gives the reason for each default. Source: Morris 2006, §4.3.
struct ScoreParameters {
  /// Curves over the place on the path (analysis/force_training/score/path_places.h) in place of
  /// time: for participants who set their own pace. Not a key: it follows from the guidance of the
  /// definition.
  bool over_path{false};
  /// The test leaves the hand free, so that the path is a part of what is recalled. Not a key.
  bool free_path{false};
  int samples{1000};         // of the common time base, 2 to 10,000
  double filter_width{0.1};  // box filter on the applied force, 0 to 10 [s]
  AlignmentOptions alignment;
  std::optional<double> window;  // of the alignment, >= 0, in place of alignment.window [s]

  // score = (c C + f R + s S) / (c + f + s), C the alignment cost per pair of the path, R and S the
  // RMS differences of force [N] and slope [N/s] after warping. Not all three may be 0.
  double cost_share{1.0};   // c >= 0
  double force_share{1.0};  // f >= 0 [1/N]
  double slope_share{0.5};  // s >= 0 [s/N]
};

/// The keys of [analysis] that say how a recall is scored.
const Schema<ScoreParameters>& score_schema();

/// Takes the shares that a file states in its table [analysis] into the parameters, as
/// `haptrial judge fit` writes it. @throws InputError for a file without them, or with other keys
ScoreParameters with_shares_of(const std::filesystem::path& file, ScoreParameters parameters);

/// Reads them with what follows from the guidance of a definition.
/// @param analysis  the table of that name in `root`
ScoreParameters read_scoring(Table& root, Table& analysis);

/// The parameters in words and with units, for reports: name, value. Options of the alignment that
/// are as published stay out.
std::vector<std::pair<std::string, std::string>> described(const ScoreParameters& parameters);

/// @throws std::invalid_argument naming the parameter that breaks its bound.
void check(const ScoreParameters& parameters);

}  // namespace haptrial::analysis
