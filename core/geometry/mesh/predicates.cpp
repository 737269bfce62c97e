#include "core/geometry/mesh/predicates.h"

#include <array>
#include <cmath>
#include <limits>

namespace haptrial::geometry {
namespace {

constexpr double kEpsilon = 0.5 * std::numeric_limits<double>::epsilon();  // 2^-53

/// A sum of doubles without rounding: parts that do not overlap, from small to large.
class ExactSum {
 public:
  void add(double value) {
    int kept = 0;
    for (int i = 0; i < count_; ++i) {
      const double sum = value + parts_[i];
      const double of_part = sum - value;
      const double lost = (value - (sum - of_part)) + (parts_[i] - of_part);
      value = sum;
      if (lost != 0.0) {
        parts_[kept++] = lost;
      }
    }
    if (value != 0.0) {
      parts_[kept++] = value;
    }
    count_ = kept;
  }

  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }

  void add_product(double a, double b, double c) {
    const double product = a * b;
    add_product(std::fma(a, b, -product), c);
    add_product(product, c);
  }

  int sign() const { return count_ == 0 ? 0 : parts_[count_ - 1] > 0.0 ? 1 : -1; }

 private:
  static constexpr int kMost = 200;  // 6 permutations of 3 factors of 2 parts give 192 at most
  std::array<double, kMost> parts_;
  int count_{0};
};

/// a - b without rounding.
struct Difference {
  Difference(double a, double b) : high(a - b) {
    const double of_b = a - high;
    low = (a - (high + of_b)) + (of_b - b);
  }
  double high;
  double low;
};

int sign_of(double value) { return (value > 0.0) - (value < 0.0); }

void add_product(ExactSum& sum, const Difference& a, const Difference& b, double sign) {
  for (const double x : {a.low, a.high}) {
    for (const double y : {b.low, b.high}) {
      if (x != 0.0 && y != 0.0) {
        sum.add_product(sign * x, y);
      }
    }
  }
}

void add_product(ExactSum& sum, const Difference& a, const Difference& b, const Difference& c,
                 double sign) {
  for (const double x : {a.low, a.high}) {
    for (const double y : {b.low, b.high}) {
      for (const double z : {c.low, c.high}) {
        if (x != 0.0 && y != 0.0 && z != 0.0) {
          sum.add_product(sign * x, y, z);
        }
      }
    }
  }
}

int exact_side_of_plane(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c, const Eigen::Vector3d& p) {
  const auto row = [&](const Eigen::Vector3d& to) {
    return std::array<Difference, 3>{Difference(to.x(), a.x()), Difference(to.y(), a.y()),
                                     Difference(to.z(), a.z())};
  };
  const std::array<Difference, 3> u = row(b);
  const std::array<Difference, 3> v = row(c);
  const std::array<Difference, 3> w = row(p);
  ExactSum sum;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    add_product(sum, u[i], v[j], w[k], 1.0);
    add_product(sum, u[j], v[i], w[k], -1.0);
  }
  return sum.sign();
}

}  // namespace

int side_of_line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  const double left = (b.x() - a.x()) * (p.y() - a.y());
  const double right = (b.y() - a.y()) * (p.x() - a.x());
  const double bound = (3.0 + 16.0 * kEpsilon) * kEpsilon * (std::abs(left) + std::abs(right));
  if (std::abs(left - right) > bound) {
    return sign_of(left - right);
  }
  ExactSum sum;
  add_product(sum, Difference(b.x(), a.x()), Difference(p.y(), a.y()), 1.0);
  add_product(sum, Difference(b.y(), a.y()), Difference(p.x(), a.x()), -1.0);
  return sum.sign();
}

int side_of_plane(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                  const Eigen::Vector3d& p) {
  const Eigen::Vector3d u = b - a;
  const Eigen::Vector3d v = c - a;
  const Eigen::Vector3d w = p - a;
  double value = 0.0;
  double size = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double plus = u[i] * v[(i + 1) % 3];
    const double minus = u[(i + 1) % 3] * v[i];
    value += (plus - minus) * w[(i + 2) % 3];
    size += (std::abs(plus) + std::abs(minus)) * std::abs(w[(i + 2) % 3]);
  }
  if (std::abs(value) > (7.0 + 56.0 * kEpsilon) * kEpsilon * size) {
    return sign_of(value);
  }
  return exact_side_of_plane(a, b, c, p);
}

}  // namespace haptrial::geometry
