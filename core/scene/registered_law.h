#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "core/scene/field_state.h"

namespace haptrial::scene {

class RegisteredField;

/// A law of force that is made outside of the program. Made before a trial, on any thread; all of
/// its functions belong to the servo thread: no allocation, lock, I/O or throw, and done in a few
/// microseconds, since nothing interrupts them and a late force is felt.
class RegisteredLaw {
 public:
  virtual ~RegisteredLaw() = default;
  /// The field is switched on: its filters and memories begin anew.
  virtual void start(const PointState& hand) noexcept { static_cast<void>(hand); }
  /// One tick. The scene limits, fades and records what comes back, and makes it weaker where the
  /// handle does not carry its stiffness. `state` takes depth, velocity, normal, done and stimulus,
  /// if the law has them; dampers use `felt.shares.damping` of theirs.
  /// @returns the force on the hand, in W [N]; one that is not finite counts as zero
  virtual Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept = 0;
  /// Goes on where the same field of the trial before stood. @param before  of the same type
  virtual void adopt(const RegisteredLaw& before) noexcept { static_cast<void>(before); }
};

/// The numbers of such a field, as its reader took them from the definition.
class RegisteredNumbers {
 public:
  virtual ~RegisteredNumbers() = default;
  /// @throws std::invalid_argument naming the number that breaks its bound
  virtual std::unique_ptr<RegisteredLaw> law(const Setting& setting) const = 0;
  /// How steep the force is, for checks of light hands; by default nothing is known of it.
  virtual StiffnessBound bound() const { return {}; }
  /// By default a field whose force works on the hand.
  virtual FieldTraits traits() const { return {}; }
};

struct RegisteredParameters {
  using Law = RegisteredField;
  std::string type;                                  // the word of the definition
  std::shared_ptr<const RegisteredNumbers> numbers;  // not null

  StiffnessBound bound() const { return numbers->bound(); }
  FieldTraits traits() const;
};

/// Such a law among those of a scene.
class RegisteredField {
 public:
  RegisteredField(const RegisteredParameters& parameters, const Setting& setting);

  void start(const PointState& hand) noexcept { law_->start(hand); }
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;
  void adopt(const RegisteredField& before) noexcept;

 private:
  std::string type_;
  std::unique_ptr<RegisteredLaw> law_;
};

}  // namespace haptrial::scene
