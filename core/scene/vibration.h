#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "core/scene/field_state.h"

namespace haptrial::scene {

class SineVibration;
class NoiseVibration;
class Tap;

struct SineVibrationParameters {
  using Law = SineVibration;
  Eigen::Vector3d direction{Eigen::Vector3d::UnitY()};  // u, any length above 0
  double amplitude{0.5};                                // A >= 0 [N]
  double frequency{100.0};                              // above 0, below half the loop's rate [Hz]
  double phase{0.0};                                    // when it is switched on [rad]

  StiffnessBound bound() const { return {}; }
  FieldTraits traits() const { return {}; }
};

/// The amplitude of a vibration that goes on with other numbers: it goes over to its own within 50
/// ms, as a step of it would be felt as a knock.
class Amplitude {
 public:
  Amplitude(const Eigen::Vector3d& own, double rate) noexcept : own_(own), step_(20.0 / rate) {}
  void start() noexcept { left_ = 0.0; }
  void adopt(const Amplitude& before) noexcept {
    from_ = before.now();
    left_ = from_ == own_ ? 0.0 : 1.0;
  }
  Eigen::Vector3d next() noexcept {
    const Eigen::Vector3d amplitude = now();
    left_ = std::max(left_ - step_, 0.0);
    return amplitude;
  }

 private:
  Eigen::Vector3d now() const noexcept {
    return left_ > 0.0 ? Eigen::Vector3d(own_ + left_ * left_ * (3.0 - 2.0 * left_) * (from_ - own_))
                       : own_;
  }

  Eigen::Vector3d own_;
  double step_;  // a tick's share of the way
  Eigen::Vector3d from_{Eigen::Vector3d::Zero()};
  double left_{0.0};  // of the way from there, 1 to 0
};

/// f(t) = A sin(2 pi frequency t + phase) u. Active, as all vibrations.
class SineVibration {
 public:
  SineVibration(const SineVibrationParameters& parameters, const Setting& setting);
  void start(const PointState&) noexcept {
    phase_ = first_phase_;
    amplitude_.start();
  }
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;
  /// Goes on where the one before is.
  void adopt(const SineVibration& before) noexcept;

 private:
  Amplitude amplitude_;
  double angular_;
  double first_phase_;
  double phase_;
  double time_{0.0};  // of the last tick [s]
};

struct NoiseVibrationParameters {
  using Law = NoiseVibration;
  Eigen::Vector3d direction{Eigen::Vector3d::UnitY()};  // u, any length above 0
  double rms{0.3};                                      // root mean square >= 0 [N]
  double lowest{50.0};                                  // of the band > 0 [Hz]
  double highest{150.0};                                // above lowest, below half the rate [Hz]
  std::uint64_t seed{1};

  StiffnessBound bound() const { return {}; }
  FieldTraits traits() const { return {}; }
};

/// f(t) = rms sqrt(2 / kTones) sum of sin(2 pi f_i t + phi_i) u: one tone drawn from each of kTones
/// equal parts of the band. Nothing lies outside of the band; the same for the same seed.
class NoiseVibration {
 public:
  static constexpr std::size_t kTones = 32;

  NoiseVibration(const NoiseVibrationParameters& parameters, const Setting& setting);
  void start(const PointState&) noexcept {
    phasors_ = first_;
    amplitude_.start();
  }
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;
  void adopt(const NoiseVibration& before) noexcept {
    phasors_ = before.phasors_;
    amplitude_.adopt(before.amplitude_);
  }

 private:
  struct Phasors {
    std::array<double, kTones> sine;
    std::array<double, kTones> cosine;
  };
  Amplitude amplitude_;  // of one tone
  Phasors first_;
  Phasors phasors_;
  Phasors step_;  // of a tick
};

struct TapParameters {
  using Law = Tap;
  std::string on;  // a surface field whose contact sets it off; empty: switching on does
  Eigen::Vector3d direction{Eigen::Vector3d::UnitY()};  // u in free space; on a surface its normal
  double amplitude{1.0};    // A >= 0, in free space [N], on a surface per impact speed [N·s/m]
  double frequency{200.0};  // above 0, below half the loop's rate [Hz]
  double decay{0.01};       // time constant > 0 [s]

  StiffnessBound bound() const { return {}; }
  FieldTraits traits() const { return {.timed = on.empty()}; }
};

/// f(t) = A exp(-t / decay) sin(2 pi frequency t) u, t from the tap on. On a surface A grows with
/// the speed of the impact (Okamura, Cutkosky and Dennerlein 2001).
class Tap {
 public:
  Tap(const TapParameters& parameters, const Setting& setting);
  void start(const PointState& hand) noexcept;
  Eigen::Vector3d force(const Felt& felt, FieldState& state) noexcept;
  void adopt(const Tap& before) noexcept;

 private:
  double amplitude_;
  double angular_;
  double decay_;
  bool on_surface_;
  Eigen::Vector3d direction_;
  double strength_{0.0};  // of the last tap [N]
  double began_{0.0};     // [s]
  bool touching_{false};
};

}  // namespace haptrial::scene
