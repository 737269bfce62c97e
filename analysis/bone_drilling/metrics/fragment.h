#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/bone/model/bone_model.h"
#include "core/bone/model/bone_volume.h"
#include "core/bone/record/bone_rows.h"
#include "core/subject/drilling/fragment_plan.h"

namespace haptrial::analysis::drilling {

/// Screws that hold have this length of solid bone in their thread at least [m]; assumed.
inline constexpr double kHoldingPurchase = 2e-3;

/// Outcome of an osteotomy against its plan. The error of the fragment's pose is taken at the
/// middle of the planned cut. Source: Morris 2006, §3.1.2 (what such operations are for) and §3.5.
struct FragmentFit {
  bool came_off{false};  // a piece did; without one nothing below is defined but the cut
  double gap{0.0};       // of the error, along the cut's normal; above 0: the slot stands open [m]
  double step{0.0};      // across it >= 0 [m]
  double turn{0.0};      // angle between the achieved and the planned orientation >= 0 [rad]
  std::optional<double>
      bite_mean;  // distance of the fragment's teeth from their planned places [m]
  std::optional<double> bite_most;  // likewise, the greatest [m]
  std::optional<double> off_cut;    // root mean square distance of removed bone from the plane [m]
  int screws{0};                    // with a purchase of kHoldingPurchase at least
  int screws_in_bone{0};            // of them, on the bone's side of the cut
  double purchase{0.0};             // of all screws [m]

  bool operator==(const FragmentFit&) const = default;
};

/// Meter that goes along with an osteotomy. The larger side of a cut stays in its holder: where
/// that is the planned fragment, its motion is the inverse of that of the side which came off. One
/// thread, not the servo thread.
class FragmentMeter {
 public:
  FragmentMeter(std::shared_ptr<const bone::BoneModel> bone, const Eigen::Isometry3d& pose_WB,
                const subject::FragmentPlan& plan);

  void add(const record::PieceRow& row);
  void add(const record::ScrewRow& row);
  /// A voxel that is gone, however it went.
  void remove(const bone::Voxel& voxel);

  FragmentFit fit() const;

 private:
  struct Piece {
    std::int64_t voxels{0};
    Eigen::Isometry3d motion{Eigen::Isometry3d::Identity()};
  };

  std::shared_ptr<const bone::BoneModel> bone_;
  Eigen::Isometry3d pose_WB_;
  subject::FragmentPlan plan_;
  std::vector<Eigen::Vector3d> teeth_;  // beyond the cut, in W [m]
  bool stays_{false};                   // the planned fragment is the larger side
  std::map<std::int32_t, Piece> pieces_;
  std::map<std::pair<std::int32_t, std::int32_t>, record::ScrewRow> screws_;  // by plate and hole
  double off_squares_{0.0};                                                   // [m2]
  std::uint64_t removed_{0};
};

}  // namespace haptrial::analysis::drilling
