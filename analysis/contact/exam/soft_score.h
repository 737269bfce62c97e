#pragma once

#include <cstddef>
#include <vector>

#include "analysis/contact/exam/exam.h"

namespace haptrial::evaluation {

/// Judgement of a soft body beside the force at the tool.
struct SoftScore {
  std::size_t tetrahedra{0};
  double mean{0.0};  // distance of a vertex from the truth, over vertices and samples [m]
  double root_mean_square{0.0};  // likewise [m]
  double worst{0.0};             // [m]
  double moved{0.0};             // root mean square of the true displacements [m]
  std::size_t inside_out{0};     // samples with a tetrahedron whose volume is not above 0
  double momentum_off{0.0};      // of a free body: see below
  double deformed{0.0};          // of a free body, at worst: see below
  double load_energy{0.0};       // that the body gives to the forces on the closed path [J]
  double load_taken{0.0};        // that it takes from them, and gives back later [J]
};

/// Compares the shapes of the answers with the truth. Of a body that nothing holds: how far its
/// momentum is from what the forces gave it, or its angular momentum about its centre of mass from
/// that of the first sample, at worst, as a share; or its angular momentum from what the forces
/// give a rigid body, beyond the 15 % that its softness may make. Its vertices' distance from the
/// shape at rest, moved and turned to fit best, is a share of their distance from the middle.
/// Velocities are differences of shapes one after
/// the other, so that a method that steps by them keeps both exactly.
/// @param answers  (n), with shapes at the case's shape_samples
SoftScore soft_score(const ExamCase& one, const std::vector<Answer>& answers);

}  // namespace haptrial::evaluation
