#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "analysis/contact/truth/true_bodies.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::evaluation {

/// A body whose contact is known exactly, and the way of a tool that rubs it.
struct ExamBody {
  std::string name;  // "thin plate"
  TrueBody body;
  Eigen::Vector3d (*tool)(double t);  // at t of 0 to 4 s, in the air at 0 [m]
};

/// Plane, sphere, cylinder, torus, wedge, concave edge, wavy plate and thin plate.
const std::vector<ExamBody>& exam_bodies();

/// Positions at 1 kHz over 4 s, there and back to the first one. The tool is slower where it turns,
/// so that friction holds it for a while.
std::vector<Eigen::Vector3d> there_and_back(const ExamBody& body);

/// The body as a closed mesh: what is endless ends at least 6 cm from where the tool comes.
/// @param fine  edges of 1 / fine of the coarsest >= 1; faces that are plane stay as they are
geometry::Mesh mesh_of(const TrueBody& body, int fine);

}  // namespace haptrial::evaluation
