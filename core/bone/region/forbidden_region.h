#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/bone/drill/burr_shape.h"
#include "core/bone/model/bone_model.h"
#include "core/bone/region/region_setup.h"
#include "core/bone/simulator/soft_tissue.h"
#include "core/realtime/block_log.h"
#include "core/record/table/table.h"

namespace haptrial::bone {

/// Distances from the structures of forbidden regions, of a bone before anything was drilled. Made
/// once for a bone; any thread reads it.
class RegionMap {
 public:
  /// @param largest  radius of a burr [m]
  /// @throws InputError for a structure that the bone does not have
  RegionMap(const RegionSetup& setup, const BoneModel& model, double largest);

  std::size_t size() const noexcept { return depths_.size(); }                  // structures
  const std::vector<std::uint8_t>& labels() const noexcept { return labels_; }  // by structure
  const SurfaceDepth& depth(std::size_t structure) const noexcept { return depths_[structure]; }

 private:
  std::vector<std::uint8_t> labels_;
  std::vector<SurfaceDepth> depths_;
};

/// A burr, n balls of radius r and centre c, is kept out of the margin m around each structure,
/// whose signed distance is φ. With the depths p_b = r + m - φ(c) > 0 of its balls, else 0:
///
///     f = min(k p, f_max) Σ (p_b / p)^31 ∇φ(c_b),   p^32 = Σ p_b^32
///
/// That is min(k p, f_max) ∇φ if one ball is the deepest; if n are equally deep, p is n^(1/32) of
/// their depth (1.07 for nine). If a burr lies between two sides of a structure, the force goes
/// over from the one ball to the other without a step.
///
/// The force is minus the gradient of an energy, k p² / 2 and beyond p = f_max / k a line, so that
/// nothing is gained on a closed path; it begins at 0 where the burr enters.
/// A burr that is in a region when it is taken in hand, or when the hand comes back from the
/// camera, is not pushed before it has left: it would be thrown out.
///
/// Servo thread: no allocation, lock or throw after construction.
class ForbiddenRegion {
 public:
  /// @param map  not null
  ForbiddenRegion(const RegionSetup& setup, std::shared_ptr<const RegionMap> map);

  /// The burr is another one, or was away.
  void forget() noexcept;
  /// @param balls  of the burr along its axis from the tip; none: it is no burr
  /// @returns the force on it, in B [N]
  Eigen::Vector3d tick(std::span<const BurrShape::Ball> balls, const Eigen::Vector3d& tip_B,
                       const Eigen::Vector3d& axis_B) noexcept;
  /// How deep the burr is in the region of each structure; 0: outside [m].
  std::span<const double> depths() const noexcept { return depths_; }
  /// Energy of the force of a burr that is felt [J].
  double energy(std::span<const BurrShape::Ball> balls, const Eigen::Vector3d& tip_B,
                const Eigen::Vector3d& axis_B) const noexcept;

 private:
  struct Depth {
    double deepest{0.0};                               // of a ball [m]
    double joint{0.0};                                 // p [m]
    Eigen::Vector3d way_out{Eigen::Vector3d::Zero()};  // minus the gradient of p
  };
  Depth depth(std::size_t structure, std::span<const BurrShape::Ball> balls,
              const Eigen::Vector3d& tip_B, const Eigen::Vector3d& axis_B) const noexcept;

  double margin_, spring_, most_;
  std::shared_ptr<const RegionMap> map_;
  std::vector<double> depths_;  // (structures)
  std::vector<bool> felt_;      // (structures) the burr has been outside since it was taken
};

}  // namespace haptrial::bone

namespace haptrial::record {

/// A burr's way through a forbidden region, a row of /crossings. Goes through a block log.
struct CrossingRow {
  std::uint64_t sequence{0};  // of the last tick in it
  std::uint64_t begin{0};     // of the first
  std::uint8_t label{0};      // of the structure
  bool given{false};          // the participant felt or heard it; else only recorded
  double depth{0.0};          // greatest, of the burr's surface in the margin [m]
};

template <>
const Table<CrossingRow>& table_of<CrossingRow>();

}  // namespace haptrial::record

namespace haptrial::bone {

/// Turns depths in regions, tick by tick, into crossings. Servo thread: no allocation.
class CrossingWatch {
 public:
  /// @param labels  of the structures
  explicit CrossingWatch(std::vector<std::uint8_t> labels);

  /// @param given   whether the participant feels or hears the regions
  /// @param depths  (structures) 0: outside [m]
  /// @returns whether the burr has just entered a region
  bool after_tick(std::uint64_t sequence, bool given, std::span<const double> depths,
                  realtime::BlockLog<record::CrossingRow>& log) noexcept;
  /// Ends the crossings that are on; while no drilling ticks, or on the servo thread.
  void end(realtime::BlockLog<record::CrossingRow>& log) noexcept;

 private:
  struct Crossing {
    bool on{false};
    record::CrossingRow row;
  };
  std::vector<Crossing> crossings_;  // (structures)
};

}  // namespace haptrial::bone
