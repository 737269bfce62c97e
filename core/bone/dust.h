#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/bone/bone_volume.h"
#include "core/bone/dust_quad.h"

namespace haptrial {
class Table;
}

namespace haptrial::bone {

struct DustParameters {
  double cell{0.5e-3};           // edge of a cell > 0 [m]
  double voxel{0.5e-3};          // edge of the voxels in whose volumes dust is counted > 0 [m]
  double bulking{1.6};           // loose dust takes this many times the room of solid bone >= 1
  double fall_speed{0.15};       // > 0 [m/s]
  double slope{0.65};            // of a pile at rest, rise over run, 0.05 to 0.7
  double suction_rate{1.5e-6};   // solid volume a second > 0 [m3/s]
  double suction_reach{2.5e-3};  // from the nozzle's mouth > 0 [m]
  Eigen::Vector3d up{Eigen::Vector3d::UnitY()};  // against gravity in W, of any length but 0
  /// Dust that leaves this box in W has fallen out.
  Eigen::AlignedBox3d region{Eigen::Vector3d::Constant(-0.15), Eigen::Vector3d::Constant(0.15)};
  int max_blocks{4096};  // of 512 cells: bounds the memory, 1 to 100,000
};

/// Reads the keys of a [dust] table: cell, bulking, fall_speed, slope, suction_rate,
/// suction_reach.
DustParameters read_dust_parameters(Table& table);

/// Bone that dust cannot pass: a volume, kept alive by the caller, and the pose of its frame B.
struct DustBone {
  const BoneVolume* volume{nullptr};
  Eigen::Isometry3d X_WB{Eigen::Isometry3d::Identity()};
};

/// Bone that a burr has turned into dust, at the place of the burr.
struct DustDeposit {
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};  // of the burr in W [m]
  double radius{0.0};                               // of the burr: dust appears around it >= 0 [m]
  double amount{0.0};                               // in solid voxels >= 0
};

/// A tool that dust gives way to: a sphere swept along a segment. Burr, handle, suction tube.
struct DustTool {
  Eigen::Vector3d tip{Eigen::Vector3d::Zero()};    // centre of the first sphere in W [m]
  Eigen::Vector3d axis{Eigen::Vector3d::UnitY()};  // from the tip to the hand, unit length
  double length{0.0};                              // of the segment >= 0 [m]
  double radius{0.0};                              // 0: no tool [m]
  bool sucks{false};                               // dust near the tip is taken away
};
struct DustTools {
  static constexpr int kMost = 4;
  std::array<DustTool, kMost> tools{};  // those of radius 0 are not there
};

/// Where all that was deposited is, in solid voxels. The parts add up to `deposited` exactly: each
/// is a whole number of 2^-20 voxels.
struct DustBalance {
  double deposited{0.0};
  double lying{0.0};  // in cells, moving or at rest
  double held{0.0};   // at the burr, for want of room
  double suctioned{0.0};
  double fallen{0.0};  // out of the region, or of the memory that there may be
};

/// Bone dust as amounts in the cells of a hashed grid, without particles. In steps of
/// cell / fall_speed, amounts go down a cell where there is room and no bone; what rests on
/// something flows to lower neighbours where it stands steeper than the slope of repose; tools push
/// out what lies in their way. Nothing crosses a voxel of bone: the straight line between two cells
/// must be free.
///
/// Amounts are integers, and flows of a layer are found before any is made: the state depends on
/// nothing but the calls, and has the symmetry of its surroundings. Cells at rest sleep: a step
/// costs time for cells that move. Bone that goes away wakes what lay on it.
///
/// One thread, never the servo thread. Source: Morris 2006, §3.2.8; docs/algorithms/bone-dust.md.
class Dust {
 public:
  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  explicit Dust(const DustParameters& parameters);
  ~Dust();
  Dust(const Dust&) = delete;
  Dust& operator=(const Dust&) = delete;

  /// Catches up with the bones as they are now: what was removed, came, went or moved since.
  void follow(std::span<const DustBone> bones);
  /// Where tools are during the steps to come.
  void place(const DustTools& tools);
  /// Puts dust around a burr, into cells that a straight line from its centre reaches.
  void deposit(const DustDeposit& deposit);
  /// Lets dt seconds pass; what is less than a whole step is kept for the next call.
  void step(double dt);

  DustBalance balance() const noexcept;
  std::size_t cells() const noexcept;      // that hold dust
  std::size_t active() const noexcept;     // that the next step will look at
  std::size_t blocks() const noexcept;     // of 512 cells in memory
  std::uint64_t version() const noexcept;  // grows when any amount changes

  /// The dust of the cell around a point of W, in solid voxels; 0 outside the region.
  double amount_at(const Eigen::Vector3d& p_W) const noexcept;
  /// What a full cell holds, in solid voxels.
  double capacity() const noexcept;
  /// Seconds of one step: cell / fall_speed.
  double step_time() const noexcept;
  /// Cleared and filled, in order of the cells' blocks.
  void quads(std::vector<DustQuad>& quads) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::bone
