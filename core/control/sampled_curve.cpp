#include "core/control/sampled_curve.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptrial::control {
namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = kChordRounding;

/// False for what is not a number.
bool within_bounds(const Vector3d& p) noexcept {
  constexpr double kMost = SampledCurve::kMostCoordinate;
  return std::abs(p.x()) <= kMost && std::abs(p.y()) <= kMost && std::abs(p.z()) <= kMost;
}

bool usable(std::span<const Vector3d> points) noexcept {
  return points.size() >= 2 && std::all_of(points.begin(), points.end(), within_bounds);
}

double distance_to_chord(const Vector3d& point, const Vector3d& from, const Vector3d& chord,
                         double inverse) noexcept {
  const Vector3d away = point - from;
  const double t = std::clamp(away.dot(chord) * inverse, 0.0, 1.0);
  return (away - t * chord).norm();
}

template <class T>
void fetch(const T& what) noexcept {
  constexpr std::size_t kLine = 64;
  for (std::size_t at = 0; at < sizeof what; at += kLine) {
    __builtin_prefetch(reinterpret_cast<const char*>(&what) + at);
  }
}

}  // namespace

/// One query on its way through the tree.
class SampledCurve::Search {
 public:
  Search(const SampledCurve& curve, const Vector3d& point, const CurveQuery& query)
      : curve_(curve),
        q_{point.x(),
           point.y(),
           point.z(),
           std::max(query.window.low, 0.0),
           std::min(query.window.high, curve.length()),
           query.known.low,
           query.known.high,
           query.below},
        slack_(query.tolerance),
        best_square_(query.below * query.below) {}

  /// Outwards from a strip and up the tree, until the nodes seen cover the window.
  void run_from(std::size_t strip) noexcept {
    std::size_t node = strip;
    bool seen = false;  // the node and all below it
    for (std::size_t level = 0; level < curve_.levels_.size(); ++level, node /= kRun) {
      const Pack& pack = curve_.levels_[level][node / kRun];
      const double begin = pack.arc[node % kRun];
      const double end = pack.arc[node % kRun + 1];
      if (!seen && !is_known(begin, end)) {
        descend(level, node);
        seen = true;
      }
      if (begin <= q_.low && end >= q_.high) {
        return;
      }
      if (seen) {
        scan_pack(level, node / kRun, node % kRun);
      }
    }
    if (!seen) {
      run_from_top();
    }
  }
  void run_from_top() noexcept { scan_pack(curve_.levels_.size() - 1, 0, kRun); }

  std::optional<CurvePlace> result() const noexcept {
    if (!found_) {
      return std::nullopt;
    }
    // The points that fill up the last strip lie on the curve's last point.
    const bool beyond = segment_ > curve_.size_ - 2;
    CurvePlace place = curve_.place(beyond ? curve_.size_ - 2 : segment_, beyond ? 1.0 : t_);
    place.distance = std::sqrt(best_square_);
    return place;
  }

 private:
  bool is_known(double begin, double end) const noexcept {
    return begin >= q_.known_low && end <= q_.known_high;
  }

  void descend(std::size_t level, std::size_t node) noexcept {
    if (level == 0) {
      scan_strip(node);
    } else {
      scan_pack(level - 1, node, kRun);
    }
  }

  void scan_pack(std::size_t level, std::size_t index, std::size_t skip) noexcept {
    const Pack& p = curve_.levels_[level][index];
    ChordLooks looks;
    unsigned waiting = scan_chords(p, q_, looks);
    if (skip < kRun) {
      waiting &= ~(1u << skip);
    }
    while (waiting != 0) {  // nearest chord first
      std::size_t next = kRun;
      double nearest = kInfinity;
      for (unsigned rest = waiting; rest != 0; rest &= rest - 1) {
        const auto c = static_cast<std::size_t>(__builtin_ctz(rest));
        if (next == kRun || looks.square[c] < nearest) {
          next = c;
          nearest = looks.square[c];
        }
      }
      waiting &= ~(1u << next);
      if (is_near(nearest, p.stray[next])) {
        fetch_ahead(level, index * kRun + next, looks.along[next]);
        descend(level, index * kRun + next);
      }
    }
  }

  /// Brings what lies below a node into the cache at once, where the nearest place of its chord
  /// says that it will be: level by level each would wait for the one before.
  void fetch_ahead(std::size_t level, std::size_t node, double along) const noexcept {
    if (level != 1 && level != 2) {
      return;
    }
    const auto strips = static_cast<double>(std::size_t{1} << (3 * level));
    const std::size_t strip =
        std::min((node << (3 * level)) + static_cast<std::size_t>(along * strips),
                 curve_.strips_.size() - 1);
    fetch(curve_.strips_[strip]);
    if (level == 2) {
      fetch(curve_.levels_[0][strip / kRun]);
    }
  }

  /// Whether a node may hold a nearer place; false where there is no such node.
  bool is_near(double square, double stray) const noexcept {
    const double far = q_.bound + stray;
    return square <= far * far * (1.0 + kRounding);
  }

