#include "analysis/psychometric/fit/likelihood_climb.h"

namespace haptrial::analysis::climbing {
namespace {

constexpr double kTiny = 1e-150;  // of a share that is divided by

/// How the likelihood of each block changes with its p.
struct Pull {
  Lanes slope, curvature;
  Lanes impossible;  // answers that have the probability 0
};

Pull pull_of(const Blocks& blocks, const Spot& spot, const SigmoidLanes& s) noexcept {
  const double between = 1.0 - spot.guess - spot.lapse;
  Pull pull;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double p = spot.guess + between * s.share[i], q = spot.lapse + between * s.beyond[i];
    pull.impossible[i] = (p > 0.0 ? 0.0 : blocks.right[i]) + (q > 0.0 ? 0.0 : blocks.wrong[i]);
    const double by_p = 1.0 / (p > kTiny ? p : kTiny), by_q = 1.0 / (q > kTiny ? q : kTiny);
    const double good = blocks.right[i] * by_p, bad = blocks.wrong[i] * by_q;
    const double expected = (blocks.right[i] + blocks.wrong[i]) * by_p * by_q;
    pull.slope[i] = good - bad;
    pull.curvature[i] = spot.fisher ? expected : good * by_p + bad * by_q;
  }
  return pull;
}

}  // namespace

/// @tparam Guess  whether the guess rate is a parameter of its own
template <bool Guess>
void Sums::add(const SigmoidCurve& curve, const Blocks& blocks, const Spot& spot) noexcept {
  Lanes from, z;
  SigmoidLanes s;
  for (std::size_t i = 0; i < kLanes; ++i) {
    from[i] = spot.rise * (blocks.x[i] - spot.threshold);
    z[i] = curve.centre() + from[i];
  }
  curve.at(z, s);
  const Pull pull = pull_of(blocks, spot, s);
  const double between = 1.0 - spot.guess - spot.lapse;
  const double twice = spot.tied ? 2.0 : 1.0, second = spot.fisher ? 0.0 : 1.0;
  Lanes slope, bend, by_lapse, with_lapse, with_guess;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double f = between * s.density[i], curvature = pull.curvature[i] * between;
    slope[i] = pull.slope[i] * f;
    bend[i] = pull.curvature[i] * f * f - second * pull.slope[i] * between * s.bend[i];
    by_lapse[i] = spot.tied ? s.beyond[i] - s.share[i] : -s.share[i];
    with_lapse[i] = (curvature * by_lapse[i] + second * twice * pull.slope[i]) * s.density[i];
    with_guess[i] = (curvature * s.beyond[i] + second * pull.slope[i]) * s.density[i];
  }
  for (std::size_t i = 0; i < kLanes; ++i) {
    impossible += pull.impossible[i];
    density += slope[i], far += slope[i] * from[i];
    lapse += pull.slope[i] * by_lapse[i];
    bent += bend[i], bent_far += bend[i] * from[i], bent_far_far += bend[i] * from[i] * from[i];
    lapse_near += with_lapse[i], lapse_far += with_lapse[i] * from[i];
    lapse_lapse += pull.curvature[i] * by_lapse[i] * by_lapse[i];
  }
  for (std::size_t i = 0; Guess && i < kLanes; ++i) {
    guess += pull.slope[i] * s.beyond[i];
    guess_near += with_guess[i], guess_far += with_guess[i] * from[i];
    lapse_guess += pull.curvature[i] * by_lapse[i] * s.beyond[i];
    guess_guess += pull.curvature[i] * s.beyond[i] * s.beyond[i];
  }
}

template void Sums::add<true>(const SigmoidCurve&, const Blocks&, const Spot&) noexcept;
template void Sums::add<false>(const SigmoidCurve&, const Blocks&, const Spot&) noexcept;

/// dz = -rise d threshold - (z - q) d log width
void Sums::put(Climb& climb, double rise) const noexcept {
  const double near = climb.fisher ? 0.0 : density, distant = climb.fisher ? 0.0 : far;
  climb.possible = impossible == 0.0;
  climb.slope = {-rise * density, -far, lapse, guess};
  climb.hessian[0] = {rise * rise * bent};
  climb.hessian[1] = {rise * (bent_far - near), bent_far_far - distant};
  climb.hessian[2] = {-rise * lapse_near, -lapse_far, lapse_lapse};
  climb.hessian[3] = {-rise * guess_near, -guess_far, lapse_guess, guess_guess};
}

}  // namespace haptrial::analysis::climbing
