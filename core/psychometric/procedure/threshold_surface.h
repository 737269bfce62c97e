#pragma once

#include <string>
#include <vector>

#include "core/psychometric/procedure/procedure.h"
#include "core/psychometric/procedure/surface_posterior.h"

namespace haptrial::psychometric {

/// Finds the threshold of one variable as a smooth function of up to three others. The next
/// stimulus is the one after whose answer the fewest levels are expected on the wrong side of the
/// threshold, of those nearest to it (Letham et al. 2022, AISTATS).
///
/// Estimates: the threshold at a few levels of the other variables, the median of the belief with
/// its central 95 %; open where more than 2.5 % of it find none in the range.
class ThresholdSurface final : public Procedure {
 public:
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  explicit ThresholdSurface(const SurfaceParameters& parameters);

  const Level& next() const override;
  void report(double answer, const Level& applied) override;
  bool finished() const override { return trials_ >= parameters().trials; }
  std::vector<Estimate> estimates() const override;
  std::optional<double> target() const override { return parameters().target; }
  std::optional<LevelRange> range() const override;

  /// Thresholds of the first variable. @param others  levels of the other variables
  std::vector<SurfaceThreshold> thresholds(const std::vector<Level>& others) const {
    return posterior_.thresholds(others);
  }
  /// The posterior after the answers so far, without the choice of a stimulus.
  const SurfacePosterior& posterior() const noexcept { return posterior_; }
  const SurfaceParameters& parameters() const noexcept { return posterior_.parameters(); }

 private:
  /// Figures of a belief for every level that may come next.
  struct PredictedLevels {
    Eigen::VectorXd mean, variance;  // of f at the levels
  };
  void list_levels();
  void foretell();
  void choose();
  /// How unsure each level's side of the threshold is, 0 to 1/4.
  Eigen::VectorXd doubt() const;
  std::vector<Eigen::Index> doubtful() const;
  double doubt_after(const PredictedLevels& by, Eigen::Index level,
                     const Eigen::ArrayXd& shared) const;
  std::string name_of(const Level& others) const;

  SurfacePosterior posterior_;
  std::vector<Level> levels_;         // that may be presented
  Eigen::MatrixXd rows_;              // (levels x terms)
  std::vector<Eigen::Index> judged_;  // levels by which a choice is judged
  Eigen::MatrixXd judged_rows_;
  std::vector<PredictedLevels> foretold_;  // by each belief of the posterior
  Level next_;
  int trials_{0};
};

}  // namespace haptrial::psychometric
