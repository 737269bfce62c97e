#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "analysis/bone_drilling/metrics/procedure.h"

namespace haptrial::analysis::drilling {

/// A stroke is drilling (the burr turns, in bone) without a lift, in one direction: it ends where
/// the tip turns back towards where the stroke began.
struct StrokeParameters {
  double turn_back{0.5e-3};  // a reversal is this far towards the beginning > 0 [m]
  double lift{0.05};         // shorter breaks of contact are none >= 0 [s]
  double shortest{1e-3};     // shorter paths are no strokes >= 0 [m]
  double step{0.01};         // over which path and jerk are taken > 0 [s]
};

struct Stroke {
  std::size_t first{0}, last{0};  // ticks, both inclusive
  double duration{0.0};           // [s]
  double length{0.0};             // of the tip's path [m]
  double speed{0.0};              // length over duration [m/s]
  /// Log dimensionless jerk, -ln(T^3 / v_peak^2 * integral of |d2v/dt2|^2): higher is smoother, a
  /// minimum-jerk movement has -5.32. Nothing for strokes shorter than five steps.
  /// Source: Hogan and Sternad 2009; Balasubramanian et al. 2012.
  std::optional<double> smoothness;
};

std::vector<Stroke> find_strokes(const Procedure& procedure,
                                 const StrokeParameters& parameters = {});

/// Means over strokes; nothing without any.
struct StrokeFigures {
  std::size_t count{0};
  std::optional<double> length;      // [m]
  std::optional<double> speed;       // [m/s]
  std::optional<double> duration;    // [s]
  std::optional<double> smoothness;  // over the strokes that have one
  std::optional<double> rate;        // per second of drilling [1/s]
};

StrokeFigures stroke_figures(const Procedure& procedure, const StrokeParameters& parameters = {});

}  // namespace haptrial::analysis::drilling
