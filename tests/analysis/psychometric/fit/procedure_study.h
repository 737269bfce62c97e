#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/psychometric/fit/bayesian_fit.h"
#include "analysis/psychometric/fit/profile_interval.h"

namespace haptrial::test {

/// A virtual observer: cumulative Gaussian, on a linear axis.
struct Truth {
  double threshold{0.0};  // the level of S = 1/2; in [-1, 1]
  double sigma{1.0};      // in [0.7, 1.4]
  double lapse{0.02};
};

/// An estimate with its 95 % interval, if there is one, and the number that it is meant for.
struct Found {
  double value{0.0};
  double truth{0.0};
  bool interval{false};
  double low{0.0}, high{0.0};
};

/// Results of a session.
struct Session {
  int trials{0};
  std::optional<Found> natural;              // the procedure's own estimate
  std::optional<Found> width;                // likewise, on a logarithmic scale
  std::vector<analysis::TrialBlock> blocks;  // to be fitted; empty: nothing is fitted
  bool adaptive{false};                      // the levels depended on the answers
  analysis::Task task{analysis::Task::kForcedChoice};
};

/// A procedure with the way its sessions are run.
struct ProcedureStudy {
  std::string name;
  std::string meant;  // what its own estimate is meant for
  std::function<Session(const Truth&, std::uint64_t seed)> run;
};
std::vector<ProcedureStudy> procedure_studies();

/// Errors of estimates and how often their intervals hold the truth.
struct Tally {
  std::vector<double> errors;  // of those that exist
  int observers{0}, held{0}, open{0};

  void add(const Found& found);
  double coverage() const { return static_cast<double>(held) / observers; }
  double bias() const;
  double deviation() const;
};

struct StudyResult {
  double trials{0.0};            // mean
  Tally natural, natural_width;  // errors of widths: ln(found / true)
  Tally threshold, width;        // the fit with the intervals that a report states
  Tally profile, profile_width;  // with those of the profile likelihood
  Tally bayesian, bayesian_width;
  int undetermined{0};  // fits; their errors are left out, their intervals count
};

/// @param observers  numbers 0 .. observers - 1, each with its own random streams
/// @param bayesian   how many, from the first on, also have the beta-binomial fit (0.3 s each)
StudyResult run_study(const ProcedureStudy& study, int observers, int threads, int bayesian = 0);

}  // namespace haptrial::test
