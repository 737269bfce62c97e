#include "core/psychometric/function/sigmoid_curve.h"

#include <stdexcept>

namespace haptrial::psychometric {
namespace {

SigmoidPoint turned(const SigmoidPoint& p) noexcept {
  return {p.beyond, p.share, -p.density, -p.bend};
}

}  // namespace

SigmoidCurve::SigmoidCurve(Sigmoid sigmoid, double share, double tail, bool falling)
    : sigmoid_(sigmoid), falling_(falling) {
  if (!(share > 0.0 && share < 1.0)) {
    throw std::invalid_argument("share must be between 0 and 1");
  }
  if (!(tail > 0.0 && tail < 0.5)) {
    throw std::invalid_argument("tail must be between 0 and 0.5");
  }
  centre_ = z_for(share);
  spread_ = sigmoid_quantile(sigmoid, 1.0 - tail) - sigmoid_quantile(sigmoid, tail);
}

SigmoidPoint SigmoidCurve::at(double z) const noexcept {
  const SigmoidPoint rising = sigmoid_point(sigmoid_, z);
  return falling_ ? turned(rising) : rising;
}

void SigmoidCurve::at(const double* z, SigmoidLanes& lanes) const noexcept {
  sigmoid_lanes(sigmoid_, z, lanes);
  for (std::size_t i = 0; falling_ && i < SigmoidLanes::kCount; ++i) {
    const SigmoidPoint p =
        turned({lanes.share[i], lanes.beyond[i], lanes.density[i], lanes.bend[i]});
    lanes.share[i] = p.share;
    lanes.beyond[i] = p.beyond;
    lanes.density[i] = p.density;
    lanes.bend[i] = p.bend;
  }
}

double SigmoidCurve::z_for(double share) const {
  return sigmoid_quantile(sigmoid_, falling_ ? 1.0 - share : share);
}

}  // namespace haptrial::psychometric
