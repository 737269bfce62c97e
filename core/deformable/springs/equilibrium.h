#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/deformable/body/load_case.h"
#include "core/deformable/springs/spring_body.h"

namespace haptrial::deformable {

/// kUnstable: a position is not finite, or what was found is no minimum of the energy. Positions of
/// an outcome other than kSettled are no result.
enum class Settling { kSettled, kUnstable, kNotInTime };

struct NewtonSettings {
  double residual{1e-10};  // of the largest force that acts: where the search ends
  int iterations{200};     // at most
};

struct Equilibrium {
  Settling outcome{Settling::kNotInTime};
  std::vector<Eigen::Vector3d> positions;  // (vertices) [m]; a result only where settled
  int iterations{};
  double residual{};       // largest force that nothing balances [N]
  std::size_t inverted{};  // tetrahedra whose volume is not above 0
};

/// Positions at which springs balance a load: a minimum of their energy less the forces' work, by
/// Newton's method on the exact Hessian (spring_tangent.h), damped while that is not positive
/// definite, with a line search. kSettled only if the Hessian at the end is positive definite;
/// kUnstable if it is not or if the search leaves the numbers; kNotInTime after the iterations.
/// Source: Morris 2006, §5.3.2 ("elastic forces precisely negate the applied forces").
/// @param start  where the search begins, held vertices aside (vertices); empty: at rest
/// @throws InputError for what check_load() refuses.
Equilibrium equilibrium(const SpringBody& body, const LoadCase& load,
                        const NewtonSettings& settings = {},
                        std::vector<Eigen::Vector3d> start = {});

}  // namespace haptrial::deformable
