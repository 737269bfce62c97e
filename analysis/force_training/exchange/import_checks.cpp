#include "analysis/force_training/exchange/import_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "analysis/document/recorded_times.h"
#include "analysis/statistics/design/wording.h"
#include "core/base/alike_names.h"

namespace haptrial::exchange {
namespace {

using analysis::number;

// Bounds that a recording of a hand's force hardly leaves.
constexpr double kStrongest = 100.0;  // [N]
constexpr double kFaintest = 0.01;    // [N]
constexpr std::size_t kFewestRows = 10;
constexpr double kReversed = -0.5;     // correlation
constexpr double kLengthRatio = 1.5;   // of target and applied force
constexpr double kRateRatio = 1.1;     // of a trial and most trials
constexpr double kGapSteps = 20.0;     // in steps of the average length
constexpr double kShortestGap = 0.25;  // [s]

CurveLook look_at(const analysis::TableCurve& curve, const char* name) {
  CurveLook look;
  look.rows = curve.values.size();
  look.duration = duration_of(curve.view(), name);
  look.rate = static_cast<double>(look.rows - 1) / look.duration;
  for (std::size_t k = 1; k < curve.times.size(); ++k) {
    look.gap = std::max(look.gap, curve.times[k] - curve.times[k - 1]);
  }
  const auto [low, high] = std::minmax_element(curve.values.begin(), curve.values.end());
  look.low = *low;
  look.high = *high;
  return look;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value;
  }
  return sum / static_cast<double>(values.size());
}

/// Sums of squares and of products about the means.
std::optional<double> correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const double mean_a = mean_of(a);
  const double mean_b = mean_of(b);
  double aa = 0.0, bb = 0.0, ab = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
    ab += (a[i] - mean_a) * (b[i] - mean_b);
  }
  return aa > 0.0 && bb > 0.0 ? std::optional(ab / std::sqrt(aa * bb)) : std::nullopt;
}

bool is_nearer_reversed(const std::vector<double>& target, const std::vector<double>& applied) {
  double as_it_is = 0.0, reversed = 0.0;
  for (std::size_t i = 0; i < target.size(); ++i) {
    as_it_is += (target[i] - applied[i]) * (target[i] - applied[i]);
    reversed += (target[i] + applied[i]) * (target[i] + applied[i]);
  }
  return reversed < as_it_is;
}

bool is_constant(const CurveLook& look) { return look.high - look.low <= 1e-9 * look.peak(); }

analysis::RecordedTimes recorded(const CurveLook& look) { return {look.duration, look.rate}; }

bool has_odd_times(const CurveLook& look) { return recorded(look).implausible(); }

bool has_gap(const CurveLook& look) {
  return look.gap > kShortestGap && look.gap * look.rate > kGapSteps;
}

std::string times_of(const CurveLook& look) { return recorded(look).words(); }

/// The looks of a study and how to speak of them.
class Warnings {
 public:
  Warnings(const ImportedTrials& trials, std::span<const TrialLook> looks)
      : trials_(trials), looks_(looks) {}

  using Is = std::function<bool(const TrialLook&)>;
  using Shown = std::function<std::string(const TrialLook&)>;

  /// "WARNING: WHAT in 3 of 6 trials (A, trial 1: SHOWN; ...). ADVICE"
  void add(const std::string& what, const Is& is, const Shown& shown, const std::string& advice) {
    constexpr std::size_t kExamples = 3;
    std::size_t count = 0;
    std::string examples;
    for (std::size_t i = 0; i < looks_.size(); ++i) {
      if (is(looks_[i]) && count++ < kExamples) {
        const auto& score = trials_.trials()[i].score;
        examples += fmt::format("{}{}, trial {}: {}", examples.empty() ? "" : "; ", score.subject,
                                score.trial, shown(looks_[i]));
      }
    }
    if (count > 0) {
      sentences_.push_back(fmt::format("WARNING: {} in {} of {} ({}{}).{}{}", what, count,
                                       analysis::counted(looks_.size(), "trial"), examples,
                                       count > kExamples ? "; ..." : "", advice.empty() ? "" : " ",
                                       advice));
    }
  }

  void add(std::string sentence) { sentences_.push_back(std::move(sentence)); }
  std::vector<std::string> take() { return std::move(sentences_); }

 private:
  const ImportedTrials& trials_;
  std::span<const TrialLook> looks_;
  std::vector<std::string> sentences_;
};

std::string both(double target, double applied, const char* unit) {
  return fmt::format("target {} {}, applied {} {}", number(target), unit, number(applied), unit);
}

void warn_of_times(Warnings& warnings) {
  warnings.add(
      analysis::kImplausibleTimes,
      [](const TrialLook& t) { return has_odd_times(t.target) || has_odd_times(t.applied); },
      [](const TrialLook& t) { return times_of(has_odd_times(t.applied) ? t.applied : t.target); },
      analysis::kAreTheyMilliseconds);
  warnings.add(
      "gaps between two rows",
      [](const TrialLook& t) { return has_gap(t.target) || has_gap(t.applied); },
      [](const TrialLook& t) {
        return fmt::format("{} s", number(std::max(t.target.gap, t.applied.gap)));
      },
      "The force in a gap is taken as a straight line.");
  warnings.add(
      "target and applied force of different length",
      [](const TrialLook& t) {
        const auto [low, high] = std::minmax(t.target.duration, t.applied.duration);
        return high > kLengthRatio * low;
      },
      [](const TrialLook& t) { return both(t.target.duration, t.applied.duration, "s"); },
      "The shorter curve is held at its last force until the longer one ends.");
  warnings.add(
      "very few rows",
      [](const TrialLook& t) { return std::min(t.target.rows, t.applied.rows) < kFewestRows; },
      [](const TrialLook& t) {
        return fmt::format("{} rows", std::min(t.target.rows, t.applied.rows));
      },
      "");
}

