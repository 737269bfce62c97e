#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

namespace haptrial::protocols {

/// End of a stage: all that is stated holds at once, and has held without a break for `hold`.
struct Until {
  double time{0.0};          // has passed since the stage began >= 0 [s]
  std::uint64_t inside{0};   // tools are in all of these regions: bit i, the region of index i
  std::uint64_t contact{0};  // every device that feels one of these fields touches it, likewise
  double speed_below{std::numeric_limits<double>::infinity()};  // of the fastest tool [m/s]
  double speed_above{-1.0};                                     // [m/s]
  std::uint32_t buttons{0};  // any of these was pressed since the stage began; 0: not asked
  std::uint32_t keys{0};     // the same of the window's keys
  std::optional<std::size_t> channel;  // place of a channel's quantity among the readings' values
  double above{-std::numeric_limits<double>::infinity()};  // its value is, in its own unit
  double below{std::numeric_limits<double>::infinity()};   // likewise
  double hold{0.0};                                        // >= 0 [s]

  double soonest() const noexcept { return time + hold; }  // since the stage began [s]
};

/// Consequence of a stage that takes too long, or in which too little was felt.
enum class Consequence : std::uint8_t {
  kGoOn,    // to the next stage; the record says so
  kRepeat,  // the interval, from its first stage
  kAbort,   // the trial; it is queued again
};

/// An event that must have happened in a stage: "did they press at all?"
struct Requirement {
  enum class Of : std::uint8_t { kDepth, kForce, kSpeed };
  Of of{Of::kDepth};
  int field{-1};    // whose depth or force; -1 of a speed, which is that of tools
  int measure{-1};  // of the definition, whose value is required; -1: the largest value of `of`
  double at_least{0.0};  // of the largest value in the stage, of any device [m, N or m/s]
  double at_most{std::numeric_limits<double>::infinity()};  // of a measure
  Consequence otherwise{Consequence::kRepeat};

  bool holds(double value) const noexcept { return value >= at_least && value <= at_most; }
};

/// One stage of an interval with the numbers of its trial: what can be felt, and until when.
struct Stage {
  std::uint64_t fields{0};  // that act: bit i, the field of index i
  Until until;
  double timeout{std::numeric_limits<double>::infinity()};  // > 0 [s]
  Consequence late{Consequence::kAbort};
  std::optional<Requirement> require;
  double onset_speed{std::numeric_limits<double>::infinity()};  // a movement begins above it [m/s]
};

}  // namespace haptrial::protocols
