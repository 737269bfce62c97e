#pragma once

#include <Eigen/Core>

#include "core/base/definition/schema_forward.h"

namespace haptrial::subject {

/// One process of adaptation: x' = retention x + learning e.
struct LearningRate {
  double retention{1.0};  // A, 0 to 1
  double learning{0.0};   // B, 0 to 1
};

struct TwoRateParameters {
  LearningRate fast{0.59, 0.21};
  LearningRate slow{0.992, 0.02};
};

/// The tables [observer.adaptation.fast] and [observer.adaptation.slow].
const Schema<TwoRateParameters>& two_rate_schema();

/// Motor adaptation at two rates. After a trial with error e = f - x, with f the disturbance,
///
///     x_f' = A_f x_f + B_f e,   x_s' = A_s x_s + B_s e,   x = x_f + x_s
///
/// in shares of the whole field: x = 1 compensates it. Between two reaches or on the servo thread:
/// no allocation, lock, I/O or throw. Source: Smith, Ghazizadeh and Shadmehr 2006, PLoS Biol. 4.
class TwoRate {
 public:
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  explicit TwoRate(const TwoRateParameters& parameters = {});

  void learn(double error) noexcept;  // after a trial; 0 after an error clamp
  void forget() noexcept { fast_ = slow_ = 0.0; }
  /// Goes on from what was learnt before.
  void recall(double fast, double slow) noexcept {
    fast_ = fast;
    slow_ = slow;
  }

  double state() const noexcept { return fast_ + slow_; }  // x
  double fast() const noexcept { return fast_; }           // x_f
  double slow() const noexcept { return slow_; }           // x_s

  /// The force that compensates what was learnt of a field f = B v.
  /// @param field  B in W [N·s/m]; @param velocity  that is meant (ExplorationController::desired)
  /// in W [m/s]
  /// @returns -x B v [N]
  Eigen::Vector3d compensation(const Eigen::Matrix3d& field,
                               const Eigen::Vector3d& velocity) const noexcept;

 private:
  TwoRateParameters parameters_;
  double fast_{0.0};
  double slow_{0.0};
};

/// The error e of one reach in shares of a field f = B v: what the force on the hand, F, and the
/// arm's compensation, C, leave over along the field's force,
///
///     e = Σ (F + C) · B v / Σ |B v|²
///
/// 1 - x in the field, -x without it, and nearly 0 in a stiff channel, whose walls take up the
/// compensation but for what the hand carries as they give way.
/// Servo thread.
class FieldError {
 public:
  explicit FieldError(const Eigen::Matrix3d& field) noexcept : field_(field) {}

  void begin() noexcept { product_ = square_ = 0.0; }
  /// A tick. @param force  on the hand [N]; @param compensation  [N]; @param velocity  [m/s], in W
  void feel(const Eigen::Vector3d& force, const Eigen::Vector3d& compensation,
            const Eigen::Vector3d& velocity) noexcept;
  double error() const noexcept;  // 0 if the hand did not move

 private:
  Eigen::Matrix3d field_;  // B [N·s/m]
  double product_{0.0};
  double square_{0.0};
};

}  // namespace haptrial::subject
