#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/psychometric/procedure/procedure.h"
#include "core/psychometric/procedure/smooth_function.h"

namespace haptrial::psychometric {

struct SurfaceVariable {
  std::string name;
  std::vector<double> levels;  // 2 or more, rising; evenly spaced they need not be
  bool rises{false};           // answers 1 get no rarer as it rises; so it is of the first one
};

struct SurfaceParameters {
  std::vector<SurfaceVariable> variables;  // 1 to 4; thresholds are of the first one
  /// Probability at a threshold, between guess and 1 - lapse; 0: halfway between them.
  double target{0.0};
  double guess{0.0};   // probability of an answer 1 without a stimulus
  double lapse{0.02};  // of an answer 0 to the clearest one
  int trials{80};      // >= 1
  /// Whether a device can present the level; empty: all.
  std::function<bool(const Level&)> allowed{};
};

/// A threshold of the first variable, and its central 95 %: infinite beyond the levels.
struct SurfaceThreshold {
  double median, low, high;
};

/// The threshold of one variable as a smooth function of up to three others, without a formula:
///
///     P(1) = guess + (1 - guess - lapse) Phi(f)
///
/// f is a straight slope and a Gaussian process over the levels' places in their lists. How
/// smooth and how steep it is, is not known: nine beliefs stand beside each other, each weighted by
/// how well it foretold the answers. A variable that rises has slopes above 0 all over. The next
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
  bool finished() const override { return trials_ >= parameters_.trials; }
  std::vector<Estimate> estimates() const override;
  std::optional<double> target() const override { return parameters_.target; }
  std::optional<LevelRange> range() const override;

  /// Thresholds of the first variable. @param others  levels of the other variables
  std::vector<SurfaceThreshold> thresholds(const std::vector<Level>& others) const;
  const SurfaceParameters& parameters() const noexcept { return parameters_; }

 private:
  /// A belief, and what it says of every level that may come next.
  struct Candidate {
    SmoothBelief belief;
    double evidence{0.0};  // log probability of the answers, each foretold
    double weight{1.0};
    Eigen::VectorXd mean, variance;  // of f at the levels
  };
  std::vector<double> place_of(const Level& level) const;
  ProbitLink link_of(bool answer) const noexcept;
  void list_levels();
  void begin_beliefs();
  void weigh();
  void choose();
  /// How unsure each level's side of the threshold is, 0 to 1/4.
  Eigen::VectorXd doubt() const;
  std::vector<Eigen::Index> doubtful() const;
  double doubt_after(const Candidate& by, Eigen::Index level, const Eigen::ArrayXd& shared) const;
  std::vector<Candidate> refined() const;
  std::vector<Level> told_at() const;
  Eigen::MatrixXd drawn_thresholds(const std::vector<Level>& others) const;
  Eigen::VectorXd thresholds_of(const Eigen::VectorXd& f) const;
  std::string name_of(const Level& others) const;

  SurfaceParameters parameters_;
  SmoothBasis basis_;
  double at_target_;                  // f
  std::vector<Level> levels_;         // that may be presented
  Eigen::MatrixXd rows_;              // (levels x terms)
  std::vector<Eigen::Index> judged_;  // levels by which a choice is judged
  Eigen::MatrixXd judged_rows_;
  std::vector<Eigen::VectorXd> rises_;  // rows of slopes that are above 0
  std::vector<Eigen::VectorXd> shown_;  // rows of the trials
  std::vector<bool> answers_;
  std::vector<Candidate> candidates_;
  Level next_;
  int trials_{0};
};

}  // namespace haptrial::psychometric
