#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "core/deformable/touch/local_surface.h"
#include "core/deformable/touch/moving_body.h"
#include "core/deformable/touch/moving_touch.h"
#include "core/realtime/hand_over.h"
#include "core/realtime/latest_value.h"

namespace haptrial::deformable {

/// How the surface of a body that moves gives way to forces within a time τ, an implicit step of
/// it, with the stiffness K and the masses M at rest:
///
///     u = (K + M / τ²)⁻¹ f
///
/// Stiffer than at rest by what inertia holds; a body that nothing holds has one, too.
class WindowCompliance {
 public:
  /// Takes up to some seconds. @param time  τ > 0 [s]
  WindowCompliance(const MovingBody& body, double time);

  /// Displacement of v per force on the vertex w [m/N]; zero if one of them is held or cannot be
  /// touched. Any thread.
  Eigen::Matrix3f block(std::int32_t v, std::int32_t w) const noexcept {
    const std::int32_t row = place_[static_cast<std::size_t>(v)];
    const std::int32_t column = place_[static_cast<std::size_t>(w)];
    return row < 0 || column < 0 ? Eigen::Matrix3f(Eigen::Matrix3f::Zero())
                                 : Eigen::Matrix3f(inverse_.block<3, 3>(3 * row, 3 * column));
  }

 private:
  std::vector<std::int32_t> place_;  // by vertex; -1: none
  Eigen::MatrixXf inverse_;          // (3 places x 3 places)
};
using SharedWindowCompliance = std::shared_ptr<const WindowCompliance>;

/// A compliance, made when it is first asked for and shared (touch/prepared.h). Any thread
/// but the servo thread. @param window  that the body is behind on the average [s]
/// @throws InputError if the machine has not the memory.
SharedWindowCompliance prepared_compliance(const SharedMovingBody& body, double window);

inline constexpr int kMostWindow = 50;  // [ticks]

/// Tool's path over the ticks of a window.
struct BodyPath {
  std::uint64_t generation{0};
  bool starts{false};                             // the body is put to rest first, the tool to from
  Eigen::Vector3d from{Eigen::Vector3d::Zero()};  // [m]
  int count{0};
  std::array<Eigen::Vector3d, kMostWindow> tools;
};

/// A moving body that is advanced a window of ticks at once: on a thread of its own, or at once on
/// the thread that asks, with the same bytes. It says how its surface is when the window ends.
class SlowBody {
 public:
  /// @param compliance  of `body`  @param period  of a tick [s]  @param window  [ticks]: one of
  /// elements is stepped once over all of them
  /// @throws as MovingTouch
  SlowBody(const SharedMovingBody& body, SharedWindowCompliance compliance,
           const TouchOptions& options, double period, int window, bool threaded,
           std::shared_ptr<MovingShape> shape);
  SlowBody(const SlowBody&) = delete;
  SlowBody& operator=(const SlowBody&) = delete;

  // Servo thread: no allocation, lock, wait or throw.

  /// Advances the body along a path; only after the last one was taken.
  void give(const BodyPath& path) noexcept;
  /// The surface at the end of the last path, valid until the next one is taken; null: not yet.
  const LocalSurface* take() noexcept;

 private:
  /// A vertex on which the ball presses.
  struct Load {
    std::int32_t vertex;
    Eigen::Vector3f force;  // along the normal, mean of the last tick [N]
  };

  void run(const std::stop_token& stop);
  void advance(const BodyPath& path) noexcept;
  void describe(const BodyPath& path, LocalSurface& to) noexcept;
  void find_near(const Eigen::Vector3d& centre, double reach) noexcept;
  void find_loads() noexcept;
  void describe_place(std::int32_t sample, double window, LocalSurface::Place& to) noexcept;
  void find_compliance(LocalSurface& to) const noexcept;

  SharedMovingBody body_;
  SharedWindowCompliance compliance_;
  double period_;
  int ticks_of_step_;  // of the loop, for one of the body
  MovingTouch touch_;
  std::uint64_t window_{0};  // number of the last one

  struct NearSample {
    double distance;
    std::int32_t sample;
    auto operator<=>(const NearSample&) const = default;
  };
  std::vector<NearSample> near_;  // (samples)
  std::size_t near_count_{0};
  std::vector<std::uint8_t> pressed_;     // by sample, on the last tick
  std::vector<Eigen::Vector3d> free_;     // by sample, when it was described last [m]
  std::vector<std::uint64_t> described_;  // by sample: in which window
  std::vector<Load> loads_;
  std::size_t load_count_{0};
  std::uint64_t inverted_{0}, flown_apart_{0};

  std::array<LocalSurface, realtime::HandOver::kSlots> slots_;
  realtime::HandOver turn_;
  realtime::LatestValue<BodyPath> paths_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace haptrial::deformable
