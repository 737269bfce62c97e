#include "core/subject/perceiver/contact_episodes.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptrial::subject {

void UpperMean::add(double value, double duration) noexcept {
  constexpr double kMost = 1000.0;
  value = std::clamp(value, 0.0, kMost);
  std::size_t bin = 0;
  if (value >= std::ldexp(1.0, kLowest)) {
    int exponent = 0;
    const double half = std::frexp(value, &exponent);  // value = half 2^exponent, half >= 1/2
    const int octave = exponent - 1 - kLowest;
    const int within = static_cast<int>((2.0 * half - 1.0) * kPerOctave);
    bin = 1 + static_cast<std::size_t>(octave * kPerOctave + within);
  }
  bins_[bin].time += duration;
  bins_[bin].sum += duration * value;
}

double UpperMean::mean() const noexcept {
  double whole = 0.0;
  for (const Bin& bin : bins_) {
    whole += bin.time;
  }
  double left = 0.5 * whole;
  double sum = 0.0;
  for (auto bin = bins_.rbegin(); bin != bins_.rend() && left > 0.0; ++bin) {
    if (bin->time > 0.0) {
      const double share = std::min(1.0, left / bin->time);
      sum += share * bin->sum;
      left -= share * bin->time;
    }
  }
  return whole > 0.0 ? sum / (0.5 * whole) : 0.0;
}

namespace {

constexpr double kSlowTime = 0.05;      // of the slow part of a force [s]
constexpr double kFreeAtLeast = 0.05;   // between two contacts [s]
constexpr double kPushFilter = 0.01;    // of force and acceleration for a mass [s]
constexpr double kLeastTremble = 0.01;  // of a fluctuation that has a frequency [N]
constexpr double kLeastWay = 1e-4;      // sd of a deflection that has a slope [m]
constexpr double kUnit = 0.01;          // of what a sphere is fitted to: sums near 1 [m]
constexpr double kLeastFixed = 1e-6;    // of squares in it: 10 µm

}  // namespace

void ContactEpisodes::Line::add(double px, double py, double w) noexcept {
  weight += w;
  x += w * px;
  y += w * py;
  xx += w * px * px;
  xy += w * px * py;
}

double ContactEpisodes::Line::slope(double least_variance) const noexcept {
  if (!(weight > 0.0)) {
    return 0.0;
  }
  const double variance = (xx - x * x / weight) / weight;
  if (variance > least_variance) {
    return (xy - x * y / weight) / weight / variance;
  }
  return xx > 0.0 ? xy / xx : 0.0;
}

void ContactEpisodes::Ball::add(const Eigen::Vector3d& p, double way) noexcept {
  const Eigen::Vector4d row(p.x() / kUnit, p.y() / kUnit, p.z() / kUnit, 1.0);
  const double square = p.squaredNorm() / (kUnit * kUnit);
  weight += way;
  squares += way * square * square;
  right += way * square * row;
  left += way * row * row.transpose();
}

/// A plane way fixes no centre across it; there the centre stays at the start.
double ContactEpisodes::unevenness() const noexcept {
  if (!(ball_.weight > 0.0)) {
    return 0.0;
  }
  Eigen::Matrix4d left = ball_.left / ball_.weight;
  left.diagonal().head<3>().array() += kLeastFixed;
  const Eigen::Vector4d right = ball_.right / ball_.weight;
  const Eigen::Vector4d fit = left.ldlt().solve(right);
  const double error = ball_.squares / ball_.weight - fit.dot(right);  // of |p|², squared
  const double radius = std::sqrt(std::max(0.0, fit[3] + 0.25 * fit.head<3>().squaredNorm()));
  return radius > 0.0 ? 0.5 * kUnit * std::sqrt(std::max(0.0, error)) / radius : 0.0;
}

void ContactEpisodes::Fluctuation::add(const Eigen::Vector3d& force, double dt) noexcept {
  slow = age > 0.0 ? slow + std::min(1.0, dt / kSlowTime) * (force - slow) : force;
  const Eigen::Vector3d now = force - slow;
  age += dt;
  if (age > 2.0 * kSlowTime) {
    squares += dt * now.squaredNorm();
    changes += dt * (now - fast).squaredNorm();
  }
  fast = now;
  period = dt;
}

