#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/bone/dust/dust_parameters.h"
#include "core/bone/dust/dust_surroundings.h"

namespace haptrial::bone {

/// A cell of dust to draw as a few grains.
struct DustQuad {
  Eigen::Vector3f position{Eigen::Vector3f::Zero()};  // of its middle, in W [m]
  float size{0.0005F};                                // of the cell [m]
  float alpha{0.5F};                                  // from 0 to 1
};

struct DustState;

/// Account of all that was deposited, in solid voxels. The parts add up to `deposited` exactly:
/// each is a whole number of 2^-20 voxels.
struct DustBalance {
  double deposited{0.0};
  double lying{0.0};      // in cells, moving or at rest
  double held{0.0};       // at the burr, for want of room
  double suctioned{0.0};  // by a tube, or carried off by water
  double fallen{0.0};     // out of the region, or of the memory that there may be
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
  /// Sets the places of the tools during the steps to come.
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
  /// Content of a full cell, in solid voxels.
  double capacity() const noexcept;
  /// Seconds of one step: cell / fall_speed.
  double step_time() const noexcept;
  /// Cleared and filled, in order of the cells' blocks.
  void quads(std::vector<DustQuad>& quads) const;

 private:
  std::unique_ptr<DustState> state_;
};

}  // namespace haptrial::bone
