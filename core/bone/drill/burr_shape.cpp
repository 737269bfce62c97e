#include "core/bone/drill/burr_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace haptrial::bone {
namespace {

using Eigen::Vector2d;

void check_dimensions(const BurrDimensions& d) {
  const auto need = [](bool good, const char* name, double value, const char* allowed) {
    if (!good) {
      throw std::invalid_argument(fmt::format("Burr: {} is {}; allowed: {}", name, value, allowed));
    }
  };
  need(d.diameter > 0.0 && std::isfinite(d.diameter), "diameter", d.diameter, "above 0 [m]");
  if (d.form == BurrForm::kBall) {
    return;
  }
  const bool solid = d.form == BurrForm::kPear || d.form == BurrForm::kBlade;
  const bool narrow = solid || d.form == BurrForm::kCone;
  const double least = d.form == BurrForm::kPear ? d.diameter : 0.0;
  need(d.length > least && std::isfinite(d.length), "length", d.length,
       least > 0.0 ? "above the diameter [m]" : "above 0 [m]");
  need(!narrow || (d.narrow_diameter >= 0.0 && d.narrow_diameter <= d.diameter &&
                   (!solid || d.narrow_diameter > 0.0)),
       "narrow_diameter", d.narrow_diameter,
       solid ? "above 0, at most the diameter [m]" : "from 0 to the diameter [m]");
}

/// The volume within a line's or an arc's turn about the axis, over pi.
double turned(const Vector2d& a, const Vector2d& b, double arc_z, double arc_radius) {
  const double high = b.y() - a.y();
  if (arc_radius == 0.0) {
    return high / 3.0 * (a.x() * a.x() + a.x() * b.x() + b.x() * b.x());
  }
  const double from = a.y() - arc_z;
  const double to = b.y() - arc_z;
  return arc_radius * arc_radius * high - (to * to * to - from * from * from) / 3.0;
}

}  // namespace

BurrShape::BurrShape(const BurrDimensions& dimensions) : dimensions_(dimensions) {
  check_dimensions(dimensions);
  const BurrDimensions& d = dimensions_;
  if (is_ball()) {
    half_length_ = reach_ = 0.5 * d.diameter;
    fullness_ = kBallFullness;
    balls_ = {{0.0, reach_}};
    return;
  }
  half_length_ = 0.5 * d.length;
  if (d.form == BurrForm::kBlade) {
    reach_ = 0.5 * Eigen::Vector3d(d.diameter, d.narrow_diameter, d.length).norm();
    fullness_ = d.narrow_diameter * d.length / (d.diameter * d.diameter);
    fill_with_balls();
    return;
  }
  if (d.form == BurrForm::kPear) {
    add_pear();
  } else {
    const double wide = 0.5 * d.diameter;
    const double tip = d.form == BurrForm::kCone ? 0.5 * d.narrow_diameter : wide;
    const bool ends = d.form != BurrForm::kRod;
    if (tip > 0.0) {
      add_line({0.0, -half_length_}, {tip, -half_length_}, ends);
    }
    add_line({tip, -half_length_}, {wide, half_length_});
    add_line({wide, half_length_}, {0.0, half_length_}, ends);
  }
  measure();
}

void BurrShape::add_line(const Vector2d& a, const Vector2d& b, bool pushes) {
  Piece line;
  line.a = a;
  line.b = b;
  const Vector2d along = (b - a).normalized();
  line.normal = {along.y(), -along.x()};
  line.pushes = pushes;
  pieces_.push_back(line);
}

void BurrShape::add_arc(const Vector2d& a, const Vector2d& b, double z, double radius) {
  Piece arc;
  arc.a = a;
  arc.b = b;
  arc.normal.setZero();
  arc.arc_z = z;
  arc.arc_radius = radius;
  pieces_.push_back(arc);
}