void ContactEpisodes::Pushing::add(const Eigen::Vector3d& f, const Eigen::Vector3d& v,
                                   double dt) noexcept {
  const double share = std::min(1.0, dt / kPushFilter);
  if (age > 0.0) {
    force += share * (f - force);
    acceleration += share * ((v - before) / dt - acceleration);
    fa += dt * force.dot(acceleration);
    aa += dt * acceleration.squaredNorm();
  }
  before = v;
  age += dt;
}

ContactEpisodes::ContactEpisodes(const SenseParameters& senses) noexcept
    : contact_force_(senses.contact_force), moving_speed_(senses.moving_speed) {}

void ContactEpisodes::begin() noexcept {
  const double contact_force = contact_force_;
  const double moving_speed = moving_speed_;
  *this = ContactEpisodes(SenseParameters{});
  contact_force_ = contact_force;
  moving_speed_ = moving_speed;
}

void ContactEpisodes::feel(const Eigen::Vector3d& force, const PointState& hand,
                           double dt) noexcept {
  if (!force.allFinite() || !hand.position.allFinite() || !hand.velocity.allFinite()) {
    return;
  }
  if (!begun_) {
    begun_ = true;
    start_ = hand.position;
  }
  const bool touching = force.norm() > contact_force_;
  follow(hand.position, touching, dt);
  if (touching) {
    touch(force, hand.position - start_, dt);
    ball_.add(hand.position - start_, hand.velocity.norm() * dt);
    first_touch_ = first_touch_ < 0.0 ? time_ : first_touch_;
    last_touch_ = time_ + dt;
  }
  move(force, hand.velocity, touching, dt);
  throughout_.add(force, dt);
  pushing_.add(force, hand.velocity, dt);
  time_ += dt;
}

void ContactEpisodes::touch(const Eigen::Vector3d& force, const Eigen::Vector3d& p,
                            double dt) noexcept {
  upper_.add(force.norm(), dt);
  cloud_.weight += dt;
  cloud_.p += dt * p;
  cloud_.f += dt * force;
  cloud_.pp += dt * p * p.transpose();
  cloud_.pf += dt * p * force.transpose();
  cloud_.ff += dt * force * force.transpose();
}

void ContactEpisodes::move(const Eigen::Vector3d& force, const Eigen::Vector3d& v, bool touching,
                           double dt) noexcept {
  const double speed = v.norm();
  const bool moving = speed > moving_speed_;
  if (moving) {
    const double resisting = -force.dot(v) / speed;
    line_.add(speed, resisting, dt);
    lost_ += resisting * speed * dt;
    way_ += speed * dt;
  }
  if (!touching || !moving) {
    slow_age_ = 0.0;
    return;
  }
  slow_ = slow_age_ > 0.0 ? slow_ + std::min(1.0, dt / kSlowTime) * (force - slow_) : force;
  slow_age_ += dt;
  if (slow_age_ > 2.0 * kSlowTime) {  // before that the mean is still that of the first tick
    fluctuation_ += dt * (force - slow_).squaredNorm();
    rough_time_ += dt;
  }
}

void ContactEpisodes::follow(const Eigen::Vector3d& p, bool touching, double dt) noexcept {
  farthest_ = std::max(farthest_, (p - start_).norm());
  if (!touching) {
    free_for_ += dt;
    return;
  }
  if (contacts_ == 0) {
    first_ = p;
    contacts_ = 1;
  } else if (free_for_ >= kFreeAtLeast) {
    ++contacts_;
    longest_ = cloud_.weight > longest_.weight ? cloud_ : longest_;
    if (const double k = stiffness_of(cloud_); k > 0.0 && stiffness_count_ < stiffnesses_.size()) {
      stiffnesses_[stiffness_count_++] = k;
    }
    cloud_ = {};
    apart_ = std::max(apart_, (p - first_).norm());
  }
  free_for_ = 0.0;
}

