#include "core/deformable/touch/two_rate_touch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/deformable/touch/ball_touch.h"

namespace haptrial::deformable {

using contact::ContactState;
using Eigen::Vector3d;

namespace {

constexpr double kMostAge = 3.0;  // windows that a surface is foretold by

TouchOptions felt_as_ball(const MovingBody& body, TouchOptions options) {
  check(options);
  options.radius = std::max(options.radius, smallest_ball(*body.mesh));
  return options;
}

}  // namespace

int ticks_of_window(const HapticMesh& body, double loop_rate, double body_rate) {
  if (!body.grasped.empty()) {
    throw InputError(fmt::format(
        "{}: a body that the hand grasps has no rate of its own; keep `grasped` or `rate`",
        body.name));
  }
  const double ticks = std::round(loop_rate / body_rate);
  if (!(ticks >= 1.0 && ticks <= kMostWindow &&
        std::abs(ticks * body_rate - loop_rate) < 1e-6 * loop_rate)) {
    throw InputError(
        fmt::format("{}: rate is {:g} Hz; allowed: the {:g} Hz of the loop divided by a whole "
                    "number from 1 to {}",
                    body.name, body_rate, loop_rate, kMostWindow));
  }
  return static_cast<int>(ticks);
}

TwoRateTouch::TwoRateTouch(const SharedMovingBody& body, SharedWindowCompliance compliance,
                           const TouchOptions& options, double period, TwoRates rates,
                           std::shared_ptr<MovingShape> shape)
    : options_(felt_as_ball(*body, options)),
      period_(period),
      rates_(std::move(rates)),
      steps_(steps_on_a_tick(*body, period)),
      body_(body, std::move(compliance), options, period, rates_.window, rates_.threaded,
            std::move(shape)),
      local_(options_),
      forces_(3 * LocalSurface::kMost) {
  late_.reserve(kMostLate);
}

void TwoRateTouch::start(const Vector3d& tool) noexcept {
  surface_ = nullptr;
  local_.forget();
  account_.open();
  ++path_.generation;
  path_.starts = true;
  path_.from = tool_ = tool;
  path_.count = 0;
  waited_ = 0;
  force_count_ = 0;
  contact_ = {};
  contact_.proxy = tool;
}

const contact::Contact& TwoRateTouch::tick(const Vector3d& tool, double) noexcept {
  const bool finite = tool.allFinite();
  const Vector3d before = contact_.force;
  const double way = finite ? (tool - tool_).norm() : 0.0;
  if (finite) {
    account_.book(before, tool - tool_, period_);
    tool_ = tool;
  }
  hand_over(tool_);
  contact_ = {};
  contact_.proxy = tool_;
  force_count_ = 0;
  const double age =
      std::min(static_cast<double>(tick_ - known_at_), kMostAge * rates_.window) * period_;
  const bool touches = finite && surface_ != nullptr && local_.tick(*surface_, tool, age);
  if (touches) {
    note();
  }
  if (finite) {
    bound_change(before, options_.stiffness * way, kFastestOfMoving * period_, contact_);
  }
  if (contact_.state != ContactState::kFree) {
    limit();
  } else if (finite) {
    account_.open();
  }
  ++tick_;
  return contact_;
}

/// The path grows until it is as long as a window; then the body gets it for what it did with the
/// one before. If it has not done that yet, the way until it has is gone in one window.
void TwoRateTouch::hand_over(const Vector3d& tool) noexcept {
  if (path_.count < rates_.window) {
    path_.tools[static_cast<std::size_t>(path_.count++)] = tool;
  }
  if (path_.count < rates_.window) {
    return;
  }
  if (given_ && !take()) {
    wait();
    return;
  }
  if (std::exchange(waited_, 0) > 0) {
    for (int i = 0; i < rates_.window; ++i) {
      const double share = (i + 1.0) / rates_.window;
      path_.tools[static_cast<std::size_t>(i)] = path_.from + share * (tool - path_.from);
    }
  }
  body_.give(path_);
  given_ = true;
  given_at_ = tick_;
  path_.starts = false;
  path_.from = tool;
  path_.count = 0;
}

/// The window is late by a tick more, whatever ends that: it is known at every moment.
void TwoRateTouch::wait() noexcept {
  ++counts_.late;
  ++waited_;
  if (waited_ > 1 && !late_.empty() && late_.back().tick == tick_) {
    late_.back() = {tick_ + 1, waited_};
  } else if (waited_ == 1 && late_.size() < kMostLate) {
    late_.push_back({tick_ + 1, 1});
  }
}

/// @returns whether the body has gone along the path that it was given
bool TwoRateTouch::take() noexcept {
  const LocalSurface* surface = is_to_be_late() ? nullptr : body_.take();
  if (surface == nullptr) {
    return false;
  }
  counts_.inverted = surface->inverted;
  counts_.flown_apart = surface->flown_apart;
  surface_ = nullptr;
  if (surface->generation == path_.generation) {
    surface_ = surface;
    known_at_ = given_at_;
    local_.look_at(*surface);
  }
  return true;
}

bool TwoRateTouch::is_to_be_late() noexcept {
  const std::vector<LateWindow>& late = rates_.late;
  while (next_late_ < late.size() && late[next_late_].tick <= tick_) {
    ++next_late_;
  }
  return next_late_ < late.size() && tick_ + late[next_late_].ticks >= late[next_late_].tick;
}

void TwoRateTouch::note() noexcept {
  contact_.proxy = local_.centre();
  contact_.normal = -local_.normal();
  contact_.depth = local_.depth();
  contact_.force = -local_.force();
  contact_.settled = local_.solved();
  contact_.state = local_.slips() ? ContactState::kSlip : ContactState::kStick;
  force_count_ = local_.forces(*surface_, forces_);
  ++counts_.contact;
  counts_.crowded += surface_->crowded ? 1 : 0;
  counts_.unsettled += local_.solved() ? 0 : 1;
}

void TwoRateTouch::limit() noexcept {
  const double size = contact_.force.norm();
  if (surface_ != nullptr && size > surface_->most_force) {
    contact_.force *= surface_->most_force / size;
  }
  const double share = account_.share(contact_.force.norm());
  counts_.limited += share < 1.0 ? 1 : 0;
  contact_.force *= share;
}

}  // namespace haptrial::deformable