/// The common tangent of both balls leaves either at the same latitude.
void BurrShape::add_pear() {
  const double wide = 0.5 * dimensions_.diameter;
  const double narrow = 0.5 * dimensions_.narrow_diameter;
  const double low = wide - half_length_;
  const double high = half_length_ - narrow;
  const double sine = (wide - narrow) / (high - low);
  const Vector2d normal(std::sqrt(1.0 - sine * sine), sine);
  const Vector2d from = Vector2d(0.0, low) + wide * normal;
  const Vector2d to = Vector2d(0.0, high) + narrow * normal;
  add_arc({0.0, -half_length_}, from, low, wide);
  add_line(from, to);
  add_arc(to, {0.0, half_length_}, high, narrow);
}

void BurrShape::measure() {
  double volume = 0.0;
  for (const Piece& piece : pieces_) {
    volume += turned(piece.a, piece.b, piece.arc_z, piece.arc_radius);
    reach_ = std::max({reach_, piece.a.norm(), piece.b.norm()});
  }
  fullness_ = std::numbers::pi * volume / std::pow(dimensions_.diameter, 3);
  fill_with_balls();
}

void BurrShape::fill_with_balls() {
  constexpr int kBalls = 9;
  const auto room = [this](double z) { return -nearest({0.0, 0.0, z}).distance; };
  /// Centre of the widest ball that touches an end on the axis.
  const auto outermost = [&](double side) {
    double outer = half_length_;
    double inner = 0.0;
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (outer + inner);
      const bool touches = room(side * middle) >= (half_length_ - middle) * (1.0 - 1e-9);
      (touches ? outer : inner) = middle;
    }
    return side * outer;
  };
  const double low = outermost(-1.0);
  const double high = outermost(1.0);
  for (int n = 0; n < kBalls; ++n) {
    const double z = low + (high - low) * n / (kBalls - 1);
    balls_.push_back({z, room(z)});
  }
}

bool BurrShape::is_point_symmetric() const noexcept {
  return is_ball() || dimensions_.form == BurrForm::kCylinder ||
         dimensions_.form == BurrForm::kRod || dimensions_.form == BurrForm::kBlade;
}

double BurrShape::volume() const noexcept { return fullness_ * std::pow(dimensions_.diameter, 3); }

double BurrShape::ball_radius() const noexcept {
  return is_ball() ? reach_ : 0.5 * dimensions_.diameter * std::cbrt(fullness_ / kBallFullness);
}

double BurrShape::radius_at(double z) const noexcept {
  if (is_ball()) {
    return std::sqrt(std::max(0.0, reach_ * reach_ - z * z));
  }
  if (dimensions_.form == BurrForm::kBlade) {
    return std::abs(z) <= half_length_ ? 0.5 * dimensions_.diameter : 0.0;
  }
  for (const Piece& piece : pieces_) {
    if (z < piece.a.y() || z > piece.b.y() || piece.is_flat_end()) {
      continue;
    }
    if (piece.arc_radius > 0.0) {
      const double from = z - piece.arc_z;
      return std::sqrt(std::max(0.0, piece.arc_radius * piece.arc_radius - from * from));
    }
    const double share = (z - piece.a.y()) / (piece.b.y() - piece.a.y());
    return piece.a.x() + share * (piece.b.x() - piece.a.x());
  }
  return 0.0;
}

/// Outside of an edge or a corner the normal leans over it.
BurrShape::Nearest BurrShape::nearest_of_box(const Eigen::Vector3d& p_T) const noexcept {
  const Eigen::Vector3d half =
      0.5 * Eigen::Vector3d(dimensions_.diameter, dimensions_.narrow_diameter, dimensions_.length);
  const Eigen::Vector3d beyond = p_T.cwiseAbs() - half;
  const Eigen::Vector3d outside = beyond.cwiseMax(0.0);
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Index face = 0;
  double distance = beyond.maxCoeff(&face);
  if (distance > 0.0) {
    distance = outside.norm();
    normal = outside / distance;
  } else {
    normal[face] = 1.0;
  }
  return {distance, (p_T.array() < 0.0).select(-normal, normal)};
}

