#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/tests/t_tests.h"

namespace haptrial::analysis {

/// One trial's metric.
struct TrialValue {
  std::size_t participant{0};   // any numbers
  std::size_t trial{0};         // from 0, in the order of the session
  std::optional<double> value;  // nothing where the metric is not defined
};

/// Means of consecutive trials, as of the eight targets once each.
struct CycleTable {
  std::vector<std::size_t> participants;                   // (participants) rising
  std::vector<std::vector<std::optional<double>>> values;  // (participants x cycles)
  std::size_t cycles() const { return values.empty() ? 0 : values.front().size(); }
};

/// Cycle c of a participant is the mean of the defined values of trials c n .. c n + n - 1, nothing
/// where there is none.
/// @throws std::invalid_argument when n is 0 or a value is not finite.
CycleTable cycle_means(std::span<const TrialValue> trials, std::size_t n);

struct CyclePoint {
  struct Limits {
    double low, high;
  };
  std::size_t participants{0};  // with a value
  double mean{0.0};             // of the participants' means; 0 where there is none
  Defined<Limits> between{Undefined{"there are fewer than two participants"}};
  Defined<Limits> within{Undefined{"there are fewer than two participants"}};
};

/// The mean of each cycle with two intervals. `between` is Student's over participants: how well
/// the mean itself is known. `within` leaves the participants' own levels out: how well the change
/// from cycle to cycle is known. It needs a value of each participant in each cycle.
/// Source: Cousineau 2005, Tutorials in Quantitative Methods for Psychology 1, 42, with the factor
/// cycles / (cycles - 1) of Morey 2008, ibid. 4, 61.
/// @param level  coverage of the intervals, inside (0, 1). @throws std::invalid_argument naming it.
std::vector<CyclePoint> learning_curve(const CycleTable& table, double level = 0.95);

/// Cycles first .. last, both included.
struct CycleRange {
  std::size_t first{0};
  std::size_t last{0};
};

struct CycleContrast {
  TTest test;  // the paired t test over participants, with its interval
  std::size_t participants{0};
  std::size_t left_out{0};  // without a value in one of the sides
};

/// Compares each participant's mean of some cycles with that of others ("the first cycle of
/// adaptation > the last cycle of baseline"), or with 0 where `b` is nothing: paired_t_test.
/// Undefined as that test. @throws std::invalid_argument when a range lies outside of the table.
Defined<CycleContrast> cycle_contrast(const CycleTable& table, CycleRange a,
                                      std::optional<CycleRange> b, Tail tail, double level = 0.95);

}  // namespace haptrial::analysis
