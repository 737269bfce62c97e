#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "core/bone/simulator/bone_touch.h"
#include "core/bone/simulator/companions.h"
#include "protocols/bone_drilling/drilling_pass.h"

namespace haptrial::protocols {

/// A drilling on a bone that belongs to another session: the bone follows what its tools do there
/// (SharedBone). The tool in hand, the view and what the burr does are the other side's; the own
/// hand feels what it would feel with that tool (BoneTouch) and changes nothing. Ends when all of
/// the other side's pass was followed. Source: Morris 2006, §3.4.1.
class LedPass final : public Pass {
 public:
  /// Parts that the pass works with; everything outlives the pass.
  struct Parts {
    bone::Simulator& simulator;
    bone::Companions& companions;  // that do not search for separate parts
    const DrillingParameters& parameters;
    DrillingLogs& logs;
    SharedBone& shared;
    double rate{1000.0};
    std::int32_t trial{0};
    bool real{false};  // parts that come off are then separated by a thread of its own
    nerve::NerveExposures* nerves{nullptr};
    sound::DrillVibration* vibration{nullptr};  // of the burr; null: it does not shake
  };
  explicit LedPass(const Parts& parts);
  ~LedPass() override;

  void begin(std::uint64_t sequence) noexcept override { sequence_ = sequence; }
  PassOutput tick(const Readings& readings, double dt) noexcept override;
  PassState state() const noexcept override;
  bool wants_attention() noexcept override;

  /// Rests when the pass is over: nothing works on the bone any more. Session's thread.
  void rest();
  /// Ticks of the other side that were followed. Not the servo thread while it ticks.
  std::uint64_t ticks() const noexcept { return ticks_; }

 private:
  enum class Split : int { kNone, kAsked, kDone };
  void follow() noexcept;
  bool follow_next() noexcept;
  bool follow_step() noexcept;
  void separate();
  void after_step(const BoneStep& step) noexcept;
  PassOutput output(const Readings& readings) noexcept;

  Parts p_;
  DrillingInput input_;
  DrillingRows rows_;
  bone::BoneTouch touch_;
  int tool_;                   // the one with which the hand felt last
  bone::SimulatorInput last_;  // of the other side's tool
  PassOutput out_;             // of the last tick on which nobody else had the bone
  std::uint64_t sequence_{0};
  std::uint64_t ticks_{0};
  std::size_t splits_{0};    // parcels before the step that separates
  std::uint64_t waited_{0};  // ticks for that
  int followed_{0};          // steps in this tick
  double removed_{0.0};      // in this tick [voxels]
  bool camera_changed_{false};
  bool pass_reached_{false};  // the beginning of one there
  bool first_step_{false};    // of a pass there is next
  bool completed_{false};
  bool outdated_{false};  // the other side has begun with a new bone
  std::uint64_t attended_{0};
  std::atomic<Split> split_{Split::kNone};
  std::atomic<bool> stop_{false};
  std::thread separator_;
};

}  // namespace haptrial::protocols
