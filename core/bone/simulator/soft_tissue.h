#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/bone/model/bone_model.h"
#include "core/bone/model/dent.h"

namespace haptrial::bone {

/// A structure that is soft instead of bone.
struct SoftTissueParameters {
  std::string structure;    // as the bone calls it
  double stiffness{400.0};  // k of its surface under a burr or tube > 0 [N/m]
  double tears_at{1.5};     // > 0 [N]
  double suction{0.15};     // pull at which it comes off a sucking tube >= 0 [N]
};

/// The keys of a structure in [soft_tissue].
const Schema<SoftTissueParameters>& soft_tissue_schema();

/// Reads [soft_tissue]: a table for each structure.
std::vector<SoftTissueParameters> read_soft_tissue(Table& table);

/// @throws InputError for a structure that the bone does not have, or that is named twice
void check_soft_tissue(const BoneModel& model, std::span<const SoftTissueParameters> parameters);

/// A place where a structure was torn.
struct Tear {
  std::uint8_t label{0};
  bool by_suction{false};
  bool by_second{false};                             // by the tube in the other hand
  double force{0.0};                                 // at which it tore [N]
  double depth{0.0};                                 // how far its surface had given way [m]
  Eigen::Vector3d place_B{Eigen::Vector3d::Zero()};  // on the surface at rest [m]
};

/// Signed distance from a labelled structure's surface, positive outside, smoothed over a voxel and
/// interpolated by quadratic B-splines, so that its gradient, and a force along it, has no steps
/// between voxels nor midway between two sides of the structure. B is the bone's frame.
class SurfaceDepth {
 public:
  /// @param reach  how far outside it is known [m]
  SurfaceDepth(const BoneModel& model, std::uint8_t label, double reach);

  struct LocalTissue {
    double distance;           // [m]
    Eigen::Vector3d gradient;  // of it
  };
  double spacing() const noexcept { return spacing_; }  // of voxels [m]
  /// @returns false where it is farther than known, or not finite
  bool at(const Eigen::Vector3d& p_B, LocalTissue& here) const noexcept;

 private:
  Eigen::Vector3d low_{Eigen::Vector3d::Zero()};  // centre of the first voxel [m]
  double spacing_{1.0};
  std::array<std::int32_t, 3> size_{};
  std::vector<float> distance_;  // x fastest [m]
};

/// The soft structures of a bone under a tool whose end is a ball of radius r, centre c:
///
///     f = k d ∇φ(c),   d = r - φ(c) > 0
///
/// with the signed distance φ from the structure's surface at rest: locally a spring, whose energy
/// is k d² / 2, so that nothing is gained on a closed path. A tube that sucks holds the surface,
/// which then pulls as well (d < 0), until k |d| is `suction`: there it comes off.
///
/// At `tears_at`, or where the ball is through (the structure gives no way out any more), it tears:
/// a hole as wide as the ball, in which nothing is felt until the ball is out of the structure.
/// What is given up: tissue has neither inertia nor viscosity, and nothing slides on it.
///
/// Servo thread: no allocation, lock or throw after construction
/// (SoftTissueTest.ATickDoesNotAllocate).
class SoftTissue {
 public:
  static constexpr std::size_t kMostHoles = 256;

  /// @param largest_radius  of a tool > 0 [m]
  /// @throws InputError as check_soft_tissue()
  SoftTissue(const BoneModel& model, std::span<const SoftTissueParameters> parameters,
             double largest_radius);

  bool empty() const noexcept { return parts_.empty(); }
  bool is_soft(std::uint8_t label) const noexcept { return soft_[label]; }
  /// Whether each label is soft.
  const std::array<bool, 256>& soft() const noexcept { return soft_; }

  /// How a tool stands to each structure.
  class Touch;
  /// The touch of a tool that has no place yet. Allocates.
  Touch touch() const;

  /// A tool is taken in hand: structures that it is in are not felt before it has left them.
  void forget() noexcept { forget(own_); }
  void forget_second() noexcept { forget(second_); }
  static void forget(Touch& touch) noexcept;
  /// Forgets the tears of the last tick.
  void begin_tick() noexcept { tear_count_ = 0; }
  /// @param sucks  the tool is a tube that sucks
  /// @returns the force on the tool, in B [N]; on the tick of a tear that at which it tore
  Eigen::Vector3d tick(const Eigen::Vector3d& c_B, double radius, bool sucks) noexcept;
  /// The same, after tick(), for the tube in the other hand, which tears as well.
  Eigen::Vector3d tick_second(const Eigen::Vector3d& c_B, double radius, bool sucks) noexcept;
  /// Force on a tool that tears nothing [N]: beyond the force of a tear it slips through, and feels
  /// nothing until it is out of the structure.
  Eigen::Vector3d feel(Touch& touch, const Eigen::Vector3d& c_B, double radius,
                       bool sucks) const noexcept;
  /// Tears of the last tick.
  std::span<const Tear> tears() const noexcept { return {tears_.data(), tear_count_}; }
  /// Distance to the nearest soft surface, negative within; infinite if none is near [m].
  double distance(const Eigen::Vector3d& p_B) const noexcept;
  /// Whether the ball is in a hole of a structure.
  bool in_hole() const noexcept;
  /// The deepest one that the tool, or the tube in the other hand, makes now.
  Dent dent() const noexcept { return deepest(own_); }
  Dent dent_of_second() const noexcept { return deepest(second_); }

 private:
  enum class State : std::uint8_t { kFree, kPressed, kHeld, kInHole, kUnfelt };
  struct Part {
    SoftTissueParameters parameters;
    std::uint8_t label;
    SurfaceDepth depth;
  };
  struct TouchedPart {
    State state{State::kUnfelt};
    Eigen::Vector3d way_out{Eigen::Vector3d::Zero()};  // on the last tick of contact
    Dent dent{};                                       // now
  };
  struct Hole {
    Eigen::Vector3d place;
    double radius;
    std::uint8_t label;
  };
  struct PressResult {
    Eigen::Vector3d force{Eigen::Vector3d::Zero()};
    bool tears{false};
    Tear tear{};
  };
  PressResult press(const Part& part, TouchedPart& touched, const Eigen::Vector3d& c_B,
                    double radius, bool sucks) const noexcept;
  bool holed(std::uint8_t label, const Eigen::Vector3d& place) const noexcept;
  Eigen::Vector3d press_all(Touch& touch, const Eigen::Vector3d& c_B, double radius, bool sucks,
                            bool second) noexcept;
  void tear(const Tear& tear, double radius) noexcept;
  static Dent deepest(const Touch& touch) noexcept;

 public:
  class Touch {
    friend class SoftTissue;
    std::vector<TouchedPart> parts_;  // (structures)
  };

 private:
  std::vector<Part> parts_;
  Touch own_;
  Touch second_;  // of the tube in the other hand
  std::array<bool, 256> soft_{};
  std::vector<Hole> holes_;  // room for kMostHoles; beyond these a tear is told and closes again
  std::vector<Tear> tears_;  // (2 structures)
  std::size_t tear_count_{0};
};

}  // namespace haptrial::bone
