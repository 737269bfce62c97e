#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/bone/nerve/nerve_distances.h"
#include "core/bone/nerve/nerve_setup.h"

namespace haptrial::nerve {

/// Effects of a tick on every nerve: goes from the servo thread to the thread that makes
/// electromyograms.
struct NerveTick {
  struct OfNerve {
    float distance{NerveDistances::kFar};  // of the tool's surface [m]
    float warmth{0.0f};                    // above the body's [K]
    float severity{0.0f};                  // of what begins, 0 to 1
    bool burst{false};                     // begins
    bool train{false};                     // likewise
  };
  std::uint64_t sequence{0};  // of the tick
  std::array<OfNerve, kMostChannels> nerves{};
  float current{0.0f};  // of a pulse of the probe that begins with the tick [A]; 0: none
  bool drilling{false};
  bool suction{false};
};

/// A tool on the bone, as far as nerves notice it.
struct ToolAtNerves {
  enum class Kind : std::uint8_t { kOther, kBurr, kSuction, kProbe } kind{Kind::kOther};
  Eigen::Vector3d tip_B{Eigen::Vector3d::Zero()};  // in the bone's frame [m]
  double radius{0.0};                              // of the tool's end [m]
  /// A tool whose end is no ball is these as well; each as the tip.
  struct Ball {
    Eigen::Vector3d centre_B;  // [m]
    double radius;             // [m]
  };
  static constexpr std::size_t kMostBalls = 9;
  std::array<Ball, kMostBalls> more{};
  std::size_t balls{0};  // of them
  double speed{0.0};     // of the tip [m/s]
  double force{0.0};     // on the bone [N]
  double power{0.0};     // with which it turns or sucks, 0 to 1
};

/// The nerves of one bone while a tool works at it. Servo thread: step() neither allocates nor
/// locks, waits, or throws (NerveExposuresTest.AStepDoesNotAllocate).
class NerveExposures {
 public:
  /// @param distances  of the same nerves as the setup's  @param dt  of a tick [s]
  /// @param current    of the probe's next pulse [A], which another thread may change; null: the
  ///                   setup's
  NerveExposures(const NerveSetup& setup, std::shared_ptr<const NerveDistances> distances,
                 std::uint64_t seed, double dt,
                 std::shared_ptr<const std::atomic<float>> current = nullptr);

  /// @returns without a sequence number
  NerveTick step(const ToolAtNerves& tool) noexcept;

 private:
  std::shared_ptr<const NerveDistances> distances_;
  std::vector<IrritatedNerve> nerves_;
  double heat_;
  std::shared_ptr<const std::atomic<float>> current_;
  double dt_;
  double between_pulses_;  // [s]
  double since_pulse_;     // [s]
};

}  // namespace haptrial::nerve
