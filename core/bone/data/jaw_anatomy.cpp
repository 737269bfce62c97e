#include "core/bone/data/jaw_anatomy.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/random.h"

namespace haptrial::bone {
namespace {

constexpr double kCrest = 29.5;  // of the alveolar bone, where the body is not raised [mm]

/// Width along the arch, crown, root [mm] and roots, from the middle to the back.
struct ToothSize {
  double width;
  double crown;
  double root;
  int roots;
};
constexpr std::array<ToothSize, 8> kTeeth{{{5.3, 9.0, 12.5, 1},
                                           {5.7, 9.5, 14.0, 1},
                                           {6.8, 11.0, 16.0, 1},
                                           {7.0, 8.5, 14.0, 1},
                                           {7.1, 8.0, 14.5, 1},
                                           {11.2, 7.5, 14.0, 2},
                                           {10.7, 7.0, 13.0, 2},
                                           {10.0, 7.0, 11.0, 2}}};

/// Signed distance to a polygon.
double polygon(const Eigen::Vector2d& p, const std::vector<Eigen::Vector2d>& corners) {
  double best = 1e18;
  bool inside = false;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Eigen::Vector2d& a = corners[j];
    const Eigen::Vector2d& b = corners[i];
    const Eigen::Vector2d along = b - a;
    const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    best = std::min(best, (p - a - t * along).squaredNorm());
    const bool above = a.y() > p.y();
    if (above != (b.y() > p.y()) &&
        p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) {
      inside = !inside;
    }
  }
  const double distance = std::sqrt(best);
  return inside ? -distance : distance;
}

}  // namespace

JawVariation jaw_variation(std::uint64_t seed) {
  RandomStream random(seed, "mandible");
  JawVariation v;
  v.scale = random.uniform(0.92, 1.05);
  v.spread = random.uniform(-2.5, 2.0);
  v.gonion = random.uniform(-3.0, 2.0);
  v.height = random.uniform(-1.5, 1.5);
  v.canal = random.uniform(-1.0, 1.5);
  v.mental = random.uniform(-2.0, 3.0);
  v.cortex = random.uniform(1.9, 2.6);
  v.wisdom = random.uniform() < 0.7;
  v.noise = random.bits();
  return v;
}

JawAnatomy::JawAnatomy(const JawVariation& variation, double least) : v_(variation) {
  const double s = v_.spread;
  arch_ = smooth({{{-12.0, 8.0, 0.0}, 0.0},
                  {{0.0, 5.0, 0.0}, 0.0},
                  {{12.0, 8.0, 0.0}, 0.0},
                  {{20.5, 15.0, 0.0}, 0.0},
                  {{25.0, 24.0, 0.0}, 0.0},
                  {{30.0 + 0.3 * s, 37.0, 0.0}, 0.0},
                  {{36.0 + 0.6 * s, 51.0, 0.0}, 0.0},
                  {{42.0 + s, 64.0, 0.0}, 0.0},
                  {{46.0 + s, 75.0, 0.0}, 0.0}},
                 4);
  const double g = v_.gonion;
  outline_ = {{58.0, 7.5},  {66.0 + g, 7.0}, {76.0 + g, 10.5}, {80.5 + g, 18.0}, {83.0, 34.0},
              {88.0, 52.0}, {89.0, 63.0},    {80.5, 61.0},     {75.5, 51.5},     {70.0, 49.0},
              {65.0, 54.0}, {59.0, 64.0},    {56.0, 62.0},     {55.0, 48.0},     {53.5, 38.0},
              {49.0, 30.0}, {53.0, 22.0}};
  const double up = v_.canal;
  const double back = v_.mental;
  nerve_ = Tube(smooth({{{38.5 + s, 67.5, 45.0}, 1.3},
                        {{43.2 + s, 68.0, 39.0}, 1.3},  // mandibular foramen
                        {{45.6 + s, 66.5, 31.0}, 1.3},
                        {{44.2 + s, 60.5, 19.5 + 0.5 * up}, 1.3},
                        {{38.3 + 0.7 * s, 52.0, 12.2 + up}, 1.3},
                        {{32.5 + 0.4 * s, 40.0, 10.2 + up}, 1.3},
                        {{27.6 + 0.1 * s, 28.0 + back, 11.6 + up}, 1.2},
                        {{28.8, 24.5 + back, 13.8 + up}, 1.2},  // turns out to the mental foramen
                        {{33.0, 26.0 + back, 16.0 + up}, 1.2}},
                       5),
                least);
  add_teeth();
}

void JawAnatomy::add_teeth() {
  double along = 0.0;  // the arch, from the middle
  std::size_t bead = 4;
  double passed = 0.0;
  const double crest = kCrest + v_.height;
  for (std::size_t n = 0; n < (v_.wisdom ? 8U : 7U); ++n) {
    const ToothSize& size = kTeeth[n];
    const double middle = along + size.width / 2.0;
    along += size.width;
    while (bead + 2 < arch_.size() &&
           passed + (arch_[bead + 1].at - arch_[bead].at).norm() < middle) {
      passed += (arch_[bead + 1].at - arch_[bead].at).norm();
      ++bead;
    }
    const Point step = arch_[bead + 1].at - arch_[bead].at;
    const Point forward = step.normalized();
    const Point across(-forward.y(), forward.x(), 0.0);  // to the tongue
    const Point base = arch_[bead].at + (middle - passed) * forward + (n > 4 ? 1.2 : 0.0) * across +
                       crest * Point::UnitZ();
    const double half = size.width / 2.0;
    const double top = n == 2 ? 1.5 : n < 2 ? 0.85 * half : half - 0.25;
    const Point crown = base + (size.crown - top) * Point::UnitZ();
    Tooth tooth;
    if (size.roots == 2) {
      const double shift = half - 3.9 > 0.0 ? half - 3.9 : 0.2;
      tooth.crown = Tube({{crown - shift * forward, 3.7}, {crown + shift * forward, 3.7}});
    } else {
      tooth.crown = Tube({{base + 0.5 * Point::UnitZ(), half - 0.2}, {crown, std::max(top, 1.0)}});
    }
    for (int root = 0; root < size.roots; ++root) {
      const double side = size.roots == 1 ? 0.0 : (root == 0 ? -1.0 : 1.0) * size.width / 4.2;
      const double thick = size.roots == 1 ? 0.42 * size.width : 2.2;
      const Point neck = base + side * forward + 1.5 * Point::UnitZ();
      const Point apex = base + (side + 0.8) * forward + (0.8 - size.root) * Point::UnitZ();
      tooth.roots.push_back(Tube({{neck, thick}, {apex, 0.8}}));
    }
    teeth_.push_back(std::move(tooth));
  }
}

