#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/bone/simulator/drilling_view.h"
#include "core/device/virtual_device.h"
#include "core/stimulus/observer.h"
#include "core/subject/drilling/drilling_chart.h"
#include "core/subject/drilling/drilling_memory.h"
#include "core/subject/drilling/drilling_skill.h"
#include "core/subject/drilling/hint_heeding.h"
#include "core/subject/drilling/surgeon_work.h"
#include "core/subject/hand_model.h"
#include "core/subject/noise.h"

namespace haptrial::subject {

/// A burr that a virtual surgeon may take.
struct SurgeonBurr {
  int tool{0};          // its number
  double radius{3e-3};  // > 0 [m]
};

/// Parameters of a virtual surgeon.
struct SurgeonParameters {
  double skill{0.5};  // of the group, 0 to 1
  int earlier{0};     // procedures that it did on days before >= 0
  SkillSpread spread;
  SurgeonBurr rough;     // for most of it
  SurgeonBurr fine;      // for what is near a structure
  double reaction{0.6};  // from a tone of the nerve monitor, or a hint, until it acts > 0 [s]
  double heeds{0.0};     // share of hints that it heeds, 0 to 1
  int power_button{0};
  int next_button{1};
  int previous_button{2};
  int look_button{4};    // turns the view while held; -1: the view stays
  int finish_button{5};  // -1: works until the time is over
};

/// A simulated participant who does a mastoidectomy: bouts of strokes with the virtual hand of the
/// core, from the highest bone down, rough burr first, the fine one near structures; looks from
/// where it can see; says when it is done. How well, depends on one number, its skill
/// (drilling_skill.h). It knows the chart, with an error, what the screen shows of the tool, and
/// where its burr has been; never the bone itself. It is a rehearsal of a study and no surgeon:
/// docs/algorithms/virtual-surgeon.md.
class DrillingSurgeon final : public stimulus::Observer {
 public:
  /// @param charts        of the bones of its procedures, in order; beyond them the last again
  /// @param hand, device  of the participant; outlive this
  /// @param scale         of the scene in the device's workspace
  /// @param step          servo period > 0 [s]
  /// @param work          receives what it works on; null: nobody asks. Outlives this
  DrillingSurgeon(const SurgeonParameters& parameters,
                  std::vector<std::shared_ptr<const DrillingChart>> charts, HandModel& hand,
                  device::VirtualDevice& device, double scale, std::uint64_t seed, double step,
                  WorkLog* work = nullptr);

  void observe(const stimulus::Shown& shown, const stimulus::Forces& forces,
               double dt) noexcept override;

  double skill(std::size_t procedure) const { return procedures_[procedure].skill_number; }
  std::uint64_t series() const noexcept { return series_; }

 private:
  /// Made up beforehand: nothing allocates while a procedure runs.
  struct Procedure {
    std::shared_ptr<const DrillingChart> chart;
    double skill_number;
    DrillingSkill skill;
    CavityView view;
    bool careful;
    BurrReach rough;
    BurrReach fine;  // empty unless careful
    MotorNoise noise;
    RandomStream random;
    HintHeeding heeding;
    DrillingMemory memory;
  };
  enum class Activity {
    kLift,
    kTravel,
    kDescend,
    kStrokes,
    kPause,
    kLook,
    kChange,
    kWithdraw,
    kFinish
  };

  static Procedure plan(const SurgeonParameters& p, std::shared_ptr<const DrillingChart> chart,
                        std::uint64_t seed, int number, double step);
  void begin(Activity doing) noexcept;
  void begin_procedure() noexcept;
  void listen(const bone::DrillingView& seen, const Eigen::Vector3d& place, double dt) noexcept;
  void heed(const bone::DrillingView& seen, double dt) noexcept;
  void next_strokes(const bone::DrillingView& seen) noexcept;
  bool end_before_margin() noexcept;
  SurgeonWork work() const noexcept;
  bool wants_to_look(const bone::DrillingView& seen) noexcept;
  void decide(const bone::DrillingView& seen, const Eigen::Vector3d& place) noexcept;
  void decide_strokes(const bone::DrillingView& seen, const Eigen::Vector3d& place) noexcept;
  void move_goal(const bone::DrillingView& seen, double dt) noexcept;
  void follow_strokes() noexcept;
  void go_to(const Eigen::Vector3d& place, double speed, double dt) noexcept;
  Eigen::Vector3d push(const bone::DrillingView& seen, const Eigen::Vector3d& place) noexcept;
  double far_share(const Eigen::Vector3d& place) const noexcept;
  double press(const Eigen::Vector3d& place) const noexcept;
  double pace(const Eigen::Vector3d& place) const noexcept;
  double depth_limit(const Eigen::Vector3d& place) const noexcept;
  std::uint32_t fingers(const bone::DrillingView& seen) const noexcept;
  const SurgeonBurr& burr() const noexcept { return fine_ ? parameters_.fine : parameters_.rough; }
  Procedure& now() noexcept { return procedures_[at_]; }
  const Procedure& now() const noexcept { return procedures_[at_]; }

  SurgeonParameters parameters_;
  HandModel& hand_;
  device::VirtualDevice& device_;
  double scale_;
  WorkLog* work_;
  std::vector<Procedure> procedures_;

  std::size_t at_{0};
  int begun_{0};  // procedures
  bool works_{false};
  Activity doing_{Activity::kLift};
  double time_{0.0};  // in it [s]
  bool fine_{false};
  std::uint64_t series_{0};
  StrokeSeries strokes_;
  double stroke_rate_{1.0};                         // of its strokes [1/s]
  double stroke_depth_{0.0};                        // of the burr's centre where the bout began [m]
  double idle_{0.0};                                // of the bout, without bone under the burr [s]
  double heard_{0.0};                               // since when a tone goes on [s]
  double lift_to_{0.0};                             // depth of the centre [m]
  bool looks_{false};                               // before the bout
  Eigen::Vector3d look_{Eigen::Vector3d::UnitZ()};  // direction from which it wants to see, in W
  Eigen::Vector3d goal_{Eigen::Vector3d::Zero()};   // of the arm, a place
  Eigen::Vector3d goal_velocity_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d last_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d velocity_{Eigen::Vector3d::Zero()};
  bool place_known_{false};
};

}  // namespace haptrial::subject
