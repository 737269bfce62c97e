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

/// All combinations of one value a list, the last list's value changing fastest.
std::vector<Level> combinations(const std::vector<std::vector<double>>& lists);

/// The posterior, given answers, of the threshold of one variable as a smooth function of up to
/// three others, without a formula:
///
///     P(1) = guess + (1 - guess - lapse) Phi(f)
///
/// f is a straight slope and a Gaussian process over the levels' places in their lists. How
/// smooth and how steep it is, is not known: nine beliefs stand beside each other, each weighted by
/// how well it foretold the answers. A variable that rises has slopes above 0 all over.
class SurfacePosterior {
 public:
  struct Belief {
    SmoothBelief of_terms;
    double evidence{0.0};  // log probability of the answers, each foretold
    double weight{1.0};    // of all beliefs 1
  };

  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  explicit SurfacePosterior(const SurfaceParameters& parameters);

  /// Takes in an answer to a level. @returns how it changed each belief
  std::vector<SmoothBelief::Visit> report(bool answer, const Level& level);

  /// With the target that is meant.
  const SurfaceParameters& parameters() const noexcept { return parameters_; }
  double f_at_target() const noexcept { return f_at_target_; }
  const std::vector<Belief>& beliefs() const noexcept { return beliefs_; }
  /// The terms of f at a level.
  Eigen::VectorXd row_of(const Level& level) const { return basis_.at(place_of(level)); }
  Eigen::Index terms() const noexcept { return basis_.size(); }
  ProbitLink link_of(bool answer) const noexcept;
  /// Whether a belief is so unlikely that estimates and choices leave it out.
  static bool is_unlikely(const Belief& belief) noexcept;

  /// Thresholds of the first variable, by draws from the likely beliefs.
  /// @param others  levels of the other variables
  std::vector<SurfaceThreshold> thresholds(const std::vector<Level>& others) const;
  /// Levels of the other variables at which thresholds are told: their ends and some between.
  std::vector<Level> told_at() const;

 private:
  std::vector<double> place_of(const Level& level) const;
  void begin_beliefs();
  void weigh();
  std::vector<Belief> refined() const;
  Eigen::MatrixXd rows_along(const std::vector<Level>& others) const;
  Eigen::MatrixXd drawn_thresholds(const std::vector<Level>& others) const;
  Eigen::VectorXd thresholds_of(const Eigen::VectorXd& f) const;

  SurfaceParameters parameters_;
  SmoothBasis basis_;
  double f_at_target_;
  std::vector<Eigen::VectorXd> rises_;  // rows of slopes that are above 0
  std::vector<Eigen::VectorXd> shown_;  // rows of the trials
  std::vector<bool> answers_;
  std::vector<Belief> beliefs_;
};

}  // namespace haptrial::psychometric