BurrShape::Nearest BurrShape::nearest(const Eigen::Vector3d& p_T) const noexcept {
  if (dimensions_.form == BurrForm::kBlade) {
    return nearest_of_box(p_T);
  }
  if (is_ball()) {
    const double length = p_T.norm();
    return {length - reach_,
            length > 0.0 ? Eigen::Vector3d(p_T / length) : Eigen::Vector3d::UnitX()};
  }
  const double across = std::hypot(p_T.x(), p_T.y());
  const Vector2d p(across, p_T.z());
  double least = std::numeric_limits<double>::infinity();
  double sign = -1.0;
  Vector2d normal = Vector2d::UnitX();
  for (const Piece& piece : pieces_) {
    if (!piece.pushes) {
      continue;
    }
    Vector2d foot;
    Vector2d outward = piece.normal;
    if (piece.arc_radius > 0.0) {
      const Vector2d from(p.x(), p.y() - piece.arc_z);
      const double length = from.norm();
      const double sine = from.y();
      constexpr double kRounding = 1e-9;
      const double low = (piece.a.y() - piece.arc_z) / piece.arc_radius - kRounding;
      const double high = (piece.b.y() - piece.arc_z) / piece.arc_radius + kRounding;
      if (!(length > 0.0) || sine < low * length || sine > high * length) {
        continue;  // its ends are those of others
      }
      outward = from / length;
      foot = Vector2d(0.0, piece.arc_z) + piece.arc_radius * outward;
    } else {
      const Vector2d along = piece.b - piece.a;
      const double share = (p - piece.a).dot(along) / along.squaredNorm();
      foot = piece.a + std::clamp(share, 0.0, 1.0) * along;
    }
    const double distance = (p - foot).norm();
    const bool outside = (p - foot).dot(outward) > 0.0;
    if (distance < least || (distance == least && outside)) {  // an edge belongs to two
      least = distance;
      normal = outward;
      sign = outside ? 1.0 : -1.0;
    }
  }
  const Vector2d way =
      across > 0.0 ? Vector2d(p_T.head<2>() / across) : Vector2d(Vector2d::UnitX());
  return {sign * least, {normal.x() * way.x(), normal.x() * way.y(), normal.y()}};
}

std::vector<std::vector<BurrShape::OutlinePoint>> BurrShape::outline(int steps) const {
  std::vector<std::vector<OutlinePoint>> parts;
  const auto arc = [&](double from, double to, double z, double radius) {
    std::vector<OutlinePoint>& part = parts.emplace_back();
    for (int n = 0; n <= steps; ++n) {
      const double latitude = from + (to - from) * n / steps;
      const double across = std::max(0.0, std::cos(latitude));
      part.push_back({radius * across, z + radius * std::sin(latitude), across});
    }
  };
  constexpr double kPole = 0.5 * std::numbers::pi;
  if (is_ball()) {
    arc(-kPole, kPole, 0.0, reach_);
    return parts;
  }
  double side = 1.0;
  for (const Piece& piece : pieces_) {
    side = piece.arc_radius == 0.0 && !piece.is_flat_end() ? piece.normal.x() : side;
  }
  for (const Piece& piece : pieces_) {
    if (piece.arc_radius > 0.0) {
      const auto latitude = [&](const Vector2d& p) {
        return std::asin(std::clamp((p.y() - piece.arc_z) / piece.arc_radius, -1.0, 1.0));
      };
      arc(latitude(piece.a), latitude(piece.b), piece.arc_z, piece.arc_radius);
    } else {
      parts.push_back({{piece.a.x(), piece.a.y(), side}, {piece.b.x(), piece.b.y(), side}});
    }
  }
  return parts;
}

}  // namespace haptrial::bone
