#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/contact/coupled_tool.h"
#include "core/contact/signed_distance.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::contact {

/// Points on a mesh's faces, edges and corners, each once, so close that none is further than
/// `spacing` from the next one on its face. @param spacing  > 0, of the mesh's lengths
std::vector<Eigen::Vector3d> points_on(const geometry::Mesh& mesh, double spacing);

/// A rigid tool of any shape against a body, with force and torque on the hand. The tool is points
/// on its surface, the body a distance from its own: what of the body is sharper than the points
/// are close passes between them. A point is looked up only where the way since it was looked up
/// last may have brought it near, so that points far from the body cost nothing. In a groove a
/// distance tells one side alone: the side that was told before holds the point, too, else it would
/// be thrown from side to side.
///
/// All poses, forces and torques are in the body's frame. Source: Morris 2006, §7.4.1, for points;
/// McNeely, Puterbaugh and Troy 1999, for tools.
class RigidTool {
 public:
  /// @param points  of the tool's surface, in T [m]
  RigidTool(const std::vector<Eigen::Vector3d>& points, const Coupling& coupling);

  // Servo thread: no allocation, lock, I/O or throw.

  /// Puts the tool into the hand. @param hand  X_WT
  void begin(const Eigen::Isometry3d& hand) noexcept;
  /// One tick. @param body  always the same between two begin()s
  /// @param hand  X_WT; not finite: nothing is felt  @param dt  since the tick before > 0 [s]
  CoupledTool::Felt tick(const BodyDistance& body, const Eigen::Isometry3d& hand,
                         double dt) noexcept;

  /// X_WT of the tool, which stays out of the body, after the last tick.
  const Eigen::Isometry3d& pose() const noexcept { return tool_.pose(); }
  std::size_t points() const noexcept { return points_.size(); }

 private:
  struct Point {
    Eigen::Vector3d at_T;
    Eigen::Vector3d asked;  // where it was looked up last, in W
    double distance;        // that it had then; below 0: it touched or was never looked up
    std::int32_t near;      // a triangle, as a hint
    SurfacePoint last{};    // of the surface, where it was near
    SurfacePoint other{};   // likewise, before that, on another side; its normal is zero: none
  };
  void find_near(const BodyDistance& body) noexcept;
  void remember(Point& point, const SurfacePoint& surface) const noexcept;

  std::vector<Point> points_;
  std::vector<TouchingPoint> near_;
  CoupledTool tool_;
};

}  // namespace haptrial::contact
