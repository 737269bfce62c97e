#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/bone/simulator/drilling_view.h"
#include "core/bone/simulator/simulator_tools.h"
#include "core/device/virtual_device.h"
#include "core/stimulus/observer.h"
#include "core/subject/drilling/fragment_plan.h"
#include "core/subject/hand_model.h"
#include "core/subject/noise.h"

namespace haptrial::subject {

/// Manner of a virtual hand that does an osteotomy. Places and directions are the scene's, in W.
struct OsteotomyHandParameters {
  Eigen::Vector3d from{Eigen::Vector3d::Zero()};          // line along which it saws, over bone [m]
  Eigen::Vector3d to{Eigen::Vector3d::UnitZ()};           // its end [m]
  Eigen::Vector3d inward{-Eigen::Vector3d::UnitY()};      // of sawing, unit length
  double depth{0.015};                                    // of the teeth, below the line > 0 [m]
  double spacing{0.006};                                  // between cuts, at most > 0 [m]
  double press{4.0};                                      // on the saw > 0 [N]
  Eigen::Vector3d grip{Eigen::Vector3d::Zero()};          // where it takes the fragment [m]
  Eigen::Vector3d plate{Eigen::Vector3d::Zero()};         // middle of the plate, on the bone [m]
  Eigen::Vector3d plate_out{Eigen::Vector3d::UnitY()};    // out of the bone there, unit length
  Eigen::Vector3d plate_along{Eigen::Vector3d::UnitX()};  // unit length, across `plate_out`
  double tremor{0.03};                                    // >= 0 [N]
  int power_button{0};
  int next_button{1};
  int apply_button{2};   // fixes the plate
  int finish_button{5};  // ends the procedure
};

/// The keys of [osteotomy_hand].
const Schema<OsteotomyHandParameters>& osteotomy_hand_schema();

/// The first tool of each type in the order of hands, and what a hand must know of it.
struct OsteotomyTools {
  int saw{0};
  int grip{0};
  int plate{0};
  int screw{0};
  std::vector<Eigen::Isometry3d> holes;  // of the plate, in its frame
  double screw_time{0.0};                // to drive one [s]
};
/// Types that an osteotomy needs and that are not among the tools.
std::vector<const char*> missing_tools(std::span<const bone::ToolSpec> tools);
/// @param tools  none of the types is missing
OsteotomyTools osteotomy_tools(std::span<const bone::ToolSpec> tools);

/// How a scene lies in the device's workspace, and which way its handle runs.
struct HandFrame {
  double scale{1.0};
  Eigen::Vector3d handle{Eigen::Vector3d::UnitZ()};
};

/// Place over the line at which the hand begins, in the scene [m].
Eigen::Vector3d start_of(const OsteotomyHandParameters& parameters);

/// A simulated participant who does an osteotomy as it is planned: saws along a line, takes the
/// fragment, moves it to its planned pose as far as bone lets it, lays the plate on, and drives a
/// screw into each hole. It sees where its tool is and which one it has; it knows the plan and not
/// the bone. A rehearsal of the session, no surgeon.
class OsteotomyHand final : public stimulus::Observer {
 public:
  /// @param hand, device  of the participant; outlive this
  /// @param step          servo period > 0 [s]
  OsteotomyHand(const OsteotomyHandParameters& parameters, const FragmentPlan& plan,
                const OsteotomyTools& tools, HandModel& hand, device::VirtualDevice& device,
                const HandFrame& frame, std::uint64_t seed, double step);

  void observe(const stimulus::Shown& shown, const stimulus::Forces& forces,
               double dt) noexcept override;

 private:
  /// One thing to do with one tool.
  struct ToolAction {
    int tool{0};
    Eigen::Isometry3d goal{Eigen::Isometry3d::Identity()};  // of the tool, in the scene
    double speed{0.05};                                     // of the way there [m/s]
    double strength{5.0};                                   // of the arm at most [N]
    double least{0.0};                                      // time at the goal [s]
    double most{4.0};                                       // time in all [s]
    double depth{0.0};                                      // ends below it along `inward`; 0: none
    bool power{false};
    int button{-1};  // that is pressed at the goal; -1: none
  };
  void plan_cuts(const FragmentPlan& plan, const OsteotomyTools& tools);
  void plan_move(const FragmentPlan& plan, const OsteotomyTools& tools);
  void plan_plate(const OsteotomyTools& tools);
  void add(ToolAction act, const Eigen::Isometry3d& goal);
  bool is_done(const ToolAction& act, const Eigen::Vector3d& tip) const noexcept;
  void approach(const ToolAction& act, double dt) noexcept;
  std::uint32_t fingers(const ToolAction& act, const bone::DrillingView& seen) const noexcept;

  OsteotomyHandParameters parameters_;
  HandModel& hand_;
  device::VirtualDevice& device_;
  HandFrame frame_;
  MotorNoise noise_;
  std::vector<ToolAction> acts_;
  std::size_t at_{0};
  double time_{0.0};        // in the act [s]
  double time_there_{0.0};  // at its goal [s]
  bool begun_{false};
  Eigen::Isometry3d target_{Eigen::Isometry3d::Identity()};  // of the tool now
  Eigen::Vector3d last_tip_{Eigen::Vector3d::Zero()};        // of the device [m]
};

}  // namespace haptrial::subject