double ContactEpisodes::stiffness() const noexcept {
  return stiffness_of(longest_.weight > cloud_.weight ? longest_ : cloud_);
}

double ContactEpisodes::contrast() const noexcept {
  std::array<double, 17> all{};
  std::copy_n(stiffnesses_.begin(), stiffness_count_, all.begin());
  std::size_t count = stiffness_count_;
  if (const double k = stiffness_of(cloud_); k > 0.0) {
    all[count++] = k;
  }
  if (count < 2) {
    return 1.0;
  }
  const auto end = all.begin() + static_cast<std::ptrdiff_t>(count);
  std::sort(all.begin(), end);
  const double median = 0.5 * (all[(count - 1) / 2] + all[count / 2]);
  return all[count - 1] / median;
}

double ContactEpisodes::stiffness_of(const Cloud& cloud) const noexcept {
  if (!(cloud.weight > 0.0)) {
    return 0.0;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(cloud.ff);
  const Eigen::Vector3d n = solver.eigenvectors().col(2);
  const double w = cloud.weight;
  const double p = n.dot(cloud.p);
  const double f = n.dot(cloud.f);
  const double variance = (n.dot(cloud.pp * n) - p * p / w) / w;
  if (!(variance > kLeastWay * kLeastWay)) {
    return 0.0;
  }
  return std::max(0.0, -(n.dot(cloud.pf * n) - p * f / w) / w / variance);
}

double ContactEpisodes::viscosity() const noexcept {
  return std::max(0.0, line_.slope(moving_speed_ * moving_speed_));
}

double ContactEpisodes::friction() const noexcept {
  return way_ > 0.0 ? std::max(0.0, lost_ / way_) : 0.0;
}

double ContactEpisodes::roughness() const noexcept {
  return rough_time_ > 0.0 ? std::sqrt(fluctuation_ / rough_time_) : 0.0;
}

double ContactEpisodes::extent() const noexcept {
  if (contacts_ == 0) {
    return farthest_;
  }
  return contacts_ == 1 ? (first_ - start_).norm() : apart_;
}

double ContactEpisodes::frequency() const noexcept {
  const double counted = throughout_.age - 2.0 * kSlowTime;
  if (!(counted > 0.0) || throughout_.squares < kLeastTremble * kLeastTremble * counted) {
    return 0.0;
  }
  // A sine of frequency w changes over a period T by 2 sin(w T / 2) times its size.
  const double half = 0.5 * std::sqrt(throughout_.changes / throughout_.squares);
  return std::asin(std::min(1.0, half)) / (std::numbers::pi * throughout_.period);
}

double ContactEpisodes::mass() const noexcept {
  return pushing_.aa > 0.0 ? std::max(0.0, -pushing_.fa / pushing_.aa) : 0.0;
}

double ContactEpisodes::duration() const noexcept {
  return first_touch_ < 0.0 ? time_ : last_touch_ - first_touch_;
}

double ContactEpisodes::resistance() const noexcept {
  return line_.weight > 0.0 ? std::max(0.0, line_.y / line_.weight) : 0.0;
}

ContactEpisode ContactEpisodes::met(Quantity quantity) const noexcept {
  switch (quantity) {
    case Quantity::kForce:
      return {force(), force()};
    case Quantity::kStiffness:
    case Quantity::kCompliance:
      return {stiffness(), force()};
    case Quantity::kViscosity:
      return {viscosity(), resistance()};
    case Quantity::kFriction:
      return {friction(), friction()};
    case Quantity::kRoughness:
      return {roughness(), roughness()};
    case Quantity::kExtent:
      return {extent(), 0.0};
    case Quantity::kUnevenness:
      return {unevenness(), 0.0};
    case Quantity::kContrast:
      return {contrast(), force()};
    case Quantity::kFrequency:
      return {frequency(), 0.0};
    case Quantity::kMass:
      return {mass(), 0.0};
    case Quantity::kDuration:
      return {duration(), 0.0};
  }
  return {};
}

}  // namespace haptrial::subject
