#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/statistics/base/defined.h"
#include "core/record/rows/session_types.h"

namespace haptrial::analysis {

/// The ideal path of one block, linear between the rows of /stimuli.
class IdealPath {
 public:
  /// @param rows  of one block, in order of time, at least one.
  /// @throws std::invalid_argument without rows or with times that do not increase.
  explicit IdealPath(std::vector<record::StimulusRow> rows);

  /// @param time  since the start of the run [s]; held at the ends.
  /// @returns the ideal p_W [m].
  Eigen::Vector3d position(double time) const;

  double duration() const { return rows_.back().time; }  // [s]

 private:
  std::vector<record::StimulusRow> rows_;
};

/// How far `actual` lags behind `ideal`: the shift of the highest correlation between the two, each
/// centred and scaled over the part that overlaps, with a parabola through the peak.
/// @param actual, ideal  sampled at the same times, `rate` [Hz]; equally long.
/// @param max_lag  largest shift tried in either direction [s].
/// @returns seconds; positive when `actual` is late. Undefined when a curve does not vary or the
/// peak lies at the edge of the search.
/// @throws std::invalid_argument when the lengths differ.
Defined<double> lag_behind(std::span<const double> actual, std::span<const double> ideal,
                           double rate, double max_lag = 0.25);

/// How well the device led the hand along the path of one pass.
/// Where the participant set the pace there is no lag, and the distance is that to the nearest
/// place of the path.
struct PassTracking {
  Defined<double> lag{Undefined{"there are no samples"}};  // along z [s]
  std::uint64_t samples{0};
  double squares{0.0};           // sum of squared distances to the ideal position [m²]
  double squares_in_plane{0.0};  // the same without the direction of the force, y [m²]
  double duration{0.0};          // of the run [s]
};

/// @param times  since the start of the run [s]; @param positions  p_W [m], one for each time.
PassTracking track_pass(std::span<const double> times, std::span<const Eigen::Vector3d> positions,
                        const IdealPath& ideal, double rate);

/// Tracking of one participant, or of all.
struct TrackingSummary {
  std::string subject;
  std::size_t passes{0};
  std::size_t passes_without_lag{0};
  Defined<double> lag{Undefined{"no pass has one"}};                      // mean over passes [s]
  Defined<double> lag_deviation{Undefined{"no pass has one"}};            // between passes [s]
  Defined<double> rms_error{Undefined{"there are no samples"}};           // [m]
  Defined<double> rms_error_in_plane{Undefined{"there are no samples"}};  // [m]
  Defined<double> run{Undefined{"there are no passes"}};            // mean duration of a run [s]
  Defined<double> run_deviation{Undefined{"there are no passes"}};  // between passes [s]
};

TrackingSummary summarize_tracking(std::string subject, std::span<const PassTracking> passes);

}  // namespace haptrial::analysis
