#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/deformable/touch/body_touch.h"
#include "core/deformable/touch/compliance.h"
#include "core/deformable/touch/normal_forces.h"
#include "core/deformable/touch/surface_samples.h"

namespace haptrial::deformable {

/// The radius below which a ball is felt as one of this radius: half a cell [m].
double smallest_ball(const HapticMesh& mesh);

using SharedCompliance = std::shared_ptr<const Compliance>;

/// A ball on the surface of an elastic body at rest (quasi-static, linear elements). No place p of
/// the surface (surface_samples.h) may be inside of the ball:
///
///     n · (p + u(f) - y) >= r,  f >= 0,   y = x - Σ f n / k
///
/// with the tool x, the ball's centre y, the compliance u(f) and n from the ball into the body. A
/// centre that is inside of the body presses on the nearest point of all faces.
/// Without friction the force is minus the gradient of the energy that tool and body share, which
/// turns by k at most; where its places are found anew, elsewhere or not at all, the change comes
/// by degrees (bound_change()). Friction is one bristle for all places, whose force they share as
/// their normal forces; its stiffness is the body's across the normal, and when it changes no
/// energy is added. How friction presses on the normal gaps is left out (Goodman 1962). Into a
/// continuum a point sinks without end (Boussinesq), into elements as their size allows: a point,
/// and any ball below smallest_ball(), is felt as a ball of that radius. Source: Morris 2006,
/// §7.4.2 (friction); docs/algorithms/deformable-touch.md.
class BallTouch final : public BodyTouch {
 public:
  /// @throws std::invalid_argument naming the option that breaks its bound.
  BallTouch(SharedCompliance body, const TouchOptions& options);

  void start(const Eigen::Vector3d& tool) noexcept override;
  /// Goes on from the contact of `before` if the tool is at the same place of the same mesh,
  /// whatever its tissue; else starts, as start() does.
  void adopt(const BodyTouch& before, const Eigen::Vector3d& tool) noexcept override;
  const contact::Contact& tick(const Eigen::Vector3d& tool, double period) noexcept override;
  std::span<const VertexForce> forces() const noexcept override {
    return std::span(forces_).first(force_count_);
  }
  const TouchCounts& counts() const noexcept override { return counts_; }

 private:
  static constexpr int kMostPlaces = PressedPlaces::kMost;
  static constexpr std::size_t kMostFaces = 384;
  static constexpr std::size_t kMostNear = 256;

  /// A point of the surface that the ball may press.
  struct Place {
    std::array<std::int32_t, 3> near{};  // of its face's corners, into near_
    Eigen::Vector3d weight{Eigen::Vector3d::Zero()};
    Eigen::Vector3d at{Eigen::Vector3d::Zero()};      // where it is now [m]
    Eigen::Vector3d normal{Eigen::Vector3d::Zero()};  // n
    double distance{0.0};                             // from the centre [m]
    std::int32_t sample{-1};                          // -1: none
  };

  void gather(const Eigen::Vector3d& tool, const Eigen::Vector3d& centre) noexcept;
  void note_near(std::int32_t place) noexcept;
  bool settle(const Eigen::Vector3d& tool) noexcept;
  void find_places(const Eigen::Vector3d& centre) noexcept;
  bool take_nearest(const Eigen::Vector3d& centre) noexcept;
  void take_samples(const Eigen::Vector3d& centre) noexcept;
  void add_place(const Place& place) noexcept;
  Eigen::Vector3d now(std::int32_t near) const noexcept;
  const Compliance::Block* column(std::int32_t near) noexcept;
  void respond() noexcept;
  bool press_places(const Eigen::Vector3d& tool) noexcept;
  void rub(const Eigen::Vector3d& tool) noexcept;
  double across(const Eigen::Vector3d& normal) noexcept;
  void keep_forces() noexcept;
  void note(const Eigen::Vector3d& tool) noexcept;
  void limit() noexcept;
  bool inverts() noexcept;
  void release(const Eigen::Vector3d& tool) noexcept;

  SharedCompliance body_;
  TouchOptions options_;
  std::vector<contact::NearTriangle> found_;
  std::shared_ptr<const SurfaceSamples> samples_;
  std::vector<std::int32_t> faces_;            // near the ball
  std::vector<std::int32_t> near_;             // their corners: places of the body
  std::vector<std::int32_t> number_;           // by place: into near_; -1: not near
  std::vector<Eigen::Vector3d> moved_;         // of each near: u by normal forces [m]
  std::vector<Eigen::Vector3d> moved_before_;  // likewise, a round ago [m]
  std::vector<Eigen::Vector3d> near_force_;    // of each near: along normals [N]
  std::vector<double> share_;                  // of each near, in the normal force
  /// (near x near): what a force on one does to every one. The body keeps them far apart in memory.
  std::vector<Compliance::Block> columns_;
  std::vector<std::uint64_t> column_at_;     // by near: on which tick it was fetched
  std::vector<Eigen::Vector3f> response_;    // (places x near): u by 1 N [m]
  std::vector<std::uint64_t> last_pressed_;  // by sample: on which tick
  std::vector<std::uint64_t> pressed_in_;    // by sample: in which round
  std::vector<std::uint64_t> looked_at_;     // likewise
  std::uint64_t round_{1};
  std::array<Place, kMostPlaces> places_;
  int count_{0};
  PressedPlaces problem_;
  PressedPlaces::Vector pressed_;  // f [N]
  Eigen::Vector3d normal_force_{Eigen::Vector3d::Zero()}, friction_{Eigen::Vector3d::Zero()};
  double bristle_{0.0};              // how it gives way [m/N]
  std::vector<VertexForce> loaded_;  // by normal forces: of places of the body
  std::vector<VertexForce> forces_;
  std::size_t loaded_count_{0}, force_count_{0};
  std::vector<Eigen::Vector3f> deep_;                  // by place: u by all forces [m]
  std::vector<std::uint64_t> deep_at_;                 // by place: on which tick it was found
  Eigen::Vector3d tool_{Eigen::Vector3d::Zero()};      // a tick ago [m]
  double way_{0.0};                                    // since then [m]
  Eigen::Vector3d clear_at_{Eigen::Vector3d::Zero()};  // a centre outside of the body on this tick
  double clear_{0.0};     // the distance of the nearest face from there; 0: not known [m]
  double stirred_{0.0};   // how far a near vertex may have come since then [m]
  double farthest_{0.0};  // of the displacements near the ball [m]
  double upright_{0.0};   // the force before a tetrahedron would be inside out [N]
  std::uint64_t tick_{1};
  bool crowded_{false};  // on this tick
  bool begins_{true};    // no tick before is one of this contact
  contact::Contact contact_;
  TouchCounts counts_;
};

}  // namespace haptrial::deformable
