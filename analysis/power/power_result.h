#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/power/binomial.h"

namespace haptrial::analysis {

/// Mean and spread of numbers that come one by one.
struct RunningMean {
  std::size_t count{0};
  double mean{0.0};
  double squares{0.0};  // sum of squared deviations

  void add(double value);
  double deviation() const;  // standard deviation; 0 of fewer than two
  double error() const;      // standard error of the mean, likewise
};

/// How often a test was below alpha.
struct TestCount {
  std::size_t rejected{0};
  std::size_t made{0};  // replications in which it could be made
};

/// Counts of the replications of a cell.
struct CellCounts {
  std::size_t replications{0};
  std::map<std::string, TestCount> tests;      // by name
  std::map<std::string, RunningMean> values;   // on the report's scale
  std::map<std::string, std::size_t> reasons;  // of what failed
  RunningMean hours;                           // in the lab
  std::uint64_t trials{0};

  /// The counts of a test; zeros for one without an entry.
  TestCount of(const std::string& test) const;
};

/// Studies with one combination of the levels.
struct PowerCell {
  std::vector<double> levels;          // (keys)
  CellCounts counts;                   // at the depth of the question
  std::optional<CellCounts> sessions;  // in full, where the depth was checked
};

/// A key that was varied.
struct PowerKey {
  std::string name;
  std::optional<double> none;  // without an effect; nothing: it makes none
};

/// Result of a simulation of power. Every participant is simulated.
struct PowerResult {
  std::string title;  // of the experiment
  std::string watch;  // the test
  double alpha{0.05};
  double target{0.8};
  bool in_full{false};  // sessions; else responses
  std::uint64_t seed{1};
  std::string program;   // with its version
  std::string question;  // definition and [power], word for word
  std::vector<PowerKey> keys;
  std::vector<PowerCell> nulls;  // without an effect
  std::vector<PowerCell> cells;

  /// Place of the number of participants among the keys.
  std::optional<std::size_t> participants() const;
};

/// Coverage of the band in which rejections without an effect should lie.
inline constexpr double kNullBand = 0.99;

/// Whether a test keeps its level in every cell without an effect.
enum class Level { kKept, kAbove, kBelow, kUnknown };
Level level_of(const PowerResult& result, const std::string& test);
/// The same in one cell.
Level level_in(const PowerCell& cell, const std::string& test, double alpha);

/// Whether rejections may be called power: the watched test is known not to exceed its level. A
/// p value that is adjusted for other tests, or of few ranks, rejects less often than the level.
bool is_power(const PowerResult& result);

/// "design.participants 12, observer.drift 0.01".
std::string words_of(const PowerResult& result, const PowerCell& cell);

}  // namespace haptrial::analysis
