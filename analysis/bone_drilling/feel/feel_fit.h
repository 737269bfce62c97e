#pragma once

#include <optional>
#include <span>
#include <vector>

namespace haptrial::analysis {
class CsvTable;
}

namespace haptrial::analysis::drilling {

/// A moment of a recording in which a ball-shaped burr is pressed on flat bone.
struct FeelSample {
  double depth{0.0};           // of the burr's lowest point below the bone's present surface [m]
  double force{0.0};           // of the bone on the burr, along the surface's normal [N]
  std::optional<double> feed;  // at which it sinks while it drills >= 0 [m/s]; none: it is off
  double tilt{0.0};            // angle between the handle and the normal, 0 to pi / 2 [rad]
};

/// An estimate with its 95 % interval.
struct FeelEstimate {
  double value{0.0};
  double low{0.0};
  double high{0.0};
};

/// Constants of a burr (bone::FeelParameters, bone::BurrParameters) that fit a recording best.
struct FeelFit {
  FeelEstimate first_gain;                   // g_1 [N/m^3]
  FeelEstimate second_gain;                  // g_2 [N/m^3]
  FeelEstimate threshold;                    // V_t [m^3]
  double force_error{0.0};                   // standard deviation of the forces about the law [N]
  std::size_t pressed{0};                    // samples of the force
  std::optional<FeelEstimate> removal_rate;  // R_max [1/(N·s)]; none: too few samples drill
  std::optional<FeelEstimate> falloff;  // [1/(N·s·rad)]; none likewise, or with one tilt only
  std::size_t drilled{0};               // samples of the feed
};

/// Volume of the part of a ball that is immersed by `depth` in flat bone [m^3].
double immersed_volume(double radius, double depth) noexcept;
/// Mean of the latitude's magnitude over that part, about the burr's axis [rad].
double mean_latitude(double radius, double depth, double tilt) noexcept;

/// Fits the force law and the removal of §3.2.3.5 and §3.2.3.6 (Morris 2006) by least squares. With
/// V the immersed volume, A the area of its circle on the surface, L the mean latitude,
///
///     F = g_1 min(V, V_t) + g_2 max(0, V - V_t)
///     v = F (V / A) (R_max - falloff L)          while R_max > falloff pi / 2
///
/// with the fitted F in the second line.
///
/// Intervals are those of the linearised model with independent errors of one size in F and in v.
/// @param radius  of the burr > 0 [m]
/// @param samples  none as deep as the burr's diameter
/// @throws InputError when fewer than 20 samples are in contact, or do not tell two gains apart
FeelFit fit_feel(double radius, std::span<const FeelSample> samples);

/// Reads the columns depth [m], force [N], and optionally feed [m/s] (an empty field: the burr is
/// off) and tilt [rad]. @param radius  of the burr > 0 [m] @throws InputError for other tables,
/// naming line and column, for numbers that can only be in other units, and for a depth at which
/// the whole burr is immersed
std::vector<FeelSample> read_feel_samples(const CsvTable& table, double radius);

}  // namespace haptrial::analysis::drilling
