#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/bone/drill/sight.h"
#include "core/bone/hint/hint_rows.h"
#include "core/bone/hint/hint_setup.h"
#include "core/bone/model/distance_field.h"

namespace haptrial::hint {

/// A tick of a drilling. Plain data, through a block log.
struct HintTick {
  std::uint64_t sequence{0};
  bone::BurrOnTick burr;                         // in W; of another tool: no radius
  Eigen::Vector3d eye{Eigen::Vector3d::Zero()};  // in W [m]
};

/// Change of a voxel on a tick. Likewise.
struct HintVoxel {
  enum class What : std::uint8_t { kRemoved, kCut, kCrumb };  // by a burr; by the cut plane; dust
  std::uint64_t sequence{0};
  What what{What::kRemoved};
  bone::Voxel voxel{bone::Voxel::Zero()};
  double force{0.0};  // of the burr on bone [N]
  double speed{0.0};  // of its tip [m/s]
};

/// Limits and distances for the hints on one bone, as it was made. Immutable: any thread.
class HintMap {
 public:
  /// @throws InputError where force or speed is judged and the limits know no structure of the
  /// bone: hints would be silently off; std::invalid_argument for a reach beyond what distance
  /// fields have
  HintMap(const HintSetup& setup, const bone::BoneModel& bone);

  /// A place by what is near and what is safe there.
  struct Place {
    std::int32_t structure{-1};         // of bone::vital_structures(); -1: none within reach
    double distance{0.0};               // [m]
    const SafeInterval* safe{nullptr};  // null: nothing is known
  };
  Place at(const bone::Voxel& voxel) const noexcept;
  /// Names of the structures near which forces and speeds are judged.
  std::vector<std::string> judged() const;
  /// Empty for -1.
  std::string name(std::int32_t structure) const;

 private:
  std::vector<SafeStructure> structures_;  // vital ones of the bone; without intervals: unknown
  std::vector<std::shared_ptr<const bone::DistanceField>> fields_;  // (structures)
};

/// Which hints are on while a bone is drilled: a function of the ticks and of what they did to the
/// bone alone. A removal is faulty by the rules of the trainee's page
/// (analysis/bone_drilling/feedback/findings.h). One thread, not the servo thread: it allocates.
/// Source: Morris 2006, §3.5.1 and §3.5.2, which judge a procedure when it is over.
class HintWatch {
 public:
  /// @param map   of the bone
  /// @param rate  of ticks [Hz]
  HintWatch(const HintSetup& setup, std::shared_ptr<const HintMap> map,
            std::shared_ptr<const bone::BoneModel> bone, const Eigen::Isometry3d& pose_WB,
            double rate);

  /// A voxel that was gone before: nobody removed it on these ticks.
  void gone(const bone::Voxel& voxel) noexcept { sight_.cut(voxel); }
  /// A tick and what was done on it: crumbs, then removals, then cuts.
  /// @param shown  the participant sees hints now
  void tick(const HintTick& tick, std::span<const HintVoxel> voxels, bool shown);
  /// Hints that are on end with the last tick.
  void end();

  std::uint8_t on() const noexcept;  // bit() of each kind
  /// Index in bone::vital_structures() of what the newest hint of force or speed is about; -1: none
  /// yet.
  std::int32_t structure() const noexcept { return structure_; }
  /// Hints that ended since the rows were cleared.
  std::vector<record::HintRow>& rows() noexcept { return rows_; }

 private:
  struct RunningHint {
    bool on{false};
    std::vector<std::uint64_t> faults;  // sequences of the last ones, at most setup's `fewest`
    double excess{0.0};                 // over the limit, of the worst one
    record::HintRow row;

    bool come(std::uint64_t sequence, int fewest, std::uint64_t within);
  };
  struct Fault {
    const HintVoxel& voxel;
    HintMap::Place place;
    double excess{0.0};
  };
  void removal(const HintTick& tick, const HintVoxel& voxel, bool shown);
  void note(HintKind kind, bool faulty, const Fault& fault, bool shown);
  void keep_worst(RunningHint& running, const Fault& fault) const;
  void end(RunningHint& running);
  RunningHint& of(HintKind kind) noexcept { return running_[static_cast<std::size_t>(kind)]; }

  HintSetup setup_;
  std::shared_ptr<const HintMap> map_;
  bone::VisibilityMeter sight_;
  std::uint64_t within_;  // [ticks]
  std::uint64_t holds_;   // likewise
  std::uint64_t last_{0};
  std::array<RunningHint, kHintKinds> running_;
  std::int32_t structure_{-1};
  std::vector<record::HintRow> rows_;
};

}  // namespace haptrial::hint
