#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "protocols/psychophysics/definition/question.h"

namespace haptrial::protocols {

struct TrialDevice;

/// Most measures of a definition.
inline constexpr std::size_t kMostMeasures = 8;

/// A quantity that a hand produces on a tick, or with each tick.
enum class MeasuredQuantity : std::uint8_t {
  kForce,  // size of the force on the device: what the hand presses against
  kDepth,  // in a field
  kX,      // place along an axis of W
  kY,
  kZ,
  kSpeed,
  kDistance,  // to a place or a moving target
  kPath,      // length of the way
  kTime,      // that the stage takes
  kChannel    // value of a channel's quantity
};

/// The number that stands for a stage's ticks; of paths and times it is their sum.
enum class MeasuredStatistic : std::uint8_t { kMean, kPeak, kEnd, kDeviation };

/// A number that a stage of each trial produces, and everything that follows from it. It is an
/// answer of its trial, by its name, in formulas and files.
struct Measure {
  std::string name;
  std::size_t stage{0};  // from 0
  int interval{-1};      // of the definition, from 0; -1: the last that is presented
  std::size_t device{0};
  MeasuredQuantity quantity{MeasuredQuantity::kForce};
  MeasuredStatistic statistic{MeasuredStatistic::kMean};
  int field{-1};           // whose force or depth; -1: the sum of all fields
  std::size_t channel{0};  // place of the quantity among the readings' values
  Eigen::Vector3d place{Eigen::Vector3d::Zero()};  // to which the distance is [m]
  int target{-1};    // moving target to which it is, from 0; -1: the place
  double last{0.0};  // of the stage, that counts [s]; 0: the whole stage
  double low{-std::numeric_limits<double>::infinity()};  // right answers are from here, in `unit`
  double high{std::numeric_limits<double>::infinity()};  // to here
  bool judged{false};                                    // whether that is stated
  Feedback feedback{Feedback::kNever};
  std::string text{"{}"};  // that tells it; {} is the value with its unit
  double scale{1.0};       // of the quantity, from SI to `unit`
  std::string unit{"N"};

  bool is_summed() const noexcept {
    return quantity == MeasuredQuantity::kPath || quantity == MeasuredQuantity::kTime;
  }
  bool is_right(double value) const noexcept { return value >= low && value <= high; }
};

/// "peak force", "mean place along y".
std::string words_of(const Measure& measure);

/// Words that tell a participant a value, such as "12.3 N" or "8.5 mm" in its text.
std::string told_value(const Measure& measure, double value);

/// Names that measures of a definition may use, by index unless said otherwise.
struct MeasureSource {
  std::vector<std::string> stages;
  std::vector<std::string> intervals;
  std::vector<std::string> fields;
  std::vector<std::uint64_t> felt;   // (devices) the fields that act on each, a bit each
  std::vector<std::string> targets;  // that move
  std::vector<std::string> values;   // of channels
  std::vector<std::string> units;    // of these values
  const std::vector<TrialDevice>& devices;
  /// The place of a name; nothing if there is none. @throws nothing
  std::function<std::optional<Eigen::Vector3d>(const std::string&)> place;
};

/// Reads the tables [measures.NAME], in the order of the file. Problems are noted; all keys are
/// optional.
std::vector<Measure> read_measures(Table& measures, const MeasureSource& source);

}  // namespace haptrial::protocols
