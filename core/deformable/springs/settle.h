#pragma once

#include <cstddef>
#include <cstdint>

#include "core/deformable/body/load_case.h"
#include "core/deformable/springs/spring_motion.h"

namespace haptrial::deformable {

/// kUnstable: a position is not finite or far outside of where the body can be, or what was found
/// is no minimum of the energy. Positions of an outcome other than kSettled are no result.
enum class Settling { kSettled, kUnstable, kNotInTime };

/// A body rests when all four stay below their limits for some time.
/// Source: Morris 2006, §5.3.3.
struct RestCriterion {
  Activity below{1e-5, 1e-6, 1e-2, 1e-3};
  double lasting{0.01};  // for how long, > 0 [s]
  double within{20.0};   // of simulated time [s]
};

struct RestResult {
  Settling outcome{Settling::kNotInTime};
  double time{};  // simulated, from the begin of this search [s]
  std::uint64_t steps{};
  std::size_t inverted{};  // tetrahedra at the end
};

/// Steps until the body rests. The motion needs damping to settle.
/// @throws InputError for a criterion that is not allowed.
RestResult settle(SpringMotion& motion, const RestCriterion& criterion);

/// The vertices that a load holds.
std::vector<std::int32_t> held_vertices(const LoadCase& load);

/// Moves held vertices to their places and sets the forces, several on a vertex summed.
/// The motion must hold held_vertices(load).
void apply(const LoadCase& load, const SpringBody& body, SpringMotion& motion);

}  // namespace haptrial::deformable
