#pragma once

#include "core/psychometric/function/axis.h"
#include "core/psychometric/procedure/procedure.h"

namespace haptrial::psychometric {

struct PestParameters {
  Axis axis;          // of the steps
  double start{0.0};  // low <= start <= high [level]
  double low{0.0};    // bounds of the level, low < high [level]
  double high{1.0};
  double target{0.75};         // share of right answers that is sought, 0 < target < 1
  double deviation{1.0};       // of the count of right answers that is tolerated, W > 0
  double first_step{0.1};      // smallest < first_step <= largest [unit of the axis]
  double smallest_step{0.01};  // a step as small as this ends the track, > 0 [unit of the axis]
  double largest_step{0.4};    // [unit of the axis]
  int stop_trials{200};        // 1 to 1,000,000
  bool right_raises{false};    // harder is a higher level
};

/// PEST: parameter estimation by sequential testing (Taylor and Creelman 1967, JASA 41).
///
/// A level is kept until the count of right answers among the T trials on it leaves
/// target T ± deviation (Wald's sequential test). Then a step is made: half of the last one after a
/// reversal; the second step in a direction is as large as the first; the third is doubled unless
/// the step before the last reversal came from a doubling; the fourth and later ones are doubled.
/// When a step would not exceed smallest_step the track ends, and the level that this step leads to
/// is the estimate; with too many trials it ends without an estimate. A step goes from the level
/// that was really applied last.
class Pest final : public Procedure {
 public:
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  explicit Pest(const PestParameters& parameters);

  const Level& next() const override;
  void report(double answer, const Level& applied) override;
  bool finished() const override { return converged_ || trials_ >= parameters_.stop_trials; }
  /// The level that PEST settled on, without a deviation; none before it has.
  std::vector<Estimate> estimates() const override;
  std::optional<double> target() const override { return parameters_.target; }
  std::optional<LevelRange> range() const override {
    return LevelRange{parameters_.low, parameters_.high};
  }
  bool has_reversals() const override { return true; }

 private:
  void step(int way);

  PestParameters parameters_;
  Level next_;
  double x_{0.0};        // of the level asked for, then of the last applied [axis]
  double size_;          // of the last step [axis]
  int direction_{0};     // of the last step
  int in_direction_{0};  // steps since the last reversal, its own among them
  bool doubled_{false};  // the last step
  bool doubled_before_reversal_{false};
  int trials_{0};
  int trials_here_{0};
  int right_here_{0};
  bool converged_{false};
};

}  // namespace haptrial::psychometric
