#include "core/contact/vertex_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace haptrial::contact {

using Eigen::Vector3d;

namespace {

// More than all rounding, and so deep into a hull that there is no doubt, in skins.
constexpr double kDoubt = 1.0 / 16.0;
constexpr double kInto = 1.0 / 8.0;

}  // namespace

void VertexContact::set(const PlaneSet& met, const Vector3d& at, const Skin& skin) noexcept {
  met_ = met;
  at_ = at;
  skin_ = skin;
  prepared_ = false;
}

VertexContact::Side VertexContact::side(const ContactPlane& plane,
                                        const Hull& hull) const noexcept {
  const Hull::Heights heights = hull.heights(at_, Vector3d::Zero());
  const double h = skin_.thickness;
  Side side{plane.normal, std::min(-plane.height(at_), 0.0), 0.0, {}, {}, {}, {}};
  int own = 0;
  while (own + 1 < Hull::kPlanes && hull.out(own) != plane.normal) {
    ++own;
  }
  side.above = heights.at[own] - hull.wider(own, h);
  int bounds = 0;
  for (int k = 0; k < Hull::kPlanes && bounds < Side::kBounds; ++k) {
    // A face's other side is left only after the face is met.
    if (k == own || (own < Hull::kFaces && k < Hull::kFaces)) {
      continue;
    }
    side.x[bounds] = hull.x[k];
    side.y[bounds] = hull.y[k];
    side.z[bounds] = hull.z[k];
    side.room[bounds++] = hull.wider(k, h) - kDoubt * h - heights.at[k];
  }
  return side;
}

void VertexContact::prepare(NearTriangles& near) noexcept {
  for (int j = 0; j < met_.size(); ++j) {
    sides_[j] = side(met_[j], near.hull(met_[j].slot));
    for (int i = 0; i < j; ++i) {
      const Side &a = sides_[i], &b = sides_[j];
      const Vector3d along = a.normal.cross(b.normal);
      const double square = along.squaredNorm(), c = a.normal.dot(b.normal);
      lines_[j][i] = {
          along / std::sqrt(square),
          ((a.lack - c * b.lack) * a.normal + (b.lack - c * a.lack) * b.normal) / square,
          square > kParallel};
    }
  }
  prepared_ = true;
}

/// Whether a move is at a place well inside of the hull, before which it leads nowhere.
bool VertexContact::stops(const Side& side, const Vector3d& move, double square,
                          double enough) const noexcept {
  const double h = skin_.thickness;
  const double falls = -side.normal.dot(move), into = side.above + kInto * h;
  const double free = std::max(side.above - h, 0.0) + kDoubt * h;
  if (!(side.above > 0.0 && falls > into) ||
      free * free * square > enough * enough * falls * falls) {
    return false;
  }
  const Vector3d way = into / falls * move;
  Two left{1.0, 1.0};
  for (int k = 0; k < Side::kBounds; k += 2) {
    const Two room = load_two(&side.room[k]);
    const Two after = room - (load_two(&side.x[k]) * way.x() + load_two(&side.y[k]) * way.y() +
                              load_two(&side.z[k]) * way.z());
    left = room < left ? room : left;
    left = after < left ? after : left;
  }
  return left[0] > 0.0 && left[1] > 0.0;
}

bool VertexContact::stopped(const Vector3d& move, double enough,
                            Operations& operations) const noexcept {
  const double square = move.squaredNorm();
  if (square <= enough * enough) {
    return true;  // it leads nowhere
  }
  for (int k = 0; k < met_.size(); ++k) {
    ++operations.triangles_tested;
    if (stops(sides_[k], move, square, enough)) {
      return true;
    }
  }
  return false;
}

bool VertexContact::holds(const Vector3d& wish, double enough, NearTriangles& near) noexcept {
  if (!prepared_) {
    prepare(near);
  }
  Operations& operations = near.operations();
  if (!stopped(wish, enough, operations)) {
    return false;
  }
  for (int j = 0; j < met_.size(); ++j) {
    const Side& a = sides_[j];
    ++operations.plane_solutions;
    if (!stopped(wish + (a.lack - a.normal.dot(wish)) * a.normal, enough, operations)) {
      return false;
    }
    for (int i = 0; i < j; ++i) {
      const Line& line = lines_[j][i];
      ++operations.plane_solutions;
      if (line.known &&
          !stopped(line.along * line.along.dot(wish) + line.onto, enough, operations)) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace haptrial::contact
