#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/camera.h"

namespace haptrial::device {

/// A window's pointer, and the keys that are held, at one picture.
struct PointerInput {
  Eigen::Vector2d pixel{Eigen::Vector2d::Zero()};  // from the window's top left corner [px]
  double wheel{0.0};                               // steps since the window opened, up > 0
  std::uint32_t buttons{0};                        // bit 0 left, 1 right, 2 middle
  std::span<const int> keys;                       // codes of the window
  double dt{0.0};                                  // since the picture before [s]
  /// Turn by a stick about the picture's right, up and towards the eye; each -1 to 1, as a held
  /// key.
  Eigen::Vector3d turn{Eigen::Vector3d::Zero()};
};

/// A hand in space: where its tool's tip is, and how it is turned from how it was at first. In W.
struct HandPose {
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};  // [m]
  Eigen::Quaterniond orientation{Eigen::Quaterniond::Identity()};
};

struct PointerHandParameters {
  Eigen::Vector3d start{Eigen::Vector3d::Zero()};  // p_W; says how far from the eye it begins [m]
  double wheel_step{0.0006};                       // away from the eye, by a step up [m]
  double depth_speed{0.008};                       // of held keys [m/s]
  double turn_speed{0.8};                          // of held keys [rad/s]
  double turn_per_pixel{0.006};                    // of the pointer while turn_button is held
  int turn_button{1};                              // -1: none
  double leash{0.006};                             // ahead of the tip in depth, at most > 0 [m]
  double reach{0.0675};                            // from the world's origin, at most > 0 [m]
};

/// A hand with six degrees of freedom for somebody who has a mouse and a keyboard alone. The tip
/// lies under the pointer. Wheel up, or W, takes it away from the eye, into what is seen; wheel
/// down, or S, back. The arrows tilt the tool as the picture has it, Q and E roll it; so does the
/// pointer while `turn_button` is held. If the view changes, or the tool was turned, the tip stays
/// and comes back under the pointer while that moves. The screen's thread.
class PointerHand {
 public:
  explicit PointerHand(const PointerHandParameters& parameters) : p_(parameters) {}
  double leash() const noexcept { return p_.leash; }  // [m]

  /// @param camera         of the picture under the pointer
  /// @param width, height  of that picture [px]
  /// @param tip            where the tool is, which bone may hold back [m]
  /// @param view_held      the hand moves the view now: the tip does not drift
  HandPose follow(const Camera& camera, int width, int height, const PointerInput& input,
                  const Eigen::Vector3d& tip, bool view_held);

 private:
  struct Screen;
  void turn(const Screen& screen, const PointerInput& input, const Eigen::Vector2d& dragged);

  PointerHandParameters p_;
  std::optional<Camera> camera_;                     // of the picture before
  Eigen::Vector2d pixel_{Eigen::Vector2d::Zero()};   // likewise
  double wheel_{0.0};                                // likewise
  Eigen::Vector2d offset_{Eigen::Vector2d::Zero()};  // from the pointer to the tip [px]
  HandPose pose_;
};

}  // namespace haptrial::device
