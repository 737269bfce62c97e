#include "analysis/psychophysics/fit/serial_null.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/random.h"

namespace haptrial::analysis::trials {
namespace {

/// The variance of their mean is 1/25 of that of one session: a test over participants loses next
/// to nothing by it.
constexpr int kSessions = 25;
constexpr int kFewest = 8;  // of them that tell something

/// Nobody's track runs longer than the recorded one by this factor.
constexpr std::size_t kLongest = 10;

using Procedures = std::vector<std::unique_ptr<psychometric::Procedure>>;

class Rerun {
 public:
  Rerun(const SerialRecord& record, RandomStream& random) : record_(record), random_(random) {
    for (const SerialTrack& track : record.adaptive) {
      procedures_.push_back(track.begin());
    }
  }

  std::vector<SerialTrial> trials() {
    for (std::size_t i = 0; i < record_.trials.size(); ++i) {
      answer(i, false);
    }
    // Tracks that are not finished go on in the order of their trials.
    for (std::size_t round = 1; round < kLongest && unfinished(); ++round) {
      for (std::size_t i = 0; i < record_.trials.size(); ++i) {
        answer(i, true);
      }
    }
    return std::move(trials_);
  }

 private:
  bool unfinished() const {
    for (std::size_t t = 0; t < procedures_.size(); ++t) {
      if (record_.adaptive[t].finished && !procedures_[t]->finished()) {
        return true;
      }
    }
    return false;
  }

  /// @param further  after the recorded session's end
  void answer(std::size_t i, bool further) {
    SerialTrial trial = record_.trials[i];
    const auto& function = record_.functions[trial.series];
    psychometric::Procedure* procedure = nullptr;
    if (const int track = record_.tracks[i]; track >= 0) {
      procedure = procedures_[static_cast<std::size_t>(track)].get();
      if (procedure->finished() ||
          (further && !record_.adaptive[static_cast<std::size_t>(track)].finished)) {
        return;
      }
      trial.level = procedure->next().front();
    } else if (further) {
      return;
    }
    if (!function) {
      return;
    }
    trial.outcome = random_.uniform() < (*function)(trial.level) ? 1 : 0;
    trial.choice = trial.outcome == 1 ? trial.side : -trial.side;
    if (procedure != nullptr) {
      procedure->report(trial.outcome, {trial.level});
    }
    trials_.push_back(trial);
  }

  const SerialRecord& record_;
  RandomStream& random_;
  Procedures procedures_;
  std::vector<SerialTrial> trials_;
};

SerialFunctions fitted_anew(const std::vector<SerialTrial>& trials, std::size_t series,
                            const LikelihoodOptions& options) {
  std::vector<std::vector<TrialBlock>> blocks(series);
  for (const SerialTrial& trial : trials) {
    if (std::isfinite(options.function.axis.at(trial.level))) {
      blocks[trial.series].push_back({nine_digits(trial.level), trial.outcome, 1});
    }
  }
  SerialFunctions functions(series);
  for (std::size_t i = 0; i < series; ++i) {
    if (blocks[i].empty()) {
      continue;
    }
    const std::vector<TrialBlock> levels = pooled(blocks[i]);
    if (levels.size() < 2) {
      continue;
    }
    const LikelihoodFit fit = likelihood_fit(levels, options);
    if (!fit.undetermined) {
      functions[i] = fitted_function(options.function, fit.parameters);
    }
  }
  return functions;
}

/// A running mean of what is defined.
struct Mean {
  double sum{0.0};
  double squares{0.0};
  int count{0};

  void add(const Defined<double>& value) {
    if (value) {
      sum += *value;
      squares += *value * *value;
      ++count;
    }
  }
  /// Standard error of value().
  double error() const {
    const double n = count;
    return std::sqrt(std::max(0.0, squares - sum * sum / n) / (n - 1.0) / n);
  }
  Defined<double> value() const {
    if (count < kFewest) {
      return Undefined{"too few sessions of such observers tell serial effects"};
    }
    return sum / count;
  }
};

}  // namespace

SerialCoefficients serial_coefficients_by_chance(const SerialRecord& record,
                                                 const LikelihoodOptions& options,
                                                 std::uint64_t seed) {
  RandomStream random(seed, "serial effects");
  Mean drift, repetition;
  for (int i = 0; i < kSessions; ++i) {
    const std::vector<SerialTrial> trials = Rerun(record, random).trials();
    const SerialCoefficients found =
        serial_coefficients(trials, fitted_anew(trials, record.functions.size(), options));
    drift.add(found.drift);
    repetition.add(found.repetition);
  }
  return {drift.value(), repetition.value(), drift.error(), repetition.error()};
}

}  // namespace haptrial::analysis::trials
