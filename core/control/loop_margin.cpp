#include "core/control/loop_margin.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace haptrial::control {
namespace {

constexpr int kLatest = 3;  // ticks

control::HandleLoop late(control::HandleLoop loop) {
  loop.force_delay = std::max(loop.force_delay, kLatest);
  return loop;
}

double stiffness_of_bare_handle(double damping, const control::HandleLoop& loop) {
  constexpr double kStable = 1.0 + 1e-9;
  constexpr double kResolution = 1.0;  // [N/m]
  double low = 0.0;
  double high = 1e5;
  while (high - low > kResolution) {
    const double middle = 0.5 * (low + high);
    (control::spectral_radius({middle, damping}, loop, {}) <= kStable ? low : high) = middle;
  }
  return low;
}

std::string hand(double mass) {
  return mass > kHeaviestHand ? fmt::format("more than {} kg", kHeaviestHand)
         : mass > 0.0         ? fmt::format("{:.2f} kg or more", mass)
                              : "any mass";
}

}  // namespace

std::string ticks_in_words(int ticks) {
  return ticks == 1 ? "a tick" : fmt::format("{} ticks", ticks);
}

BareHandle bare_handle(const control::PdGains& gains, const control::HandleLoop& loop) {
  // For a spring without a damper the guard's own takes its place.
  const double calming =
      control::damping_of_bare_handle(std::numeric_limits<double>::infinity(), loop);
  return {std::min(gains.damping, calming), stiffness_of_bare_handle(calming, loop)};
}

LoopMargin loop_margin(const std::string& name, const control::PdGains& gains,
                       const control::HandleLoop& loop) {
  const double bare = control::damping_of_bare_handle(gains.damping, loop);
  return {name,
          gains,
          control::lightest_stable_hand(gains, loop, kHeaviestHand),
          control::lightest_stable_hand(gains, late(loop), kHeaviestHand),
          bare,
          stiffness_of_bare_handle(bare, late(loop))};
}

std::string describe(const LoopMargin& m) {
  std::string text = fmt::format(
      "{}: {} N/m and {} N·s/m suit a hand of {} ({} if forces come three ticks late)", m.name,
      m.gains.stiffness, m.gains.damping, hand(m.lightest), hand(m.lightest_late));
  if (m.bare_damping < m.gains.damping) {
    text += fmt::format(
        "; for a lighter hand haptrial reduces the damping, to no less than {:.1f} N·s/m for the "
        "bare handle",
        m.bare_damping);
  }
  return text;
}

bool is_dangerous(const LoopMargin& m) { return m.gains.stiffness > m.bare_stiffness; }

}  // namespace haptrial::control
