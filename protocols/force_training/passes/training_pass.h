#pragma once

#include <memory>
#include <string>
#include <vector>

#include "protocols/force_training/passes/trajectory_pass.h"

namespace haptrial::protocols {

/// The training conditions that a definition may name: "haptic", "visual", "visuohaptic".
const std::vector<std::string>& training_conditions();

/// A training pass of a condition. @throws std::invalid_argument for an unknown one.
std::unique_ptr<TrajectoryPass> make_training_pass(const std::string& condition,
                                                   const stimulus::Stimulus& stimulus,
                                                   const GuidanceParameters& parameters,
                                                   std::int32_t block);

}  // namespace haptrial::protocols
