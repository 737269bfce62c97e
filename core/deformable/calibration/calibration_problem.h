#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "core/deformable/calibration/load_error.h"
#include "core/deformable/springs/spring_body.h"

namespace haptrial::deformable {

/// How far springs are from the reference.
struct CalibrationError {
  /// Errors of the loads by the problem's measure, their mean over the loads [m]. Infinite where
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
  /// body's vertices or not finite, and as check_measure().
  CalibrationProblem(SpringBody body, std::vector<CalibrationLoad> loads,
                     ErrorMeasure measure = ErrorMeasure::kVertices);

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
  ErrorMeasure measure_;
};

}  // namespace haptrial::deformable
