#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/contact/evaluation/contact_samples.h"
#include "analysis/contact/recording/block_regression.h"

namespace haptrial::evaluation {

struct StickOptions {
  double least_force{0.2};      // normal force of a contact > 0 [N]
  double slow{0.002};           // below it the contact may stick [m/s]
  double fast{0.010};           // above it the contact slips, > slow [m/s]
  double shortest_stick{0.01};  // [s]
};

/// Ratios at which sticking breaks: |F_t| / F_n for each phase of contact that is slower than
/// `options.slow` for `shortest_stick` or longer and is followed, still in contact, by a sample
/// faster than `options.fast`, before which no sample is slow again. The ratio is negative where
/// F_t points the way that this sample moves, which friction never does. F_t / F_n is the straight
/// line through the last (up to ten) samples of the phase, half a sample after the last one.
/// @param samples  that pass check(); velocities over the period that ends with the sample
std::vector<double> break_away_ratios(const ContactSamples& samples, const StickOptions& options);

/// A grating: height A sin(2π x·axis / wavelength + phase) over the mesh.
struct TextureGrid {
  Eigen::Vector3d axis{Eigen::Vector3d::UnitX()};  // body's frame, unit length
  double wavelength{0.0};                          // > 0 [m]
};

struct IdentificationOptions {
  StickOptions stick{};
  double velocity_noise{0.0};     // of a component; raises `stick.fast` to five times of it [m/s]
  double friction_by_lag{0.0};    // half of an interval: friction that a lag leaves open, 0 or more
  bool lag_like_friction{false};  // a sentence says so
  std::optional<TextureGrid> texture{};
  int blocks{20};      // >= 8; fewer where they would hold less than ten samples
  double level{0.95};  // of all intervals
};

/// Identified parameters of a contact. An interval without bound says that the data do not fix the
/// value.
struct IdentifiedContact {
  std::size_t contact_samples{0};
  std::size_t slip_samples{0};
  std::size_t stick_phases{0};               // that end in slip
  Interval compliance;                       // 1/k [m/N]
  Interval stiffness;                        // k; infinite where the compliance may be 0 [N/m]
  std::optional<Interval> dynamic_friction;  // absent without slip
  std::optional<Interval> static_friction;   // absent without phases of sticking
  std::optional<Interval> texture;           // amplitude A; absent unless asked for [m]
  std::vector<std::string> confounded;       // sentences
};

/// Stiffness, friction and texture of a recorded contact, with intervals from blocks.
///
///     depth = F_n / k + c + s·n + A-terms      contact samples, F_n = F·n > least force
///     F·u   = -mu_d F_n + u·b                  samples that slip, u = v/|v| along the surface
///
/// The depth is regressed on the force and not the other way round, since poses are noisy and
/// forces are not: k is the inverse of an interval of 1/k. The offset c and the shift s stand for
/// what a registration leaves, b for what is left of the sensor's offset. Static friction is the
/// mean, with Student's t over phases of sticking, of |F_t| / F_n at their ends
/// (break_away_ratios()); slip slower than `stick.slow` counts as sticking and pulls it towards the
/// dynamic one. Friction is signed, negative where it pushes along the motion: a
/// contact without it gives an interval around 0. The amplitude's interval begins at 0 where
/// Hotelling's test of its two terms does not tell them from 0.
///
/// @throws std::invalid_argument as check(), for an option that breaks its bound or when fewer
/// than 80 samples are in contact.
IdentifiedContact identify_contact(const ContactSamples& samples,
                                   const IdentificationOptions& options = {});

}  // namespace haptrial::evaluation
