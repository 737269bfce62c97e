#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/bone_drilling/metrics/fragment.h"
#include "analysis/bone_drilling/metrics/procedure.h"
#include "core/bone/model/distance_field.h"
#include "core/subject/drilling/cavity_plan.h"

namespace haptrial::analysis::drilling {

class StudyBones;

/// Thicker bone over a structure is not measured [m].
inline constexpr double kLeftReach = 10e-3;

/// Least thickness that a procedure left over a vital structure.
struct BoneLeft {
  std::string structure;
  std::optional<double> thickness;  // from 0, opened or bare; nothing beyond kLeftReach [m]

  bool operator==(const BoneLeft&) const = default;
};

/// Emptied bone, counted by the plan of a cavity.
struct PlanCount {
  std::uint64_t planned{0};  // voxels that the plan asks for
  std::uint64_t removed{0};  // of these
  std::uint64_t beyond{0};   // plain bone more than a voxel off the plan
  std::uint64_t injured{0};  // of vital structures

  /// @returns the share of the plan that is gone; nothing where it asks for nothing
  std::optional<double> share() const;
  void add(subject::PlanPart part);
  bool operator==(const PlanCount&) const = default;
};

/// The vital structures that a bone has, in the order of labels, with nothing measured.
std::vector<BoneLeft> untouched(const bone::BoneModel& bone);

/// Achievement of a procedure, and its cost. Source: Morris 2006, §3.5.
struct Achieved {
  std::optional<PlanCount> plan;          // nothing: the definition has no [cavity]
  double voxel{0.0};                      // volume of one [m3]
  std::vector<BoneLeft> left;             // by vital structure, in the order of labels
  double path{0.0};                       // of the tip while the hand drives a tool [m]
  std::optional<FragmentFit> fragment{};  // nothing: the definition has no [osteotomy]

  std::optional<double> removed() const;  // of the plan [m3]
  std::optional<double> beyond() const;   // [m3]
  /// Planned bone removed by length of the path [m3/m]; nothing without a path.
  std::optional<double> economy() const;
  bool operator==(const Achieved&) const = default;
};

/// A quantity of Achieved for people and tables.
struct AchievedFigure {
  std::string column;  // of metrics.csv
  std::string title;
  std::string unit;               // "%", "mm3", ...; what `value` is in
  std::optional<double> value;    // nothing: not defined
  bool measured_to_reach{false};  // of bone left: without a value, more than kLeftReach is left
};

/// All of them, those of the plan first; those of a cavity only where no osteotomy is planned.
std::vector<AchievedFigure> figures_of(const Achieved& achieved);

/// Meter that goes along with a drilling; a few look-ups for each voxel and tick. One thread, not
/// the servo thread.
class AchievedMeter {
 public:
  /// @param rate  of ticks [Hz]
  AchievedMeter(const ProcedurePlans& plans, std::shared_ptr<const bone::BoneModel> bone,
                const Eigen::Isometry3d& pose_WB, double rate, StudyBones& bones);

  void tick(const ToolTick& tick);
  /// A voxel that is gone, however it went.
  void remove(const bone::Voxel& voxel);
  void add(const record::PieceRow& row);
  void add(const record::ScrewRow& row);

  Achieved achieved() const;

 private:
  std::shared_ptr<const bone::BoneModel> bone_;
  std::shared_ptr<const subject::CavityPlan> plan_;
  std::optional<FragmentMeter> fragment_;
  std::vector<std::shared_ptr<const bone::DistanceField>> fields_;  // (achieved_.left)
  std::vector<std::optional<double>> nearest_;                      // (achieved_.left) [m]
  std::vector<bool> gone_;                                          // (grid.count())
  Achieved achieved_;
  std::uint64_t step_;  // of the path [ticks]
  bool on_path_{false};
  ToolTick from_, last_;  // of the path's present step
};

}  // namespace haptrial::analysis::drilling
