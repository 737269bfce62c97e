#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>

#include "core/scene/field_state.h"
#include "core/scene/surface.h"

namespace haptrial::scene {

class Grating;
class Texture;

/// Ridges across a direction u: h(p) = A profile(u · p / period + phase), each from -1 to 1.
struct GratingParameters {
  using Law = Grating;
  enum class Profile { kSine, kRounded };  // sin, or flat ridges and grooves with soft edges
  std::string on;                          // the surface field that it changes
  Eigen::Vector3d direction{Eigen::Vector3d::UnitX()};  // any length above 0
  double amplitude{0.0003};                             // A, half of peak to peak >= 0 [m]
  double period{0.003};                                 // > 0 [m]
  double phase{0.0};                                    // in periods
  Profile profile{Profile::kSine};

  StiffnessBound bound() const { return {true, 0.0, 0.0}; }
  FieldTraits traits() const { return {.relief = true, .yields = true}; }
  ReliefBound relief_bound() const;
};

/// kRounded is tanh(s sin x) / tanh(s).
inline constexpr double kRoundedSharpness = 3.0;

class Grating {
 public:
  Grating(const GratingParameters& parameters, const Setting& setting);
  /// Adds the height at p, weighted. Servo thread; no allocation, lock, I/O or throw.
  void add(const Eigen::Vector3d& p, double weight, ReliefHere& relief,
           FieldState& state) const noexcept;

  /// Ridges along a way [m].
  double ridges(const Eigen::Vector3d& way) const noexcept;
  double steepest() const noexcept;     // largest |∇h|
  double most_curved() const noexcept;  // bound of the second derivative of h [1/m]
  bool operator==(const Grating&) const = default;

 private:
  Eigen::Vector3d wave_;  // 2 pi u / period [1/m]
  double amplitude_;
  double phase_;  // [rad]
  bool rounded_;
};

/// Roughness: a sum of kWaves sines of equal height whose spatial frequencies fill the band evenly
/// and whose directions and phases are drawn. Exactly band-limited; the same for the same seed.
struct TextureParameters {
  using Law = Texture;
  std::string on;                                    // the surface field that it changes
  Eigen::Vector3d normal{Eigen::Vector3d::UnitY()};  // waves run across it; any length above 0
  double roughness{0.0001};                          // root mean square of h >= 0 [m]
  double lowest{100.0};                              // spatial frequency > 0 [1/m]
  double highest{1000.0};                            // above lowest [1/m]
  std::uint64_t seed{1};

  StiffnessBound bound() const { return {true, 0.0, 0.0}; }
  FieldTraits traits() const { return {.relief = true, .yields = true}; }
  ReliefBound relief_bound() const;
};

class Texture {
 public:
  static constexpr std::size_t kWaves = 24;

  Texture(const TextureParameters& parameters, const Setting& setting);
  void add(const Eigen::Vector3d& p, double weight, ReliefHere& relief,
           FieldState& state) const noexcept;

  /// Ridges along a way [m], on the mean: a sum of sines has as many as one of their root mean
  /// square frequency (Rice 1945).
  double ridges(const Eigen::Vector3d& way) const noexcept;
  double steepest() const noexcept { return steepest_; }
  double most_curved() const noexcept { return most_curved_; }
  bool operator==(const Texture&) const = default;

 private:
  std::array<Eigen::Vector3d, kWaves> waves_;  // [1/m]
  std::array<double, kWaves> phases_;          // [rad]
  double amplitude_;                           // of each wave [m]
  double steepest_{0.0};
  double most_curved_{0.0};
};

}  // namespace haptrial::scene
