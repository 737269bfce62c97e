#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "core/deformable/body/load_case.h"
#include "core/deformable/calibration/marker.h"

namespace haptrial::deformable {

/// A load, and where the body is under it by a model that is trusted, or as it was measured.
struct CalibrationLoad {
  LoadCase load;
  /// (vertices) [m]. Where there are markers this is only where the search for rest begins.
  std::vector<Eigen::Vector3d> reference;
  std::vector<Marker> markers{};  // if any, they alone are compared
};

/// Measure of the distance between a body and its reference [m]:
///
///     kVertices   sqrt(1/n sum |p - r|²) over the vertices or markers (Morris 2006, §5.3.2)
///     kShape      the same after the rigid motion that brings p nearest to r, which may pass
///     kTool       |w(p) - w(r)|, w = sum f . u / sum |f|: the way of the force's points along it
///
/// The tool feels the force by its way: an error of w by one tenth is an error of the force at the
/// tool by about one tenth.
enum class ErrorMeasure { kVertices, kShape, kTool };
std::string_view name_of(ErrorMeasure measure);

/// @throws InputError if the measure is kTool and the load has no force.
void check_measure(const CalibrationLoad& load, ErrorMeasure measure);

/// Distance of a body with vertices at `positions` from a load's vertices or markers [m].
double load_error(const CalibrationLoad& load, const std::vector<Eigen::Vector3d>& positions,
                  ErrorMeasure measure = ErrorMeasure::kVertices);

/// The gradient of load_error() by the vertices' places; 0 where the error is.
std::vector<Eigen::Vector3d> load_error_gradient(const CalibrationLoad& load,
                                                 const std::vector<Eigen::Vector3d>& positions,
                                                 ErrorMeasure measure);

/// The way w of the force's points along the force, for vertices that come from `rest` [m]; NaN
/// without a force.
double way_of_tool(const LoadCase& load, const std::vector<Eigen::Vector3d>& rest,
                   const std::vector<Eigen::Vector3d>& positions);

/// The root mean square of the distances between equally many points [m].
double distance_error(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b);

}  // namespace haptrial::deformable
