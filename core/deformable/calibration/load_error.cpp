#include "core/deformable/calibration/load_error.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/base/error.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using Positions = std::vector<Vector3d>;

/// The points that are compared, and where they should be.
struct Compared {
  Positions points, wanted;
};

Compared compared(const CalibrationLoad& load, const Positions& positions) {
  if (load.markers.empty()) {
    return {positions, load.reference};
  }
  Compared result;
  for (const Marker& marker : load.markers) {
    result.points.push_back(place_of(marker, positions));
    result.wanted.push_back(marker.moved);
  }
  return result;
}

/// The rigid motion that brings the points nearest to where they should be.
Eigen::Isometry3d nearest_motion(const Compared& c) {
  const auto n = static_cast<Eigen::Index>(c.points.size());
  const Eigen::Map<const Eigen::Matrix3Xd> from(c.points[0].data(), 3, n);
  const Eigen::Map<const Eigen::Matrix3Xd> to(c.wanted[0].data(), 3, n);
  return Eigen::Isometry3d(Eigen::umeyama(from, to, false));
}

/// The gradient by the compared points, as one by the vertices.
Positions by_vertex(const CalibrationLoad& load, const Positions& by_point, std::size_t vertices) {
  if (load.markers.empty()) {
    return by_point;
  }
  Positions gradient(vertices, Vector3d::Zero());
  for (std::size_t m = 0; m < load.markers.size(); ++m) {
    const Marker& marker = load.markers[m];
    for (std::size_t i = 0; i < marker.vertices.size(); ++i) {
      gradient[static_cast<std::size_t>(marker.vertices[i])] +=
          marker.weights[static_cast<Eigen::Index>(i)] * by_point[m];
    }
  }
  return gradient;
}

double sum_of_forces(const LoadCase& load) {
  double sum = 0.0;
  for (const NodalForce& nodal : load.forces) {
    sum += nodal.force.norm();
  }
  return sum;
}

Positions tool_gradient(const CalibrationLoad& load, const Positions& positions) {
  const double farther = way_of_tool(load.load, load.reference, positions) < 0.0 ? -1.0 : 1.0;
  const double scale = farther / sum_of_forces(load.load);
  Positions gradient(positions.size(), Vector3d::Zero());
  for (const NodalForce& nodal : load.load.forces) {
    gradient[static_cast<std::size_t>(nodal.vertex)] += scale * nodal.force;
  }
  return gradient;
}

}  // namespace

std::string_view name_of(ErrorMeasure measure) {
  switch (measure) {
    case ErrorMeasure::kVertices:
      return "vertices";
    case ErrorMeasure::kShape:
      return "shape";
    case ErrorMeasure::kTool:
      break;
  }
  return "tool";
}

void check_measure(const CalibrationLoad& load, ErrorMeasure measure) {
  if (measure == ErrorMeasure::kTool &&
      (!(sum_of_forces(load.load) > 0.0) || !load.markers.empty())) {
    throw InputError(fmt::format(
        "load '{}' has no force and no reference at the force's vertices; an error at the tool "
        "needs both",
        load.load.name));
  }
}

double way_of_tool(const LoadCase& load, const Positions& rest, const Positions& positions) {
  double work = 0.0;
  for (const NodalForce& nodal : load.forces) {
    const auto v = static_cast<std::size_t>(nodal.vertex);
    work += nodal.force.dot(positions[v] - rest[v]);
  }
  return work / sum_of_forces(load);
}

double distance_error(const Positions& a, const Positions& b) {
  double sum = 0.0;
  for (std::size_t v = 0; v < a.size(); ++v) {
    sum += (a[v] - b[v]).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(a.size()));
}

double load_error(const CalibrationLoad& load, const Positions& positions, ErrorMeasure measure) {
  if (measure == ErrorMeasure::kTool) {
    return std::abs(way_of_tool(load.load, load.reference, positions));
  }
  Compared c = compared(load, positions);
  if (measure == ErrorMeasure::kShape) {
    const Eigen::Isometry3d motion = nearest_motion(c);
    for (Vector3d& p : c.points) {
      p = motion * p;
    }
  }
  return distance_error(c.points, c.wanted);
}

Positions load_error_gradient(const CalibrationLoad& load, const Positions& positions,
                              ErrorMeasure measure) {
  const double error = load_error(load, positions, measure);
  if (error == 0.0) {
    return Positions(positions.size(), Vector3d::Zero());
  }
  if (measure == ErrorMeasure::kTool) {
    return tool_gradient(load, positions);
  }
  // At its best the rigid motion may be taken as constant: the error has no slope along it.
  const Compared c = compared(load, positions);
  const Eigen::Isometry3d motion =
      measure == ErrorMeasure::kShape ? nearest_motion(c) : Eigen::Isometry3d::Identity();
  const double scale = 1.0 / (error * static_cast<double>(c.points.size()));
  Positions gradient;
  for (std::size_t i = 0; i < c.points.size(); ++i) {
    gradient.push_back(scale *
                       (motion.linear().transpose() * (motion * c.points[i] - c.wanted[i])));
  }
  return by_vertex(load, gradient, positions.size());
}

}  // namespace haptrial::deformable
