#include "analysis/contact/evaluation/render_contact.h"

#include <malloc.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <numbers>

#include "core/contact/renderer_kinds.h"

namespace haptrial::evaluation {
namespace {

using Eigen::Vector3d;
using Clock = std::chrono::steady_clock;

constexpr double kLift = 1e-3;  // of the body's size: where a tool waits before the first contact
constexpr double kMostFriction = 1.5;
constexpr int kTried = 16;
constexpr double kFrictionStep = 1e-4;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Memory that the program holds on the heap [bytes].
double heap_in_use() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

/// Raises `most` to what the last tick took.
void add_most(const contact::Operations& now, const contact::Operations& before,
              contact::Operations& most) {
  most.ticks = 1;
  for (const contact::OperationCount& c : contact::kOperationCounts) {
    most.*c.count = std::max(most.*c.count, now.*c.count - before.*c.count);
  }
}

double error_with(const PreparedContact& contact, const contact::FeltBody& body,
                  contact::RendererKind kind, contact::RendererOptions options, double friction) {
  options.friction = {friction, friction};
  return force_error(contact.force, render_contact(contact, body, kind, options).force)
      .root_mean_square;
}

}  // namespace

RenderedContact render_contact(const PreparedContact& contact, const contact::FeltBody& body,
                               contact::RendererKind kind,
                               const contact::RendererOptions& options) {
  contact::RendererOptions used = options;
  used.stiffness = contact.stiffness;
  RenderedContact result;
  const double before = heap_in_use();
  const Clock::time_point start = Clock::now();
  const auto renderer = contact::make_renderer(kind, body.mesh, body.surface, used);
  result.preparation = seconds_since(start);
  result.memory = std::max(0.0, heap_in_use() - before);

  const std::size_t n = contact.in.size();
  result.force.reserve(n);
  result.place.reserve(n);
  result.tick_seconds.reserve(n);
  const double period = 1.0 / contact.rate;
  const double lift = kLift * body.size;
  contact::Operations before_tick;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d tool = contact.in[i] + used.radius * contact.normal[i];
    if (i == 0) {
      renderer->start(contact.out[0] + (used.radius + lift) * contact.normal[0]);
    }
    const Clock::time_point tick = Clock::now();
    const contact::Contact& felt = renderer->tick(tool, period);
    result.tick_seconds.push_back(seconds_since(tick));
    add_most(renderer->operations(), before_tick, result.most);
    before_tick = renderer->operations();
    const bool free = felt.state == contact::ContactState::kFree;
    result.force.push_back(felt.force);
    result.place.push_back(free ? contact.in[i] : Vector3d(felt.proxy - used.radius * felt.normal));
    result.lost += free && contact.touching[i] ? 1 : 0;
    result.unsettled += felt.settled ? 0 : 1;
  }
  result.operations = before_tick;
  return result;
}

FrictionFit fit_friction(const PreparedContact& contact, const contact::FeltBody& body,
                         contact::RendererKind kind, contact::RendererOptions options) {
  const auto error = [&](double friction) {
    return error_with(contact, body, kind, options, friction);
  };
  std::array<double, kTried> tried{};
  const double step = kMostFriction / (kTried - 1);
  for (int i = 0; i < kTried; ++i) {
    tried[static_cast<std::size_t>(i)] = error(i * step);
  }
  const auto best = std::min_element(tried.begin(), tried.end()) - tried.begin();
  double low = step * static_cast<double>(std::max<std::ptrdiff_t>(best - 1, 0));
  double high = step * static_cast<double>(std::min<std::ptrdiff_t>(best + 1, kTried - 1));
  FrictionFit fit{step * static_cast<double>(best), tried[0], *(tried.begin() + best)};
  const double golden = 1.0 / std::numbers::phi;
  double a = high - golden * (high - low), b = low + golden * (high - low);
  double at_a = error(a), at_b = error(b);
  while (high - low > kFrictionStep) {
    const bool left = at_a < at_b;
    (left ? high : low) = left ? b : a;
    const double next = left ? high - golden * (high - low) : low + golden * (high - low);
    (left ? b : a) = left ? a : b;
    (left ? at_b : at_a) = left ? at_a : at_b;
    (left ? a : b) = next;
    (left ? at_a : at_b) = error(next);
    const double least = std::min(at_a, at_b);
    if (least < fit.with) {
      fit = {at_a < at_b ? a : b, tried[0], least};
    }
  }
  return fit;
}

}  // namespace haptrial::evaluation
