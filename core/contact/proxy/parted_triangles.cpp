#include "core/contact/proxy/parted_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/geometry/triangle/four.h"

namespace haptrial::contact {
namespace {

using Eigen::Vector3d;
using geometry::all_four;
using geometry::Four;
using geometry::FourInts;
using geometry::smaller;

/// What single precision rounds away from a sum of a dozen numbers of size 1: less than this.
constexpr double kRounded = 4e-6;
/// An axis is turned by the rounding to single precision: a corner comes before its plane by less
/// than this part of how far the corner is.
constexpr double kTurned = 1.2e-7;
/// A plane that keeps nothing apart.
constexpr float kNowhere = 1e30f;

Four load(const std::vector<float>& from, std::size_t i) {
  Four x;
  std::memcpy(&x, from.data() + i, sizeof x);
  return x;
}

bool any(FourInts mask) {
  std::array<std::uint64_t, 2> halves;
  std::memcpy(halves.data(), &mask, sizeof mask);
  return (halves[0] | halves[1]) != 0;
}

/// x, y and z of a vector, each four times.
struct Fours {
  explicit Fours(const Vector3d& v)
      : x(all_four(static_cast<float>(v.x()))),
        y(all_four(static_cast<float>(v.y()))),
        z(all_four(static_cast<float>(v.z()))) {}
  Four x, y, z;
};

}  // namespace

PartedTriangles::PartedTriangles(std::size_t most)
    : slots_(most + 4),
      planes_(most + 4),
      x_(most + 4),
      y_(most + 4),
      z_(most + 4),
      level_(most + 4) {}

void PartedTriangles::clear(const Vector3d& middle, double reach) noexcept {
  middle_ = middle;
  scale_ = 1.0 / std::max(reach, 1e-300);
  count_ = 0;
}

void PartedTriangles::add(std::int32_t slot, const geometry::Corners& corners,
                          const Vector3d& from) noexcept {
  const int i = count_++;
  slots_[i] = slot;
  planes_[i].far = 0.0;
  for (const Vector3d& corner : corners) {
    planes_[i].far = std::max(planes_[i].far, (corner - middle_).lpNorm<1>());
  }
  const Vector3d out = from - (corners[0] + corners[1] + corners[2]) / 3.0;
  part(i, corners, out / std::max(out.norm(), 1e-300));
  for (std::size_t beyond = count_; beyond % 4 != 0; ++beyond) {
    x_[beyond] = y_[beyond] = z_[beyond] = 0.0f;
    level_[beyond] = -kNowhere;  // nothing, far behind its plane
  }
}

void PartedTriangles::part(int i, const geometry::Corners& corners, const Vector3d& axis) noexcept {
  Plane& plane = planes_[i];
  plane.axis = axis;
  plane.level = std::max({axis.dot(corners[0] - middle_), axis.dot(corners[1] - middle_),
                          axis.dot(corners[2] - middle_)});
  x_[i] = static_cast<float>(axis.x());
  y_[i] = static_cast<float>(axis.y());
  z_[i] = static_cast<float>(axis.z());
  const double level = scale_ * (plane.level + kTurned * plane.far);
  level_[i] = static_cast<float>(std::min<double>(level, kNowhere));
}

int PartedTriangles::within(const Vector3d& from, const Vector3d& move, double off,
                            std::span<Candidate> found) const noexcept {
  const Vector3d in_list = from - middle_, at = scale_ * in_list, way = scale_ * move;
  const Fours p(at), v(way);
  const double size = 1.0 + at.lpNorm<1>() + way.lpNorm<1>() + scale_ * off;
  const Four apart = all_four(static_cast<float>(scale_ * off + kRounded * size));
  int count = 0;
  for (int first = 0; first < count_; first += 4) {
    const Four x = load(x_, first), y = load(y_, first), z = load(z_, first);
    const Four height = x * p.x + y * p.y + z * p.z - load(level_, first) - apart;
    const Four rise = x * v.x + y * v.y + z * v.z;
    const FourInts reached = smaller(height, height + rise) <= 0.0f;
    if (!any(reached)) {
      continue;
    }
    for (int i = first; i < first + 4; ++i) {
      if (reached[i - first] == 0) {
        continue;
      }
      const Plane& plane = planes_[i];
      const double above = plane.axis.dot(in_list) - plane.level - off;
      const double gain = plane.axis.dot(move);
      if (std::min(above, above + gain) <= 0.0) {
        found[count++] = {i, above > 0.0 ? above / -gain : 0.0};
      }
    }
  }
  return count;
}

}  // namespace haptrial::contact
