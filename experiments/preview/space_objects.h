#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/mesh/mesh.h"
#include "core/scene/shape.h"
#include "protocols/psychophysics/preview/previewed_trial.h"

namespace haptrial::experiments {

using SpaceLine = std::pair<Eigen::Vector3d, Eigen::Vector3d>;  // in W [m]

/// Something in space, as lines: an object, a place that a stage asks about, a path.
struct SpaceObject {
  std::string name;
  int interval{0};  // in which it is there, from 1; 0: in all
  std::vector<SpaceLine> lines;
};

/// Outline of a shape: circles of a ball, edges of a box, a square of a half-space.
std::vector<SpaceLine> lines_of(const scene::Shape& shape);
/// Edges of a mesh, which is thinned to `most_triangles` if it has more.
std::vector<SpaceLine> lines_of(const geometry::Mesh& mesh, std::size_t most_triangles);
/// Lines from each point to the next.
std::vector<SpaceLine> lines_of(const std::vector<Eigen::Vector3d>& points);

/// The objects and regions of the intervals of a trial. What all intervals share is there once.
std::vector<SpaceObject> objects_of(const protocols::PreviewedTrial& trial);

/// All lines as numbers, for the scripts of a page: "x,y,z,x,y,z;..." in tenths of a millimetre.
std::string line_numbers(const std::vector<SpaceLine>& lines);

}  // namespace haptrial::experiments
