#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/device/device.h"
#include "core/scene/shape.h"

namespace haptrial::scene {
class Scene;
}

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
  enum class Quantity : std::uint8_t { kDepth, kForce, kSpeed };
  Quantity of{Quantity::kDepth};
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

class Measurement;

/// How a stage ended.
enum class StageEnd : std::uint8_t { kUnderWay, kReached, kLate, kTooLittle };

/// Times of a stage; ticks count from the first of the interval.
struct StageTimes {
  std::int64_t begin{-1};  // -1: not begun
  std::int64_t onset{-1};  // the first tick on which the tool was faster than onset_speed; -1: none
  std::int64_t end{-1};    // the tick on which its end was seen
  StageEnd how{StageEnd::kUnderWay};
  double most{0.0};  // of what is required: the largest value [m, N or m/s], or the measure's
};

/// A part of space that stages ask about, and the device whose tool is to be in it, from 0.
struct StageRegion {
  scene::PlacedShape shape;
  std::size_t device{0};
  bool of_cursor{false};  // the cursor is to be in it, in place of the tool
};

/// Goes through the stages of one interval, a tick of the servo loop at a time. Each device has a
/// scene of all fields; the machine switches those that it feels at the beginning of each stage.
/// Who asks the scenes for their forces does so before tick(). A button or key counts when it goes
/// down during the stage, not when it was held before.
class StageMachine {
 public:
  enum class State : std::uint8_t { kRunning, kDone, kAborted };

  /// @param stages   at least one
  /// @param regions  that stages name by index
  /// @throws std::invalid_argument naming the stage and what it names that is not there, or the
  /// bound that it breaks
  /// @param felt     (devices) the fields that act on each, a bit each
  StageMachine(std::vector<Stage> stages, std::vector<StageRegion> regions, std::size_t fields,
               std::vector<std::uint64_t> felt = {~std::uint64_t{0}});

  // Servo thread, all of the following: no allocation, lock, I/O or throw.

  using Scenes = std::span<scene::Scene>;                   // (devices)
  using Readings = std::span<const device::DeviceReading>;  // likewise

  /// The interval begins with the next tick. @param most_repeats  of the interval; then it aborts
  void begin(Scenes scenes, int most_repeats) noexcept;
  /// @param dt  since the tick before [s]
  /// @param cursor  its place in W [m], for regions that wait for it
  /// @param measurements  of the definition, with this tick, for stages that require one
  void tick(Readings readings, Scenes scenes, double dt,
            const Eigen::Vector3d& cursor = Eigen::Vector3d::Zero(),
            std::span<const Measurement> measurements = {}) noexcept;
  /// Enters a stage, whatever came before: for a replay, which knows when it began.
  void enter(std::size_t stage, Scenes scenes) noexcept;

  State state() const noexcept { return state_; }
  /// Number of the stage that goes on; of an interval that is over the last one.
  std::size_t stage() const noexcept { return stage_; }
  double time_in_stage() const noexcept { return in_stage_; }  // [s]
  int repeats() const noexcept { return repeats_; }
  /// Region in which the tool was missing when the last stage came to its time-out; -1: it was in
  /// all regions.
  struct MissedRegion {
    int region{-1};
    double distance{0.0};  // of the tool to the region [m]
  };
  MissedRegion outside() const noexcept { return outside_; }
  /// The stage that an interval was aborted in, and why, are the last that ended.
  std::span<const StageTimes> times() const noexcept { return times_; }

 private:
  void leave(StageEnd how, Consequence what, Scenes scenes) noexcept;
  bool holds(const Until& until, Readings readings, Scenes scenes, double speed) const noexcept;
  bool measures(const Until& until, Readings readings) const noexcept;
  MissedRegion first_outside(std::uint64_t regions, Readings readings) const noexcept;
  bool all_touch(std::uint64_t fields, Scenes scenes) const noexcept;
  void measure(const Stage& stage, double speed, Scenes scenes) noexcept;
  bool is_enough(const Stage& stage, std::span<const Measurement> measurements) noexcept;
  void press(Readings readings) noexcept;

  std::vector<Stage> stages_;
  std::vector<StageRegion> regions_;
  std::vector<std::uint64_t> felt_;  // (devices)
  std::vector<StageTimes> times_;    // (stages)
  State state_{State::kDone};
  std::size_t stage_{0};
  std::int64_t tick_{0};
  double in_stage_{0.0};  // [s]
  double held_{-1.0};     // for which all held [s]; -1: it does not hold
  std::uint32_t buttons_before_{0}, keys_before_{0};
  std::uint32_t buttons_pressed_{0}, keys_pressed_{0};  // in this stage
  bool hands_known_{false};
  Eigen::Vector3d cursor_{Eigen::Vector3d::Zero()};
  MissedRegion outside_;
  int repeats_{0};
  int most_repeats_{0};
};

}  // namespace haptrial::protocols