double JawAnatomy::tooth(const Point& p) const {
  double best = 1e9;
  for (const Tooth& tooth : teeth_) {
    best = std::min(best, tooth.crown.distance(p, 2.0));
    for (const Tube& root : tooth.roots) {
      best = std::min(best, root.distance(p, 2.0));
    }
  }
  return best;
}

/// A plate along the arch, rounded at its borders.
double JawAnatomy::body(const Point& p) const {
  constexpr double kFar = 8.0;  // from there on it changes nothing
  if (p.z() > kCrest + v_.height + kFar) {
    return kFar;
  }
  double best = 1e18;
  double place = 0.0;  // along the arch, 0 to 1
  for (std::size_t i = 1; i < arch_.size(); ++i) {
    const Eigen::Vector2d a = arch_[i - 1].at.head<2>();
    const Eigen::Vector2d along = arch_[i].at.head<2>() - a;
    const Eigen::Vector2d from = p.head<2>() - a;
    const double t = std::clamp(from.dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double square = (from - t * along).squaredNorm();
    if (square < best) {
      best = square;
      place = (static_cast<double>(i) - 1.0 + t) / (static_cast<double>(arch_.size()) - 1.0);
    }
  }
  const double bottom = 0.5 + 7.0 * std::max(0.0, place - 0.3) * std::max(0.0, place - 0.3) / 0.5;
  const double top = kCrest + v_.height;
  const double rise = std::clamp((p.z() - bottom) / (top - bottom), 0.0, 1.0);
  // Thickest low down, and narrower between the teeth and the base at the front.
  const double half = 5.6 + 0.8 * place - 0.9 * rise;
  const double round = 4.0;
  const double sideways = std::sqrt(best) - (half - round);
  const double upright = std::max(bottom + round - p.z(), p.z() - (top - round));
  const double x = std::max(sideways, 0.0);
  const double z = std::max(upright, 0.0);
  const double plate =
      std::sqrt(x * x + z * z) + std::min(std::max(sideways, upright), 0.0) - round;
  const double chin = round_cone(p, {0.0, 1.0, 5.0}, {11.0, 3.5, 4.0}, 4.0, 3.0);
  return smooth_union(plate, chin, 4.0);
}

double JawAnatomy::ramus(const Point& p) const {
  constexpr double kFar = 8.0;
  if (p.x() < 29.0 + v_.spread || p.y() < 40.0) {
    return kFar;
  }
  const double rise = std::clamp(p.z() / 62.0, 0.0, 1.1);
  const double middle = 44.5 + v_.spread + 5.5 * rise + 0.06 * (p.y() - 68.0);
  const double half = 3.6 - 1.0 * rise + (p.z() < 24.0 ? 0.05 * (24.0 - p.z()) : 0.0);
  const double side = std::abs(p.x() - middle) - half;
  const double flat = polygon({p.y(), p.z()}, outline_) - 1.0;
  const double round = 2.0;
  const double a = std::max(side + round, 0.0);
  const double b = std::max(flat + round, 0.0);
  const double plate =
      std::sqrt(a * a + b * b) + std::min(std::max(side, flat) + round, 0.0) - round;
  const double x = 50.5 + v_.spread;
  const double neck = round_cone(p, {x, 85.0, 56.0}, {x, 87.0, 64.0}, 3.6, 4.0);
  const double head = ellipsoid(p, {x - 0.5, 87.0, 67.5}, {9.6, 4.4, 4.6});
  return smooth_union(smooth_union(plate, neck, 3.0), head, 3.0);
}

EarAnatomy::Material JawAnatomy::at(Point p) const {
  p.x() = std::abs(p.x());
  const double nerve = nerve_.distance(p, 3.0);
  const double bone = smooth_union(body(p), ramus(p), 5.0) + 0.3 * noise(v_.noise, p / 6.0);
  if (nerve < 0.0 && bone < 1.0) {
    return {Anatomy::kAlveolarNerve, 1.0};
  }
  const double teeth = tooth(p);
  if (teeth < 0.0) {
    return {Anatomy::kTooth, 1.0};
  }
  if (bone >= 0.0) {
    return {};
  }
  // Thicker along the lower border; a thin sheet around roots and canal.
  const double cortex = v_.cortex * (p.z() < 8.0 ? 1.3 : 1.0);
  if (-bone < cortex || nerve < 0.7 || teeth < 0.7) {
    return {Anatomy::kBone, 1.0};
  }
  return {Anatomy::kBone, 0.4 + 0.12 * noise(v_.noise + 3, p / 1.6)};
}

}  // namespace haptrial::bone
