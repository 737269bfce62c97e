#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <vector>

#include "analysis/psychophysics/study/quantity.h"

namespace haptrial::analysis::trials {

struct TrialsData;

/// A tick of the device with which something is produced.
struct ProducedTick {
  Eigen::Vector3d position, velocity, force;  // [m, m/s, N]
};

/// The number of a stage's ticks. @param ticks  at least one
double produced_value(std::span<const ProducedTick> ticks, const ProducedPlan& plan);

/// The produced quantity, and with ProducedPlan::target its constant, absolute and variable error,
/// tested between the conditions of TrialsPlan::by. A value is a participant's under a condition:
/// the mean over trials; the variable error is the standard deviation of the errors of at least two
/// trials.
/// @param files  of TrialsData::sessions, in their order
/// @throws InputError naming a file that is damaged, or as quantity() does
std::vector<Quantity> produced_quantities(const TrialsData& data,
                                          const std::vector<std::filesystem::path>& files,
                                          const TrialsPlan& plan, int threads);

}  // namespace haptrial::analysis::trials
