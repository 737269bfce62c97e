#include "core/bone/data/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace haptrial::bone {
namespace {

/// A number from 0 to 1 for a node of a lattice.
double number_at(std::uint64_t seed, std::int64_t i, std::int64_t j, std::int64_t k) {
  std::uint64_t x = seed ^ (static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15ULL) ^
                    (static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4FULL) ^
                    (static_cast<std::uint64_t>(k) * 0x165667B19E3779F9ULL);
  for (int round = 0; round < 2; ++round) {
    x ^= x >> 31;
    x *= 0xBF58476D1CE4E5B9ULL;
    x ^= x >> 29;
    x *= 0x94D049BB133111EBULL;
  }
  return static_cast<double>(x >> 11) * 0x1p-53;
}

double fade(double t) { return t * t * (3.0 - 2.0 * t); }

}  // namespace

Rotation turn_by(double angle) {
  // A quarter of the angle by series, then doubled twice.
  const double x = angle / 4.0;
  double cosine = 1.0;
  double sine = x;
  double term = 1.0;
  double odd = x;
  for (int n = 1; n <= 9; ++n) {
    term *= -x * x / ((2.0 * n - 1.0) * (2.0 * n));
    odd *= -x * x / ((2.0 * n) * (2.0 * n + 1.0));
    cosine += term;
    sine += odd;
  }
  for (int twice = 0; twice < 2; ++twice) {
    const double c = cosine * cosine - sine * sine;
    sine = 2.0 * sine * cosine;
    cosine = c;
  }
  return {cosine, sine};
}

double round_cone(const Point& p, const Point& a, const Point& b, double ra, double rb) {
  const Point along = b - a;
  const double square = along.squaredNorm();
  const double t = square > 0.0 ? std::clamp((p - a).dot(along) / square, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm() - (ra + t * (rb - ra));
}

double ellipsoid(const Point& p, const Point& centre, const Point& radii) {
  const Point scaled = (p - centre).cwiseQuotient(radii);
  const double k = scaled.norm();
  const double slope = scaled.cwiseQuotient(radii).norm();
  return slope > 1e-12 ? k * (k - 1.0) / slope : -radii.minCoeff();
}

double smooth_union(double a, double b, double width) {
  const double h = std::max(width - std::abs(a - b), 0.0) / width;
  return std::min(a, b) - h * h * width / 4.0;
}

Tube::Tube(std::vector<TubeNode> beads, double least) : beads_(std::move(beads)) {
  low_ = high_ = beads_.front().at;
  for (TubeNode& bead : beads_) {
    bead.radius = std::max(bead.radius, least);
    low_ = low_.cwiseMin((bead.at.array() - bead.radius).matrix());
    high_ = high_.cwiseMax((bead.at.array() + bead.radius).matrix());
  }
}

double Tube::distance(const Point& p, double care) const {
  const Point beyond = (low_ - p).cwiseMax(p - high_).cwiseMax(0.0);
  const double outside = beyond.norm();
  if (outside > care) {
    return outside;
  }
  double best = 1e9;
  for (std::size_t i = 1; i < beads_.size(); ++i) {
    best = std::min(best, round_cone(p, beads_[i - 1].at, beads_[i].at, beads_[i - 1].radius,
                                     beads_[i].radius));
  }
  return best;
}

double Tube::length() const {
  double sum = 0.0;
  for (std::size_t i = 1; i < beads_.size(); ++i) {
    sum += (beads_[i].at - beads_[i - 1].at).norm();
  }
  return sum;
}

std::vector<Tube::TubeNode> smooth(const std::vector<Tube::TubeNode>& through, int steps) {
  std::vector<Tube::TubeNode> beads;
  const auto last = static_cast<std::ptrdiff_t>(through.size()) - 1;
  const auto at = [&](std::ptrdiff_t i) -> const Tube::TubeNode& {
    return through[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, last))];
  };
  for (std::ptrdiff_t i = 0; i < last; ++i) {
    for (int step = 0; step < steps; ++step) {
      const double t = static_cast<double>(step) / steps;
      const Point& p = at(i).at;
      const Point& q = at(i + 1).at;
      const Point out = (q - at(i - 1).at) / 2.0;
      const Point in = (at(i + 2).at - p) / 2.0;
      const double h = t * t * (3.0 - 2.0 * t);
      const Point place = (1.0 - h) * p + h * q + t * (1.0 - t) * ((1.0 - t) * out - t * in);
      beads.push_back({place, at(i).radius + t * (at(i + 1).radius - at(i).radius)});
    }
  }
  beads.push_back(through.back());
  return beads;
}

std::vector<Tube::TubeNode> arc(const Point& centre, const Point& u, const Point& v, double radius,
                                double from_degrees, double to_degrees, double tube, int steps) {
  std::vector<Tube::TubeNode> beads;
  for (int step = 0; step <= steps; ++step) {
    const double degrees = from_degrees + (to_degrees - from_degrees) * step / steps;
    const Rotation turn = turn_by(degrees * std::numbers::pi / 180.0);
    beads.push_back({centre + radius * (turn.cosine * u + turn.sine * v), tube});
  }
  return beads;
}

bool Cells::holds(const Point& p, double fill) const {
  if (fill <= 0.0) {
    return false;
  }
  const Point scaled = p / pitch_;
  std::array<std::int64_t, 3> base{};
  for (int axis = 0; axis < 3; ++axis) {
    base[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::floor(scaled[axis]));
  }
  double nearest = 1e9;
  double second = 1e9;
  double size = 0.0;
  for (std::int64_t n = 0; n < 27; ++n) {
    const std::int64_t i = base[0] + n % 3 - 1;
    const std::int64_t j = base[1] + n / 3 % 3 - 1;
    const std::int64_t k = base[2] + n / 9 - 1;
    const Point node(static_cast<double>(i) + number_at(seed_, i, j, k),
                     static_cast<double>(j) + number_at(seed_ + 1, i, j, k),
                     static_cast<double>(k) + number_at(seed_ + 2, i, j, k));
    const double distance = (scaled - node).norm();
    if (distance < nearest) {
      second = nearest;
      nearest = distance;
      size = number_at(seed_ + 3, i, j, k);
    } else {
      second = std::min(second, distance);
    }
  }
  const double radius = fill * (0.6 + 0.6 * size);
  return nearest < radius && (second - nearest) * pitch_ > wall_;
}

double noise(std::uint64_t seed, const Point& p) {
  std::array<std::int64_t, 3> base{};
  Point t;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = std::floor(p[axis]);
    base[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(low);
    t[axis] = fade(p[axis] - low);
  }
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const int x = corner % 2;
    const int y = corner / 2 % 2;
    const int z = corner / 4;
    const double weight =
        (x ? t[0] : 1.0 - t[0]) * (y ? t[1] : 1.0 - t[1]) * (z ? t[2] : 1.0 - t[2]);
    sum += weight * number_at(seed, base[0] + x, base[1] + y, base[2] + z);
  }
  return 2.0 * sum - 1.0;
}

}  // namespace haptrial::bone
