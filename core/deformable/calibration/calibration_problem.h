#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "core/deformable/body/load_case.h"
#include "core/deformable/calibration/marker.h"
#include "core/deformable/springs/spring_body.h"

namespace haptrial::deformable {

/// A load, and where the body is under it by a model that is trusted, or as it was measured.
struct CalibrationLoad {
  LoadCase load;
  /// (vertices) [m]. Where there are markers this is only where the search for rest begins.
  std::vector<Eigen::Vector3d> reference;
  std::vector<Marker> markers{};  // if any, they alone are compared
};

/// How far springs are from the reference.
struct CalibrationError {
  /// Root mean squares over the vertices or markers, their mean over the loads [m]. Infinite where
  /// a load finds no rest or turns a tetrahedron inside out: such constants are unstable and are
  /// never averaged in.
  double mean{std::numeric_limits<double>::infinity()};
  std::vector<double> by_load;  // each [m]
  std::string unstable;         // why, in words; empty if all loads rest
  SpringConstants gradient;     // of the mean by each spring's constant [m/J], if asked for
};

/// Error of springs with certain constants under loads whose answers are known. Source: Morris
/// 2006, §5.3.2 (errata: the mean over loads).
class CalibrationProblem {
 public:
  /// @throws InputError as check_load(), for no load, or a reference of another length than the
  /// body's vertices or not finite.
  CalibrationProblem(SpringBody body, std::vector<CalibrationLoad> loads);

  const SpringBody& body() const { return body_; }
  const std::vector<CalibrationLoad>& loads() const { return loads_; }

  /// Statics by Newton's method from the reference on; the gradient by the adjoint: one more solve
  /// a load, however many constants there are. May be called from several threads.
  /// @param threads  that share the loads; the result is the same for any number
  /// @throws InputError as check_constants().
  CalibrationError error(const SpringConstants& constants, bool with_gradient,
                         int threads = 1) const;

  /// Rest positions of the vertices under a load [m]; empty if they do not rest.
  std::vector<Eigen::Vector3d> rest(const SpringConstants& constants, std::size_t load) const;

 private:
  SpringBody body_;
  std::vector<CalibrationLoad> loads_;
};

/// How far vertices at `positions` are from what a load's vertices or markers should be [m].
double load_error(const CalibrationLoad& load, const std::vector<Eigen::Vector3d>& positions);

/// The root mean square of the distances between equally many points [m].
double distance_error(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b);

}  // namespace haptrial::deformable
