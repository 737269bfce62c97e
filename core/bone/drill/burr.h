#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace haptrial {
class Table;
}

namespace haptrial::bone {

enum class BurrKind : std::uint8_t { kDiamond, kCutting };

/// A spherical burr. Rates and gains are per volume of bone that the burr is immersed in, not per
/// sample: a finer sampling feels and drills the same.
struct BurrParameters {
  BurrKind kind{BurrKind::kDiamond};
  double diameter{4e-3};             // from 0.0005 to 0.03 [m]
  double sample_spacing{4e-3 / 28};  // edge of a cell with one sample > 0; at most 1e6 samples [m]
  bool follows_bone{true};           // samples come closer in finer bone: for_bone()
  double removal_rate{10.0};         // R_max, share of the immersed volume >= 0 [1/(N·s)]
  double falloff{2.0};               // of the rate with latitude >= 0 [1/(N·s·rad)]
  double tangential_gain{1e11};      // per immersed volume and distance from the axis >= 0 [N/m^4]
  bool clockwise{true};              // turns so, seen from the handle: the teeth cut forward
};

/// What a burr of this kind and size does unless told otherwise: samples 0.25 mm apart, or 28 over
/// the diameter where that is less; a cutting burr has a higher rate, a higher falloff and a
/// stronger pull along the bone. Source: Morris 2006, §3.2.3.6.
BurrParameters default_burr(BurrKind kind, double diameter);

/// The same burr with samples for bone of this spacing, unless they are told: at most half a voxel
/// apart, which puts a sample into every voxel that lies in the burr, or as close as 400,000
/// samples allow. @param voxel  its edge [m]
BurrParameters for_bone(const BurrParameters& burr, double voxel);

/// Reads a [burr] table: kind ("diamond", "cutting") and diameter [m]; the others are optional.
BurrParameters read_burr_parameters(Table& table);

/// A burr as a cloud of samples that fills it: the sphere is cut into cubic cells, and each cell
/// has one sample at an uneven place, so that samples do not enter a flat bone by whole layers.
/// Cells of at most half a voxel's edge put a sample into every voxel that lies in the burr; with
/// wider ones a burr misses some until it moves across.
/// With every sample its mirror image through the centre is one too. All in the tool frame T
/// (core/base/tool_state.h), all precomputed. Immutable: any thread.
/// Source: Morris 2006, §3.2.3.4 to §3.2.3.7.
class Burr {
 public:
  static constexpr std::int32_t kRadius = 32767;  // of the sphere, in units of Arrays' positions
  static constexpr std::int32_t kUnit = 16384;    // length of Arrays' directions

  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  explicit Burr(const BurrParameters& parameters);

  const BurrParameters& parameters() const noexcept { return parameters_; }
  double radius() const noexcept { return 0.5 * parameters_.diameter; }  // [m]
  std::int32_t samples() const noexcept { return static_cast<std::int32_t>(power_.size()); }
  double sample_volume() const noexcept { return sample_volume_; }  // the sphere's share [m^3]

  Eigen::Vector3d position(std::int32_t sample) const;   // p_T [m]
  Eigen::Vector3d direction(std::int32_t sample) const;  // towards the centre, unit length, in T
  /// Share of the immersed volume that is removed, max(0, R_max - falloff |latitude|) [1/(N·s)].
  float power(std::int32_t sample) const { return power_[static_cast<std::size_t>(sample)]; }

  /// A cube of the burr with the samples in it, which lie one after the other.
  struct Cell {
    std::array<std::int32_t, 3> centre;  // kRadius is the sphere's radius
    std::int32_t half;                   // of its edge, likewise
    std::int32_t first;                  // sample
    std::int32_t count;
    std::int32_t after;  // the cell that follows when those within this one are passed over
    bool leaf;
    std::array<std::int32_t, 3> direction;  // sums over the samples, as Arrays has them
    std::array<std::int32_t, 3> position;
  };
  /// The tree of cells, each before those within it; none where samples are few.
  const std::vector<Cell>& cells() const noexcept { return cells_; }

  /// For kernels: samples() numbers each.
  struct Arrays {
    const std::int16_t* x;  // positions, kRadius is the sphere's radius
    const std::int16_t* y;
    const std::int16_t* z;
    const std::int16_t* dx;  // directions, kUnit long
    const std::int16_t* dy;
    const std::int16_t* dz;
    const float* power;
    std::int32_t count;
  };
  Arrays arrays() const noexcept;

 private:
  BurrParameters parameters_;
  double sample_volume_{0.0};
  std::vector<std::int16_t> position_[3];
  std::vector<std::int16_t> direction_[3];
  std::vector<float> power_;
  std::vector<Cell> cells_;
};

}  // namespace haptrial::bone
