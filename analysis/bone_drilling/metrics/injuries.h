#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/bone_drilling/metrics/procedure.h"
#include "analysis/bone_drilling/metrics/visibility.h"
#include "core/bone/model/distance_field.h"

namespace haptrial::analysis::drilling {

class StudyBones;

/// How a soft structure tore first.
struct FirstTear {
  double time{0.0};   // [s of the procedure]
  double force{0.0};  // [N]
  bool by_suction{false};
  Eigen::Vector3d place{Eigen::Vector3d::Zero()};  // in W [m]

  bool operator==(const FirstTear&) const = default;
};

/// Injury of a vital structure.
struct Injury {
  std::string structure;
  std::uint8_t label{0};
  std::uint64_t voxels{0};              // of it that a burr or the cut plane emptied
  std::uint64_t crumbled{0};            // that went with parts that turned to dust
  std::optional<double> first_contact;  // a burr that turns reached it [s of the procedure]
  std::optional<double> first_removal;  // [s of the procedure]
  std::uint64_t tears{0};               // of a soft structure
  std::optional<FirstTear> first_tear{};

  bool operator==(const Injury&) const = default;
};

/// Time at which a structure was opened first, by a burr, the cut plane or a tear [s of the
/// procedure].
std::optional<double> opened_at(const Injury& injury);

/// Adds what tore. @param procedure  with its ticks
void add_tears(const Procedure& procedure, std::vector<Injury>& injuries);

/// Meter of injuries that goes along with a drilling. Contact is exact: the burr reaches into the
/// cube of a voxel of the structure as it was at first. One thread, not the servo thread.
class InjuryMeter {
 public:
  InjuryMeter(std::shared_ptr<const bone::BoneModel> bone, const Eigen::Isometry3d& pose_WB,
              const std::vector<ProcedureTool>& tools, StudyBones& bones);

  /// @param burr  in W  @param time  of the procedure [s]
  void tick(const ToolTick& tick, const BurrOnTick& burr, double time);
  void remove(const Removal& removal, double time);
  void crumble(const std::vector<bone::Voxel>& voxels);

  const std::vector<Injury>& injuries() const noexcept { return injuries_; }
  std::uint64_t voxels() const noexcept;  // of all, emptied by a burr or the cut plane

 private:
  bool touches(std::size_t injury, const BurrOnTick& burr_B) const;

  std::shared_ptr<const bone::BoneModel> bone_;
  Eigen::Isometry3d pose_BW_;
  std::vector<std::shared_ptr<const bone::DistanceField>> fields_;  // (injuries)
  std::vector<Injury> injuries_;
};

/// The injuries of a whole procedure: one for each vital structure of its bone, in the order of
/// labels.
std::vector<Injury> injuries(const Procedure& procedure, StudyBones& bones);

}  // namespace haptrial::analysis::drilling
