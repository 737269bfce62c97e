#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/contact/exam/candidate.h"

namespace haptrial::evaluation {

/// A renderer in a loop with a virtual hand, at one stiffness, friction and rate.
struct StabilityCell {
  double stiffness{0.0};  // [N/m]
  double friction{0.0};
  double rate{0.0};  // [Hz]
  double span{0.0};  // of the hand's motion across the plane in the last second [m]

  bool stable() const { return span < kStill; }
  /// Whether the hand's damping exceeds K T / 2, from which on a wall that is sampled and held
  /// gives no energy (Colgate and Schenkel 1997, J. Robotic Systems 14, 37).
  bool passive() const;
  static constexpr double kStill = 1e-4;  // [m]
};

/// The cells that are asked, without a span: four stiffnesses from 500 to 6000 N/m, three frictions
/// from 0 to 0.6, and 500, 1000 and 2000 Hz.
std::vector<StabilityCell> stability_cells();

/// Lets a hand of 50 g and 1 N·s/m press a point with 2 N on a plane for 3 s, swaying along it with
/// 0.4 N, the force of a tick held until the next, in each of stability_cells(). Nobody felt it.
std::vector<StabilityCell> stability_of(Candidate& candidate);

/// A row for each cell.
std::string stability_csv(const std::vector<StabilityCell>& cells);
/// @throws InputError for another table, or one without a row for each of stability_cells().
std::vector<StabilityCell> read_stability(const std::filesystem::path& file);

}  // namespace haptrial::evaluation
