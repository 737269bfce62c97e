#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "core/contact/proxy.h"

namespace haptrial::contact {

/// How contact is rendered: the place of a kind among kinds_of_renderer(), of which these are the
/// shipped ones.
enum class RendererKind : std::uint8_t {
  kProxy,          // "proxy": god object or sphere that never passes a surface
  kRuspini,        // "ruspini": sphere proxy as published by Ruspini et al. 1997
  kPenalty,        // "penalty": spring to the nearest triangle
  kVoxel,          // "voxel": spring to the triangle stored for the tool's voxel
  kDistanceField,  // "distance field": spring along the gradient of a sampled distance
};
inline constexpr std::array kRendererKinds{RendererKind::kProxy, RendererKind::kRuspini,
                                           RendererKind::kPenalty, RendererKind::kVoxel,
                                           RendererKind::kDistanceField};

struct RendererOptions {
  double stiffness{500.0};    // k > 0 [N/m]
  double damping{0.0};        // b >= 0, along the normal; never pulls [N·s/m]
  double radius{0.0};         // of the tool >= 0; 0: a point [m]
  Friction friction{};        // of proxies; the others have none
  double crease_angle{-1.0};  // force shading over edges less sharp than this; negative: none [rad]
  int resolution{64};         // of voxel and distance field: cells along the longest side, 4 to 512
  double unit{1.0};           // of the body's lengths, that tells how deep 1 mm is > 0 [m]
};

/// Force and contact of a renderer on a tick, in the object's frame.
struct Contact {
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};   // on the tool [N]
  Eigen::Vector3d proxy{Eigen::Vector3d::Zero()};   // where the tool would be; it, if free [m]
  Eigen::Vector3d normal{Eigen::Vector3d::Zero()};  // out of the surface; zero if free
  double depth{0.0};                                // of the tool behind the surface, along it [m]
  ContactState state{ContactState::kFree};
  bool settled{true};  // false: the proxy is still on its way
};

/// Pose of an object: from its frame O, that of its mesh, to the world W.
struct ObjectPose {
  Eigen::Quaterniond orientation{Eigen::Quaterniond::Identity()};  // of O in W, of unit length
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};               // p_WO [m]
};

/// Renders contact with one rigid object, prepared once from its mesh. All positions and forces are
/// in the object's frame.
class Renderer {
 public:
  virtual ~Renderer() = default;

  // Servo thread: no allocation, lock, I/O or throw.

  /// Puts the tool to a point without contact.
  virtual void start(const Eigen::Vector3d& tool) noexcept = 0;
  /// One tick. @param tool  [m]; not finite: zero force
  /// @param period  since the tick before > 0 [s]
  virtual const Contact& tick(const Eigen::Vector3d& tool, double period) noexcept = 0;
  /// The share of its damping that the renderer uses from now on, 0 to 1, since a light hand does
  /// not carry all of it. A renderer without a damper has nothing to do.
  virtual void set_damping_share(double share) noexcept { static_cast<void>(share); }
  /// Operations of the ticks since the last start(); those of a tool that is not finite take
  /// nothing.
  virtual const Operations& operations() const noexcept = 0;
};

}  // namespace haptrial::contact
