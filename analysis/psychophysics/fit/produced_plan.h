#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace haptrial {
class Table;
}

namespace haptrial::analysis::trials {

/// A quantity that a hand produces in a stage.
enum class ProducedQuantity {
  kForce,  // size of the force on the device: what the hand presses against
  kX,      // place along an axis
  kY,
  kZ,
  kSpeed,
  kPath,  // length of the way
};

/// The number that stands for a stage's ticks.
enum class ProducedStatistic { kMean, kPeak, kEnd, kDeviation };

/// Names of a definition that the analysis of what is produced may use.
struct ProducedNames {
  std::vector<std::string> stages;
  std::vector<std::string> devices;    // in their order; empty: one without a name
  std::vector<std::string> variables;  // that a trial has as numbers
};

/// Content of [analysis] of kind "produced".
struct ProducedPlan {
  std::string stage;
  std::string device_name;
  std::size_t device{0};  // from 0
  ProducedQuantity quantity{ProducedQuantity::kForce};
  ProducedStatistic statistic{ProducedStatistic::kMean};
  double last{0.0};    // of the stage, that counts [s]; 0: the whole stage
  std::string target;  // variable that it was to equal, in its SI unit; empty: none
};

/// "N", "m" or "m/s".
const char* unit_of(ProducedQuantity quantity);
/// "peak force", "mean place along y".
std::string words_of(const ProducedPlan& plan);

/// Reads the keys of [analysis] of kind "produced". Problems are noted.
ProducedPlan read_produced_plan(Table& table, const ProducedNames& names);

}  // namespace haptrial::analysis::trials
