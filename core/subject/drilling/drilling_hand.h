#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "core/base/definition/schema_forward.h"
#include "core/bone/simulator/drilling_view.h"
#include "core/device/virtual_device.h"
#include "core/stimulus/observer.h"
#include "core/subject/hand_model.h"
#include "core/subject/noise.h"

namespace haptrial::subject {

/// Task of a virtual hand that drills, and its manner. Places are the device's, in W.
struct DrillingHandParameters {
  Eigen::Vector3d start{0.0, 0.03, 0.0};              // over the middle of the region [m]
  Eigen::Vector3d inward{-Eigen::Vector3d::UnitY()};  // into the bone, unit length
  Eigen::Vector3d along{Eigen::Vector3d::UnitX()};    // of strokes, unit length, across `inward`
  double width{0.012};                                // of the region, along strokes > 0 [m]
  double height{0.008};                               // of the region, across them >= 0 [m]
  double depth{0.006};           // to drill to, from where bone was met first >= 0 [m]
  double line{0.0015};           // between strokes > 0 [m]
  double press{2.0};             // force on the bone >= 0 [N]
  double speed{0.02};            // of strokes > 0 [m/s]
  double hover{0.004};           // height between strokes >= 0 [m]
  double force_noise{0.05};      // share of the press >= 0
  double force_noise_time{0.1};  // > 0 [s]
  double tremor{0.03};           // >= 0 [N]
  double tremor_frequency{9.0};  // > 0 [Hz]
  int power_button{0};           // of the device: what makes the burr turn
  int next_button{-1};           // takes the next tool; -1: no suction
  int previous_button{-1};       // takes the tool before
  int suction_tool{1};           // its number
  int strokes_to_suction{40};    // so many strokes, then suction > 0
  double suction_time{2.0};      // >= 0 [s]
  int look_button{-1};           // turns the camera while held; -1: it is never used
};

/// The keys of [drilling_hand].
const Schema<DrillingHandParameters>& drilling_hand_schema();

/// A simulated participant who drills a region away, stroke by stroke: goes down until bone is
/// met, presses while it moves along, lifts, begins the next stroke; after some strokes it takes
/// the suction, and after each round over the region it looks from elsewhere. It knows its plan
/// and what the screen shows: where the tip is, which tool it is, whether it touches bone. It is a
/// rehearsal, no surgeon: what it assumes is in docs/algorithms/virtual-subject.md.
class DrillingHand final : public stimulus::Observer {
 public:
  /// @param hand, device  of the participant; outlive this
  /// @param scale         of the scene in the device's workspace: what is shown times this is where
  ///                      the device is
  /// @param step          servo period > 0 [s]
  DrillingHand(const DrillingHandParameters& parameters, HandModel& hand,
               device::VirtualDevice& device, double scale, std::uint64_t seed, double step);

  void observe(const stimulus::Shown& shown, const stimulus::Forces& forces,
               double dt) noexcept override;

  int strokes() const noexcept { return strokes_; }

 private:
  enum class Activity { kReach, kDescend, kStroke, kLift, kChange, kSuck, kLook };
  void begin(Activity doing) noexcept;
  void next_line() noexcept;
  Eigen::Vector3d line_start() const noexcept;
  void decide(const bone::DrillingView& seen, const Eigen::Vector3d& tip) noexcept;
  Eigen::Vector3d push(const bone::DrillingView& seen, const Eigen::Vector3d& tip,
                       double dt) noexcept;
  std::uint32_t fingers(const bone::DrillingView& seen) const noexcept;

  DrillingHandParameters parameters_;
  HandModel& hand_;
  device::VirtualDevice& device_;
  double scale_;
  MotorNoise noise_;
  Eigen::Vector3d across_;
  int lines_;

  Activity doing_{Activity::kReach};
  double time_{0.0};  // in it [s]
  int line_{0};
  bool back_{false};  // the stroke runs against `along`
  int strokes_{0};
  int wanted_tool_{0};
  bool surface_known_{false};
  double higher_{0.0};   // than usual between strokes, where bone was in the way [m]
  double surface_{0.0};  // along `inward`, where bone was met first [m]
  Eigen::Vector3d target_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d last_tip_{Eigen::Vector3d::Zero()};
  bool tip_known_{false};
};

}  // namespace haptrial::subject
