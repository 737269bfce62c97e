#include "core/scene/fade.h"

#include <algorithm>
#include <cmath>

namespace haptrial::scene {

void Fade::turn(bool on, double duration) noexcept {
  begin_slope_ = slope();
  begin_ = weight_;
  target_ = on ? 1.0 : 0.0;
  duration_ = duration;
  time_ = 0.0;
  const double room = begin_slope_ > 0.0 ? 1.0 - begin_ : begin_;
  room_ = begin_slope_ != 0.0 ? room / std::abs(begin_slope_) : 0.0;
  if (!(room_ > 0.0)) {
    begin_slope_ = 0.0;
  }
  if (over()) {
    weight_ = target_;
  }
}

double Fade::next(double dt) noexcept {
  time_ += dt;
  if (over()) {
    weight_ = target_;
    return weight_;
  }
  const double u = time_ / duration_;
  const double s = u * u * (3.0 - 2.0 * u);
  const double went_on =
      begin_slope_ == 0.0 ? begin_ : begin_ + begin_slope_ * room_ * time_ / (room_ + time_);
  weight_ = std::clamp(went_on + s * (target_ - went_on), 0.0, 1.0);
  return weight_;
}

double Fade::slope() const noexcept {
  if (over()) {
    return 0.0;
  }
  const double u = time_ / duration_;
  const double s = u * u * (3.0 - 2.0 * u);
  const double s_slope = 6.0 * u * (1.0 - u) / duration_;
  double went_on = begin_;
  double went_on_slope = 0.0;
  if (begin_slope_ != 0.0) {
    const double share = room_ / (room_ + time_);
    went_on += begin_slope_ * share * time_;
    went_on_slope = begin_slope_ * share * share;
  }
  return (1.0 - s) * went_on_slope + s_slope * (target_ - went_on);
}

}  // namespace haptrial::scene
