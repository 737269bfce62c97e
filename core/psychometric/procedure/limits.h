#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/psychometric/function/axis.h"
#include "core/psychometric/procedure/procedure.h"

namespace haptrial::psychometric {

struct LimitsParameters {
  Axis axis;
  double low{0.0}, high{1.0};   // low < high [level]
  double step{0.1};             // > 0, on the axis
  int series{8};                // >= 1, of both directions together
  bool descending_first{true};  // else the first series ascends; then they take turns
  int start_steps{3};           // >= 0: the most steps from its end at which a series begins
};

/// The method of limits (Fechner 1860): series that descend from the upper end of the range until
/// the first answer 0, and that ascend from the lower one until the first answer 1, in turn. A
/// series begins at a place drawn near its end, so that steps cannot be counted. Its threshold is
/// the middle between its last two levels on the axis. A series whose first answer is the last, or
/// that reaches the other end without a change, has none.
///
/// A series goes on from the level that was presented, so estimates follow from the outcomes alone.
/// Estimate: the mean of the series' thresholds, or of the means of both directions if each has
/// two or more, with its standard error by the scatter within directions. It is not the level with
/// answers 1 in half of the trials: coarser steps and wider functions move series of either
/// direction towards where they begin, and the mean of both keeps what of it is even.
class Limits final : public Procedure {
 public:
  /// @param seed, name  of the stream that draws where series begin
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  Limits(const LimitsParameters& parameters, std::uint64_t seed, std::string_view name);

  const Level& next() const override;
  void report(double answer, const Level& applied) override;
  bool finished() const override { return done_ == parameters_.series; }
  std::vector<Estimate> estimates() const override;
  std::optional<LevelRange> range() const override {
    return LevelRange{parameters_.low, parameters_.high};
  }

  /// Presentations of one series at most.
  static int longest_series(const LimitsParameters& parameters);

 private:
  bool descends() const { return (done_ % 2 == 0) == parameters_.descending_first; }
  void begin();
  void end_series(std::optional<double> threshold);

  LimitsParameters parameters_;
  std::uint64_t seed_;
  std::string name_;
  Level next_;
  std::optional<double> before_;                // last level of this series [axis]
  std::vector<double> descending_, ascending_;  // thresholds [axis]
  int done_{0};                                 // series
  int without_{0};                              // of them without a threshold
};

}  // namespace haptrial::psychometric