  void scan_strip(std::size_t index) noexcept {
    const Strip& s = curve_.strips_[index];
    if (s.arc[0] > q_.high || s.arc[kRun] < q_.low) {
      return;
    }
    if (s.arc[0] < q_.low || s.arc[kRun] > q_.high) {
      scan_part_of_strip(index);
      return;
    }
    ChordLooks looks;
    measure_chords(s, q_, looks);
    std::size_t best = 0;
    for (std::size_t c = 1; c < kRun; ++c) {
      best = looks.square[c] < looks.square[best] ? c : best;
    }
    take(looks.square[best], index * kRun + best, looks.along[best]);
  }

  /// Scans the part of a strip in which the window begins or ends.
  void scan_part_of_strip(std::size_t index) noexcept {
    const Strip& s = curve_.strips_[index];
    for (std::size_t c = 0; c < kRun; ++c) {
      if (s.arc[c] > q_.high || s.arc[c + 1] < q_.low) {
        continue;
      }
      const double length = s.arc[c + 1] - s.arc[c];
      const double first = s.arc[c] < q_.low ? std::min(1.0, (q_.low - s.arc[c]) / length) : 0.0;
      const double last =
          s.arc[c + 1] > q_.high ? std::max(0.0, (q_.high - s.arc[c]) / length) : 1.0;
      const Vector3d start(s.x[c], s.y[c], s.z[c]);
      const Vector3d chord = Vector3d(s.x[c + 1], s.y[c + 1], s.z[c + 1]) - start;
      const Vector3d away = Vector3d(q_.x, q_.y, q_.z) - start;
      const double whole = chord.squaredNorm();
      double t = whole > 0.0 ? away.dot(chord) / whole : 0.0;
      t = std::min(std::max(t, first), std::max(first, last));
      take((away - t * chord).squaredNorm(), index * kRun + c, t);
    }
  }

  void take(double square, std::size_t segment, double t) noexcept {
    if (square < best_square_) {
      best_square_ = square;
      q_.bound = std::max(0.0, std::sqrt(square) - slack_);
      segment_ = segment;
      t_ = t;
      found_ = true;
    }
  }

  const SampledCurve& curve_;
  ChordQuery q_;
  double slack_;
  double best_square_;
  std::size_t segment_{0};
  double t_{0.0};
  bool found_{false};
};

SampledCurve::SampledCurve(std::span<const Vector3d> points) : size_(points.size()) {
  if (!usable(points)) {
    throw std::invalid_argument(
        "SampledCurve: at least two points, all of them finite and within 1e100 m");
  }
  strips_.resize((size_ - 2) / kRun + 1);
  // A curve's last point begins no segment of a strip of its own, but point() looks for it there.
  if ((size_ - 1) / kRun >= strips_.size()) {
    strips_.resize(strips_.size() + 1);
  }
  for (std::size_t nodes = strips_.size(); levels_.empty() || levels_.back().size() > 1;) {
    levels_.emplace_back((nodes + kRun - 1) / kRun);
    nodes = levels_.back().size();
  }
  fill_strips(points);
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    fill_nodes(level);
  }
}

void SampledCurve::fill_strips(std::span<const Vector3d> points) noexcept {
  double arc = 0.0;
  Vector3d before = points.front();
  for (std::size_t strip = 0; strip < strips_.size(); ++strip) {
    Strip& s = strips_[strip];
    for (std::size_t c = 0; c <= kRun; ++c) {
      const Vector3d& p = points[std::min(strip * kRun + c, size_ - 1)];
      if (c > 0) {
        arc += (p - before).norm();
      }
      before = p;
      s.x[c] = p.x();
      s.y[c] = p.y();
      s.z[c] = p.z();
      s.arc[c] = arc;
    }
  }
}

/// Start of strip `strip`; the curve's last point beyond them all.
Vector3d SampledCurve::strip_boundary(std::size_t strip) const noexcept {
  return strip < strips_.size() ? point(strip * kRun) : point(size_ - 1);
}

double SampledCurve::arc_at_boundary(std::size_t strip) const noexcept {
  return strip < strips_.size() ? strips_[strip].arc[0] : length();
}

/// Chords and strays of one level from those of the level below.
void SampledCurve::fill_nodes(std::size_t level) noexcept {
  const std::size_t strips_each = std::size_t{1} << (3 * level);
  for (std::size_t node = 0; node < levels_[level].size() * kRun; ++node) {
    Pack& pack = levels_[level][node / kRun];
    const std::size_t c = node % kRun;
    const std::size_t first = std::min(node * strips_each, strips_.size());
    const std::size_t last = std::min(first + strips_each, strips_.size());
    const Vector3d from = strip_boundary(first);
    const Vector3d to = strip_boundary(last);
    pack.x[c] = from.x();
    pack.y[c] = from.y();
    pack.z[c] = from.z();
    pack.x[c + 1] = to.x();
    pack.y[c + 1] = to.y();
    pack.z[c + 1] = to.z();
    pack.arc[c] = arc_at_boundary(first);
    pack.arc[c + 1] = arc_at_boundary(last);
    pack.stray[c] = first < last ? stray_of(level, node, from, to - from)
                                 : std::numeric_limits<double>::quiet_NaN();
  }
}

