#pragma once

#include "core/psychometric/procedure/procedure.h"
#include "core/psychometric/procedure/staircase_rule.h"

namespace haptrial::psychometric {

/// A staircase: n-down/m-up, weighted, with separate sizes of steps up and down, schedules of steps
/// by reversal or trial, and bounds (staircase_rule.h).
///
/// Its estimate is a mean or median on the axis of the levels that were really applied, given as a
/// level. The deviation that estimates() states is the standard error of the middles of consecutive
/// pairs of reversals (Wetherill and Levitt 1965) and counts them as independent; it is absent with
/// fewer than two pairs and for a mean of levels. predict_staircase() has what holds exactly.
class Staircase final : public Procedure {
 public:
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  explicit Staircase(const StaircaseParameters& parameters);

  const Level& next() const override;
  void report(double answer, const Level& applied) override;
  bool finished() const override { return stopped(parameters_, state_); }
  std::vector<Estimate> estimates() const override;
  /// Probability at which the last steps balance, if one wrong answer makes a step.
  std::optional<double> target() const override;
  std::optional<LevelRange> range() const override {
    return LevelRange{parameters_.low, parameters_.high};
  }
  bool has_reversals() const override { return true; }
  std::optional<int> counted_reversals() const override { return state_.reversals; }

  const StaircaseState& state() const noexcept { return state_; }
  /// Levels of the reversals so far.
  std::vector<double> reversals() const;

 private:
  std::vector<double> chosen() const;

  StaircaseParameters parameters_;
  StaircaseState state_;
  Level next_;
  std::vector<double> reversals_;  // x of them [axis]
  std::vector<double> applied_;    // x of all trials [axis]
};

}  // namespace haptrial::psychometric
