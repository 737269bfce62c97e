#pragma once

#include <memory>
#include <span>
#include <vector>

#include "protocols/force_training/trajectory_pass.h"

namespace haptrial::protocols {

/// The pass of a row of /trials: of its training condition, or the recall test.
/// @throws std::invalid_argument for an unknown condition.
std::unique_ptr<TrajectoryPass> make_pass(const std::string& condition, record::Phase phase,
                                          const stimulus::Stimulus& stimulus,
                                          const GuidanceParameters& parameters, std::int32_t block);

/// Presentation at each sample of a recorded pass, by the rules of the pass itself.
/// @param samples  of this pass, in order, none missing.
/// @param rate     of the servo loop [Hz]
/// @param expert   the rows of these samples where there was an expert
std::vector<stimulus::Presentation> presentations(const TrajectoryPass& pass,
                                                  std::span<const record::Sample> samples,
                                                  double rate,
                                                  std::span<const record::TutoringRow> expert = {});

}  // namespace haptrial::protocols