void warn_of_forces(Warnings& warnings) {
  warnings.add(
      "implausibly large forces",
      [](const TrialLook& t) { return std::max(t.target.peak(), t.applied.peak()) > kStrongest; },
      [](const TrialLook& t) { return both(t.target.peak(), t.applied.peak(), "N"); },
      "Forces are read as newtons; are these millinewtons or grams?");
  const auto is_faint = [](const CurveLook& look) {
    return look.peak() < kFaintest && !is_constant(look);
  };
  warnings.add(
      "implausibly small forces",
      [&](const TrialLook& t) { return is_faint(t.target) || is_faint(t.applied); },
      [](const TrialLook& t) { return both(t.target.peak(), t.applied.peak(), "N"); },
      "Forces are read as newtons; are these kilonewtons or volts?");
  warnings.add(
      "a target force that does not change",
      [](const TrialLook& t) { return is_constant(t.target); },
      [](const TrialLook& t) { return number(t.target.high) + " N"; },
      "Is the target force in another column?");
  warnings.add(
      "an applied force that does not change",
      [](const TrialLook& t) { return is_constant(t.applied) && !t.equal; },
      [](const TrialLook& t) { return number(t.applied.high) + " N"; },
      "Is the applied force in another column?");
  warnings.add(
      "an applied force that equals the target force in every row",
      [](const TrialLook& t) { return t.equal; },
      [](const TrialLook& t) { return fmt::format("{} rows", t.target.rows); },
      "Is one column read as both?");
  warnings.add(
      "an applied force that mirrors the target force",
      [](const TrialLook& t) {
        return t.better_reversed && t.correlation && *t.correlation < kReversed;
      },
      [](const TrialLook& t) { return fmt::format("correlation {:.2f}", *t.correlation); },
      "Does the applied force have the opposite sign?");
}

/// The rate of most trials, and those that have another.
void warn_of_rates(Warnings& warnings, std::span<const TrialLook> looks) {
  std::vector<double> rates;
  for (const TrialLook& look : looks) {
    rates.push_back(look.applied.rate);
  }
  const auto middle = rates.begin() + static_cast<std::ptrdiff_t>(rates.size() / 2);
  std::nth_element(rates.begin(), middle, rates.end());
  const double most = *middle;
  warnings.add(
      "another sampling rate than in most trials",
      [&](const TrialLook& t) {
        return std::max(t.applied.rate, most) > kRateRatio * std::min(t.applied.rate, most);
      },
      [&](const TrialLook& t) {
        return fmt::format("{} rows a second, most {}", number(t.applied.rate), number(most));
      },
      "");
}

/// @param what  "conditions", "participants"
void warn_of_names(Warnings& warnings, const std::string& what,
                   const std::map<std::string, std::size_t>& trials) {
  std::vector<std::string> names;
  for (const auto& [name, count] : trials) {
    names.push_back(name);
  }
  for (std::vector<std::string>& group : alike_names(names)) {
    for (std::string& name : group) {
      name = fmt::format("\"{}\" ({})", name, analysis::counted(trials.at(name), "trial"));
    }
    warnings.add(alike_names_warning(what, group));
  }
}

void warn_of_names(Warnings& warnings, const ImportedTrials& trials) {
  std::map<std::string, std::size_t> subjects;
  std::vector<std::map<std::string, std::size_t>> levels(trials.factors().size());
  for (const ImportedTrial& trial : trials.trials()) {
    ++subjects[trial.score.subject];
    for (std::size_t k = 0; k < levels.size(); ++k) {
      ++levels[k][trial.score.levels[k]];
    }
  }
  for (std::size_t k = 0; k < levels.size(); ++k) {
    warn_of_names(warnings, levels.size() == 1 ? "conditions" : "levels of " + trials.factors()[k],
                  levels[k]);
  }
  warn_of_names(warnings, "participants", subjects);
}

}  // namespace

double CurveLook::peak() const { return std::max(std::abs(low), std::abs(high)); }

TrialLook look_at(const ImportedCurves& curves, const analysis::RecallDetail& detail) {
  TrialLook look;
  look.target = look_at(curves.target, "target");
  look.applied = look_at(curves.applied, "applied");
  look.equal = curves.target.values == curves.applied.values;
  look.correlation = correlation(detail.target, detail.applied);
  look.better_reversed = is_nearer_reversed(detail.target, detail.applied);
  return look;
}

std::string time_warning(const analysis::TableCurve& target, const analysis::TableCurve& applied) {
  const CurveLook first = look_at(target, "the target force");
  const CurveLook second = look_at(applied, "the applied force");
  if (!has_odd_times(first) && !has_odd_times(second)) {
    return "";
  }
  return fmt::format("WARNING: {} (target: {}; applied: {}). {}", analysis::kImplausibleTimes,
                     times_of(first), times_of(second), analysis::kAreTheyMilliseconds);
}

std::vector<std::string> import_warnings(const ImportedTrials& trials,
                                         std::span<const TrialLook> looks) {
  Warnings warnings(trials, looks);
  warn_of_times(warnings);
  warn_of_rates(warnings, looks);
  warn_of_forces(warnings);
  warn_of_names(warnings, trials);
  return warnings.take();
}

}  // namespace haptrial::exchange
