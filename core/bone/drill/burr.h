#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/bone/drill/burr_shape.h"

namespace haptrial::bone {

enum class BurrKind : std::uint8_t { kDiamond, kCutting };

/// A burr. Rates and gains are per volume of bone that the burr is immersed in, not per sample: a
/// finer sampling feels and drills the same.
struct BurrParameters {
  BurrKind kind{BurrKind::kDiamond};
  BurrForm form{BurrForm::kBall};
  double diameter{4e-3};             // the greatest, from 0.0005 to 0.03 [m]
  double length{0.0};                // BurrDimensions' [m]
  double narrow_diameter{0.0};       // likewise [m]
  double sample_spacing{4e-3 / 28};  // edge of a cell with one sample > 0; at most 1e6 samples [m]
  bool follows_bone{true};           // samples come closer in finer bone: for_bone()
  double removal_rate{10.0};         // R_max, share of the immersed volume >= 0 [1/(N·s)]
  double falloff{2.0};               // of the rate with latitude >= 0 [1/(N·s·rad)]
  double tangential_gain{1e11};      // per immersed volume and distance from the axis >= 0 [N/m^4]
  bool clockwise{true};              // turns so, seen from the handle: the teeth cut forward
  double wear_volume{0.0};           // of bone, after which it removes half as much; 0: never [m^3]

  BurrDimensions dimensions() const noexcept { return {form, diameter, length, narrow_diameter}; }
};

/// Share of its first removal rate that a burr still has, 1 down to 0, after a volume V of bone: W
/// / (W + V), with its wear volume W. Divisions and sums only, so that every machine has the same
/// bits. Servo thread. @param removed  >= 0 [m^3]
double sharpness(const BurrParameters& burr, double removed) noexcept;

/// Default parameters of a ball of this kind and size: samples 0.25 mm apart, or 28 over the
/// diameter if that is less; a cutting burr has a higher rate, a higher falloff and a stronger pull
/// along the bone. Source: Morris 2006, §3.2.3.6.
BurrParameters default_burr(BurrKind kind, double diameter);
/// The same of another shape, which has at most as many samples as a ball.
/// @throws std::invalid_argument as BurrShape does.
BurrParameters default_burr(BurrKind kind, const BurrDimensions& dimensions);

/// The same burr with samples for bone of this spacing, unless they are told: at most half a voxel
/// apart, 0.46 of one in bone finer than 0.5 mm, which puts a sample into every voxel that lies in
/// the burr, or as close as 400,000 samples allow. @param voxel  its edge [m]
BurrParameters for_bone(const BurrParameters& burr, double voxel);

/// The keys of a burr; `length` only where its shape is no ball.
const Schema<BurrParameters>& burr_schema();

/// A burr as a cloud of samples that fills it: its shape is cut into cubic cells, and each cell has
/// one sample at an uneven place, so that samples do not enter a flat bone by whole layers.
/// Cells of at most half a voxel's edge put a sample into every voxel that lies in the burr; with
/// wider ones a burr misses some until it moves across.
///
/// A sample pushes against the outward normal of the nearest point of the burr's surface, of a ball
/// towards the centre, and its latitude is that normal's. Layers of equal depth are closed
/// surfaces, so that the directions of a whole burr add up to zero, whatever its shape. With every
/// sample of a shape that is point-symmetric its mirror image through the centre is one too, of any
/// other its image in a half turn about the axis; what rounding leaves along the axis is spread
/// over all directions.
///
/// All in the tool frame T (core/base/tool_state.h), all precomputed. Immutable: any thread.
/// Source: Morris 2006, §3.2.3.4 to §3.2.3.7, for balls.
class Burr {
 public:
  static constexpr std::int32_t kRadius = 32767;  // the reach, in units of Arrays' positions
  static constexpr std::int32_t kUnit = 16384;    // length of Arrays' directions

  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  explicit Burr(const BurrParameters& parameters);

  const BurrParameters& parameters() const noexcept { return parameters_; }
  const BurrShape& shape() const noexcept { return shape_; }
  double radius() const noexcept { return 0.5 * parameters_.diameter; }  // [m]
  double reach() const noexcept { return shape_.reach(); }  // of its points from the centre [m]
  std::int32_t samples() const noexcept { return static_cast<std::int32_t>(power_.size()); }
  double sample_volume() const noexcept { return sample_volume_; }  // the burr's share [m^3]

  Eigen::Vector3d position(std::int32_t sample) const;   // p_T [m]
  Eigen::Vector3d direction(std::int32_t sample) const;  // inwards, unit length, in T
  /// Share of the immersed volume that is removed, max(0, R_max - falloff |latitude|) [1/(N·s)].
  float power(std::int32_t sample) const { return power_[static_cast<std::size_t>(sample)]; }
  /// Sets R_max and falloff, both finite and >= 0, from now on. Servo thread: no allocation.
  void set_rates(double removal_rate, double falloff) noexcept;

  /// A cube of the burr with the samples in it, which lie one after the other.
  struct Cell {
    std::array<std::int32_t, 3> centre;  // kRadius is the reach
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

  /// The samples as arrays for kernels: samples() numbers each.
  struct Arrays {
    const std::int16_t* x;  // positions, kRadius is the reach
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
  void balance() noexcept;

  BurrParameters parameters_;
  BurrShape shape_;
  double sample_volume_{0.0};
  std::vector<std::int16_t> position_[3];
  std::vector<std::int16_t> direction_[3];
  std::vector<double> latitude_;  // by sample, >= 0 [rad]
  std::vector<float> power_;
  std::vector<Cell> cells_;
};

}  // namespace haptrial::bone
