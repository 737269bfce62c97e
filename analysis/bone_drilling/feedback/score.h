#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis::drilling {

/// A predictor of a score: a metric, or a figure of what was achieved.
struct ScoreMetric {
  std::string name;            // of metric_kinds(), or a column of figures_of()
  std::string title, unit;     // for people
  double mean{0.0};            // in the study
  double scale{0.0};           // its standard deviation there > 0
  double slope{0.0};           // points by standard deviation
  double low{0.0}, high{0.0};  // least and greatest value in the study
};

/// Raters' scores as predicted from metrics, for procedures on the case that they were learned on.
/// Source: Morris 2006, §8.3.3.3.
struct ScoreModel {
  std::string study;  // name of the definition
  std::size_t participants{0}, procedures{0}, raters{0};
  bool simulated{false};  // a participant or a rater was a program
  int version{kMetricsVersion};
  double intercept{0.0};   // the study's mean rating
  double half_width{0.0};  // of the 95 % interval of one procedure's rating [points]
  double r{0.0};           // of ratings and predictions for participants left out
  std::vector<ScoreMetric> metrics;
  std::vector<std::string> bones;            // digests of bone_digest()
  std::map<std::string, std::string> rules;  // what else makes a case, by key: score_rules()
};

/// A procedure of the study that the score is learned on.
struct RatedSummary {
  ProcedureSummary summary;
  double rating{0.0};  // mean over raters
};

/// Ridge regression onto the ratings, cross-validated by participant, of all metrics that need no
/// other procedures and all figures of what was achieved. Half of the interval is t(0.975, n - 1)
/// times the root mean square error for participants left out, of whom there are n.
/// Undefined as cross_validated_ridge() is. Names, bones and rules are left to the caller.
Defined<ScoreModel> learn_score(std::span<const RatedSummary> procedures);

/// Points that one metric adds to the study's mean rating, or takes away.
struct ScorePart {
  std::string title, unit;
  double value{0.0};
  double points{0.0};
  bool outside{false};  // of the values of the study
};

struct Score {
  double value{0.0}, low{0.0}, high{0.0};  // within the raters' scale
  std::vector<ScorePart> parts;            // what lowered it most comes first
};

/// @returns undefined, with the reason in half a sentence, where the case, the version of the
/// metrics or a missing value forbids a score
/// @param rules  as ScoreModel has them
Defined<Score> score_of(const ScoreModel& model, const ProcedureSummary& summary,
                        const std::map<std::string, std::string>& rules);

/// Labels, densities, structures and grid of a bone in 64 hexadecimal digits.
std::string bone_digest(const bone::BoneModel& bone);

/// As a file (JSON).
std::string score_model_text(const ScoreModel& model);
/// @throws InputError for a file that score_model_text() did not write.
ScoreModel read_score_model(const std::filesystem::path& file);

/// A section of a page, as HTML.
std::string score_section(const ScoreModel& model, const Defined<Score>& score);

}  // namespace haptrial::analysis::drilling