/// The farthest that any point of a node lies from its chord, rounded up.
double SampledCurve::stray_of(std::size_t level, std::size_t node, const Vector3d& from,
                              const Vector3d& chord) const noexcept {
  const double square = chord.squaredNorm();
  const double inverse = square > 0.0 && 1.0 / square < kInfinity ? 1.0 / square : 0.0;
  const auto away = [&](const Vector3d& p) { return distance_to_chord(p, from, chord, inverse); };
  double stray = 0.0;
  const Chords& below = level == 0 ? strips_[node] : levels_[level - 1][node];
  for (std::size_t i = 0; i < kRun; ++i) {
    const double ends = std::max(away({below.x[i], below.y[i], below.z[i]}),
                                 away({below.x[i + 1], below.y[i + 1], below.z[i + 1]}));
    const double own = level == 0 ? 0.0 : levels_[level - 1][node].stray[i];
    stray = own >= 0.0 ? std::max(stray, ends + own) : stray;  // NaN: no such child
  }
  return stray * (1.0 + kRounding) + kRounding * chord.norm();
}

Vector3d SampledCurve::point(std::size_t i) const noexcept {
  const Strip& s = strips_[i / kRun];
  return {s.x[i % kRun], s.y[i % kRun], s.z[i % kRun]};
}

double SampledCurve::arc_of(std::size_t segment, double t) const noexcept {
  const Strip& s = strips_[segment / kRun];
  const std::size_t c = segment % kRun;
  return t < 1.0 ? s.arc[c] + t * (s.arc[c + 1] - s.arc[c]) : s.arc[c + 1];
}

CurvePlace SampledCurve::place(std::size_t segment, double t) const noexcept {
  const Strip& s = strips_[segment / kRun];
  const std::size_t c = segment % kRun;
  const Vector3d from(s.x[c], s.y[c], s.z[c]);
  const Vector3d to(s.x[c + 1], s.y[c + 1], s.z[c + 1]);
  CurvePlace place;
  place.segment = segment;
  place.t = t;
  place.arc = arc_of(segment, t);
  place.position = t < 1.0 ? Vector3d(from + t * (to - from)) : to;
  return place;
}

CurvePlace SampledCurve::nearest(const Vector3d& point) const noexcept {
  if (within_bounds(point)) {
    Search search(*this, point, {});
    search.run_from_top();
    if (const auto found = search.result()) {
      return *found;
    }
  }
  CurvePlace none = place(0, 0.0);
  none.distance = kInfinity;
  return none;
}

std::optional<CurvePlace> SampledCurve::nearest(const Vector3d& point,
                                                const CurveQuery& query) const noexcept {
  if (!within_bounds(point)) {
    return std::nullopt;
  }
  Search search(*this, point, query);
  search.run_from(std::min(query.from_segment, size_ - 2) / kRun);
  return search.result();
}

CurvePlace SampledCurve::at(double wanted) const noexcept {
  // The last segment that begins at or before the position.
  std::size_t low = 0;
  std::size_t high = size_ - 1;
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (arc(middle) <= wanted ? low : high) = middle;
  }
  const double span = arc(low + 1) - arc(low);
  return place(low, span > 0.0 ? std::clamp((wanted - arc(low)) / span, 0.0, 1.0) : 0.0);
}

/// The direction of the first segment that ends beyond `position`; zero if none does.
Vector3d SampledCurve::direction_after(double position) const noexcept {
  std::size_t low = 0;
  std::size_t high = size_ - 1;
  if (!(arc(high) > position)) {
    return Vector3d::Zero();
  }
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (arc(middle) > position ? high : low) = middle;
  }
  return (point(high) - point(low)).stableNormalized();
}

/// The direction of the last segment that begins before `position`; zero if none does.
Vector3d SampledCurve::direction_before(double position) const noexcept {
  std::size_t low = 0;
  std::size_t high = size_ - 1;
  if (!(arc(low) < position)) {
    return Vector3d::Zero();
  }
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (arc(middle) < position ? low : high) = middle;
  }
  return (point(low + 1) - point(low)).stableNormalized();
}

Vector3d SampledCurve::tangent(const CurvePlace& at, const Vector3d& from) const noexcept {
  if (at.t > 0.0 && at.t < 1.0 && arc(at.segment + 1) > arc(at.segment)) {
    return (point(at.segment + 1) - point(at.segment)).stableNormalized();
  }
  const Vector3d before = direction_before(at.arc);
  const Vector3d after = direction_after(at.arc);
  if (before.isZero(0.0) || after.isZero(0.0)) {
    return before + after;
  }
  // At a corner the point lies ahead of the one segment and behind the other.
  const Vector3d away = from - at.position;
  const double ahead = std::max(0.0, away.dot(before));
  const double behind = std::max(0.0, -away.dot(after));
  const double share = ahead + behind > 0.0 ? ahead / (ahead + behind) : 0.5;
  const Vector3d mixed = (1.0 - share) * before + share * after;
  const double length = mixed.norm();
  return length > 1e-6 ? Vector3d(mixed / length) : before;  // a hairpin turns on the spot
}

}  // namespace haptrial::control
