#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/deformable/touch/energy_account.h"
#include "core/deformable/touch/local_contact.h"
#include "core/deformable/touch/slow_body.h"

namespace haptrial::deformable {

/// The ticks of a loop that a body of its own rate takes together.
/// @throws InputError naming the body, for rates whose ratio is no whole number up to kMostWindow,
/// and for a body that the hand grasps
int ticks_of_window(const HapticMesh& body, double loop_rate, double body_rate);

/// A window that the body did not end in time: the one before was felt for longer.
struct LateWindow {
  std::uint64_t tick{};   // on which it was taken, from 0
  std::uint64_t ticks{};  // too late

  bool operator==(const LateWindow&) const = default;
};

/// How a body of its own rate is advanced.
struct TwoRates {
  int window{4};                   // [ticks], 1 to kMostWindow
  bool threaded{false};            // on a thread of its own, beside a loop on the real clock
  std::vector<LateWindow> late{};  // without a thread: that are to be late, as they once were
};

/// A body that moves at a slower rate than it is felt. Every few ticks, a window, the
/// servo thread hands over where the tool was, and gets how the surface was at the end of the
/// window before. In between it feels the surface near the ball through a local compliance
/// (local_contact.h), kept passive by an energy account. The body moves as that of a MovingTouch on
/// the same path; what is felt is foretold by one to two windows.
///
/// Forces depend on the tool's places alone, on a thread of its own, too, as long as no window is
/// late. late() has those that were; TwoRates::late repeats them. Source: Morris 2006, §5.4.1;
/// docs/algorithms/deformable-moving.md.
class TwoRateTouch final : public BodyTouch {
 public:
  static constexpr std::size_t kMostLate = 4096;  // that are kept

  /// @param body  that nobody grasps  @param compliance  prepared_compliance() of body and window
  /// @param period  of a tick [s]  @throws as MovingTouch
  TwoRateTouch(const SharedMovingBody& body, SharedWindowCompliance compliance,
               const TouchOptions& options, double period, TwoRates rates,
               std::shared_ptr<MovingShape> shape = nullptr);

  void start(const Eigen::Vector3d& tool) noexcept override;
  const contact::Contact& tick(const Eigen::Vector3d& tool, double period) noexcept override;
  std::span<const VertexForce> forces() const noexcept override {
    return std::span(forces_).first(force_count_);
  }
  const TouchCounts& counts() const noexcept override { return counts_; }

  int steps() const noexcept { return steps_; }  // of the body for each tick
  int window() const noexcept { return rates_.window; }
  /// The first kMostLate windows that were late. After the ticks, on any thread.
  std::span<const LateWindow> late() const noexcept { return late_; }

 private:
  void hand_over(const Eigen::Vector3d& tool) noexcept;
  bool take() noexcept;
  void wait() noexcept;
  bool is_to_be_late() noexcept;
  void note() noexcept;
  void limit() noexcept;

  TouchOptions options_;
  double period_;
  TwoRates rates_;
  int steps_;
  SlowBody body_;
  LocalContact local_;
  EnergyAccount account_;
  const LocalSurface* surface_{nullptr};  // null: not known yet
  std::uint64_t known_at_{0};             // the tick that it tells of
  BodyPath path_;
  std::uint64_t given_at_{0};  // the last tick of the path that the body has
  bool given_{false};          // and it has not been taken
  std::uint64_t waited_{0};    // for it [ticks]
  std::uint64_t tick_{0};
  std::vector<LateWindow> late_;
  std::size_t next_late_{0};                       // of those that are to be late
  Eigen::Vector3d tool_{Eigen::Vector3d::Zero()};  // a tick ago [m]
  std::vector<VertexForce> forces_;
  std::size_t force_count_{0};
  contact::Contact contact_;
  TouchCounts counts_;
};

}  // namespace haptrial::deformable
