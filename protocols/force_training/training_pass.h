#pragma once

#include <memory>
#include <string>
#include <vector>

#include "protocols/force_training/trajectory_pass.h"

namespace haptrial::protocols {

// An expert who does what the stimulus asks is seen, leads the hand, or both.
inline constexpr const char* kWatching = "watching";
inline constexpr const char* kPlayback = "playback";
inline constexpr const char* kWatchedPlayback = "both";

/// The training conditions that a definition may name: "haptic", "visual", "visuohaptic", and the
/// three of an expert.
const std::vector<std::string>& training_conditions();
bool has_expert(const std::string& condition);

/// A training pass of a condition. @throws std::invalid_argument for an unknown one.
std::unique_ptr<TrajectoryPass> make_training_pass(const std::string& condition,
                                                   const stimulus::Stimulus& stimulus,
                                                   const GuidanceParameters& parameters,
                                                   std::int32_t block);

}  // namespace haptrial::protocols
