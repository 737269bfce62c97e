#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "analysis/contact/truth/true_rest.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::evaluation {

/// A rigid tool that is led into a body whose free space is convex, so that where it rests is known
/// exactly.
struct ExamTool {
  std::string name;                     // "peg in a shaft"
  geometry::Mesh tool;                  // a box
  geometry::Mesh body;                  // closed; what is endless ends at least 6 cm from the tool
  std::vector<HalfSpace> free;          // what the body leaves
  Eigen::Isometry3d (*hand)(double t);  // X_WT at t of 0 to 1, free at 0
};

/// A box on a plane, an edge in a groove, a peg in a shaft.
const std::vector<ExamTool>& exam_tools();

/// Poses at 1 kHz over 4 s, there and back to the first one.
std::vector<Eigen::Isometry3d> there_and_back(const ExamTool& tool);

}  // namespace haptrial::evaluation
