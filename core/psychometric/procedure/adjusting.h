#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/psychometric/function/axis.h"
#include "core/psychometric/procedure/procedure.h"
#include "core/psychometric/procedure/shuffled.h"

namespace haptrial::psychometric {

struct AdjustingParameters {
  ListParameters starts;           // levels at which adjustments begin
  std::vector<double> steps{1.0};  // > 0, on the axis; the next one after each turn
  Axis axis;
  double low{0.0}, high{1.0};  // the level is kept between them; low < high
  int most_presentations{60};  // of one adjustment; then it ends without a setting
};

/// Method of adjustment, and of matching, a presentation at a time: after each the participant says
/// whether the level is to rise (1), to fall (-1), or is left as it is (0). That one is the
/// setting, and the next adjustment begins at its own start. At every turn the steps get finer.
/// Estimate: the mean of the settings, with its standard error. Settings from above end higher than
/// those from below. With two or more of either kind the estimate is the mean of the means of both
/// sides, and its error has only the scatter within them. An adjustment began at the level that was
/// first presented, so estimates follow from the outcomes alone, whatever order the starts had.
class Adjusting final : public Procedure {
 public:
  /// @param seed, name  of the stream that shuffles the starts
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  Adjusting(const AdjustingParameters& parameters, std::uint64_t seed, std::string_view name);

  const Level& next() const override;
  void report(double answer, const Level& applied) override;
  bool finished() const override { return at_ == starts_.size(); }
  std::vector<Estimate> estimates() const override;

  const std::vector<double>& settings() const noexcept { return settings_; }

 private:
  void begin();

  AdjustingParameters parameters_;
  std::vector<double> starts_;
  std::vector<double> settings_;
  std::vector<bool> from_above_;  // (settings) whether the start lay above the setting
  std::size_t at_{0};             // of starts_
  Level level_;
  double began_{0.0};    // level first presented in this adjustment
  std::size_t step_{0};  // of the parameters' steps
  int direction_{0};     // of the last step; 0: none yet
  int presentations_{0};
  int given_up_{0};
};

}  // namespace haptrial::psychometric
