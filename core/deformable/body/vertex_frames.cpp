#include "core/deformable/body/vertex_frames.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using Positions = std::span<const Vector3d>;

constexpr double kCancelled = 0.1;  // mean of unit normals below which a vertex has no frame
constexpr double kAcross = 0.1;     // share of an edge's length across the normal, to be taken
constexpr double kLost = 1e-6;      // of a normal or an edge's direction while deforming

const Vector3d& at(Positions positions, std::int32_t vertex) {
  return positions[static_cast<std::size_t>(vertex)];
}

/// 0 for a triangle without area.
Vector3d unit_normal(Positions positions, const Face& face) {
  const Vector3d normal = (at(positions, face[1]) - at(positions, face[0]))
                              .cross(at(positions, face[2]) - at(positions, face[0]));
  const double size = normal.norm();
  return size > 0 ? Vector3d(normal / size) : Vector3d(Vector3d::Zero());
}

double share_across(const Vector3d& edge, const Vector3d& unit) {
  const double length = edge.norm();
  return length > 0 ? (edge - edge.dot(unit) * unit).norm() / length : 0.0;
}

/// Neighbourhood of a vertex of the surface.
struct Around {
  std::vector<std::int32_t> faces;
  std::set<std::int32_t> ends;  // of surface edges
};

std::map<std::int32_t, Around> surroundings(std::span<const Face> surface) {
  std::map<std::int32_t, Around> around;
  for (std::size_t f = 0; f < surface.size(); ++f) {
    for (const std::int32_t vertex : surface[f]) {
      Around& a = around[vertex];
      a.faces.push_back(static_cast<std::int32_t>(f));
      for (const std::int32_t other : surface[f]) {
        if (other != vertex) {
          a.ends.insert(other);
        }
      }
    }
  }
  return around;
}

/// The first edge that lies well across the normal, or the one that does most.
std::int32_t chosen_end(Positions rest, std::int32_t vertex, const Around& around,
                        const Vector3d& unit) {
  std::int32_t best = *around.ends.begin();
  double most = 0;
  for (const std::int32_t end : around.ends) {
    const double share = share_across(at(rest, end) - at(rest, vertex), unit);
    if (share >= kAcross) {
      return end;
    }
    if (share > most) {
      most = share;
      best = end;
    }
  }
  return best;
}

void store(const Vector3d& from, std::array<double, 4>& to) {
  to = {from.x(), from.y(), from.z(), 0.0};
}

}  // namespace

VertexFrames::VertexFrames(Positions rest, std::span<const Face> surface)
    : surface_(surface.begin(), surface.end()), normals_(surface.size()) {
  first_.push_back(0);
  for (const auto& [vertex, around] : surroundings(surface)) {
    Vector3d sum = Vector3d::Zero();
    for (const std::int32_t f : around.faces) {
      sum += unit_normal(rest, surface_[static_cast<std::size_t>(f)]);
    }
    if (sum.norm() < kCancelled * static_cast<double>(around.faces.size())) {
      continue;
    }
    const std::int32_t end = chosen_end(rest, vertex, around, sum.normalized());
    if (share_across(at(rest, end) - at(rest, vertex), sum.normalized()) < kLost) {
      continue;
    }
    vertices_.push_back(vertex);
    edge_end_.push_back(end);
    faces_.insert(faces_.end(), around.faces.begin(), around.faces.end());
    first_.push_back(faces_.size());
  }
  frames_.resize(vertices_.size());
  update(rest);
}

void VertexFrames::keep(std::span<const std::int32_t> numbers) {
  std::vector<std::int32_t> vertices, ends, faces;
  std::vector<std::size_t> first{0};
  std::vector<Frame> frames;
  for (const std::int32_t number : numbers) {
    const auto n = static_cast<std::size_t>(number);
    vertices.push_back(vertices_[n]);
    ends.push_back(edge_end_[n]);
    frames.push_back(frames_[n]);
    faces.insert(faces.end(), faces_.begin() + static_cast<std::ptrdiff_t>(first_[n]),
                 faces_.begin() + static_cast<std::ptrdiff_t>(first_[n + 1]));
    first.push_back(faces.size());
  }
  vertices_ = std::move(vertices);
  edge_end_ = std::move(ends);
  faces_ = std::move(faces);
  first_ = std::move(first);
  frames_ = std::move(frames);
}

std::size_t VertexFrames::update(Positions positions) noexcept {
  for (std::size_t f = 0; f < surface_.size(); ++f) {
    normals_[f] = unit_normal(positions, surface_[f]);
  }
  std::size_t stayed = 0;
  for (std::size_t number = 0; number < vertices_.size(); ++number) {
    store(at(positions, vertices_[number]), frames_[number].origin);
    if (!turn(number, positions)) {
      ++stayed;
    }
  }
  return stayed;
}

bool VertexFrames::turn(std::size_t number, Positions positions) noexcept {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = first_[number]; i < first_[number + 1]; ++i) {
    sum += normals_[static_cast<std::size_t>(faces_[i])];
  }
  const double size = sum.norm();
  if (!(size > kLost * static_cast<double>(first_[number + 1] - first_[number]))) {
    return false;
  }
  const Vector3d x = sum / size;
  const Vector3d edge = at(positions, edge_end_[number]) - at(positions, vertices_[number]);
  const Vector3d across = edge - edge.dot(x) * x;
  const double width = across.norm();
  if (!(width > kLost * edge.norm())) {
    return false;
  }
  const Vector3d y = across / width;
  store(x, frames_[number].x);
  store(y, frames_[number].y);
  store(x.cross(y), frames_[number].z);
  return true;
}

}  // namespace haptrial::deformable
