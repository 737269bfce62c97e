#include "core/deformable/springs/spring_hessian.h"

#include <Eigen/Geometry>

#include "core/deformable/springs/part_index.h"

namespace haptrial::deformable {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

template <std::size_t n>
using Blocks = std::array<std::array<Matrix3d, n>, n>;

using Block = Eigen::Map<Matrix3d>;

/// Edges ascend by their lower vertices, as the rows do: each row has its diagonal block first.
BlockMatrix pattern_of(std::span<const Edge> edges, std::size_t vertices) {
  std::vector<std::int32_t> start, column;
  std::size_t next = 0;
  for (std::size_t v = 0; v < vertices; ++v) {
    start.push_back(static_cast<std::int32_t>(column.size()));
    column.push_back(static_cast<std::int32_t>(v));
    for (; next < edges.size() && edges[next][0] == static_cast<std::int32_t>(v); ++next) {
      column.push_back(edges[next][1]);
    }
  }
  start.push_back(static_cast<std::int32_t>(column.size()));
  return {std::move(start), std::move(column)};
}

/// cross_with(a) b = a x b
Matrix3d cross_with(const Vector3d& a) {
  Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// k / m0² (g gᵀ + (m - m0) H) of a measure m with gradient g and second derivatives H.
template <std::size_t n>
Blocks<n> of_measure(const Spring& spring, double measure, const std::array<Vector3d, n>& gradient,
                     const Blocks<n>& second) {
  const double scale = spring.constant / (spring.rest * spring.rest);
  Blocks<n> blocks;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      blocks[i][j] =
          scale * (gradient[i] * gradient[j].transpose() + (measure - spring.rest) * second[i][j]);
    }
  }
  return blocks;
}

template <std::size_t n>
Blocks<n> nothing() {
  Blocks<n> blocks;
  for (auto& row : blocks) {
    row.fill(Matrix3d::Zero());
  }
  return blocks;
}

/// Second derivatives of a triangle's area.
Blocks<3> area_second(const Points3& p) {
  const Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]);
  const double size = normal.norm();
  Blocks<3> second = nothing<3>();
  if (size == 0) {
    return second;
  }
  const Vector3d unit = normal / size;
  const Matrix3d turn = (Matrix3d::Identity() - unit * unit.transpose()) / size;
  const Matrix3d side = cross_with(unit);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d opposite_i = p[(i + 1) % 3] - p[(i + 2) % 3];
    for (std::size_t j = 0; j < 3; ++j) {
      const Vector3d opposite_j = p[(j + 1) % 3] - p[(j + 2) % 3];
      second[i][j] = -0.5 * cross_with(opposite_i) * turn * cross_with(opposite_j);
      if (j == (i + 1) % 3) {
        second[i][j] -= 0.5 * side;
      }
      if (j == (i + 2) % 3) {
        second[i][j] += 0.5 * side;
      }
    }
  }
  return second;
}

/// Second derivatives of a tetrahedron's volume.
Blocks<4> volume_second(const Points4& p) {
  const std::array<Vector3d, 3> edge{p[1] - p[0], p[2] - p[0], p[3] - p[0]};
  Blocks<4> second = nothing<4>();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    second[i + 1][j + 1] = -cross_with(edge[k]) / 6;
    second[i + 1][k + 1] = cross_with(edge[j]) / 6;
  }
  // Moving point 0 is moving the other three back.
  for (std::size_t i = 1; i < 4; ++i) {
    for (std::size_t j = 1; j < 4; ++j) {
      second[i][0] -= second[i][j];
      second[0][j] -= second[i][j];
      second[0][0] += second[i][j];
    }
  }
  return second;
}

}  // namespace

Blocks<2> length_hessian(const Spring& spring, const Points2& points) {
  const Vector3d along = points[1] - points[0];
  const double length = along.norm();
  Blocks<2> blocks = nothing<2>();
  if (length == 0) {
    return blocks;
  }
  const Vector3d unit = along / length;
  const double scale = spring.constant / (spring.rest * spring.rest);
  const double shrunk = spring.rest / length;
  const Matrix3d block = scale * ((1 - shrunk) * Matrix3d::Identity() +  //
                                  shrunk * unit * unit.transpose());
  blocks[0][0] = blocks[1][1] = block;
  blocks[0][1] = blocks[1][0] = -block;
  return blocks;
}

Blocks<3> area_hessian(const Spring& spring, const Points3& points) {
  return of_measure(spring, area_of(points), area_gradient(points), area_second(points));
}

Blocks<4> volume_hessian(const Spring& spring, const Points4& points) {
  return of_measure(spring, volume_of(points), volume_gradient(points), volume_second(points));
}

SpringHessian::SpringHessian(const SpringBody& body)
    : matrix_(pattern_of(body.parts.edges, body.rest.size())) {
  for (std::size_t e = 0; e < body.parts.edges.size(); ++e) {
    edge_block_.push_back(static_cast<std::int32_t>(e) + body.parts.edges[e][0] + 1);
  }
  const PartIndex index(body.parts);
  for (const Face& f : body.parts.faces) {
    face_edges_.push_back({index.edge(f[0], f[1]), index.edge(f[0], f[2]), index.edge(f[1], f[2])});
  }
  for (const geometry::Tetrahedron& t : body.tetrahedra) {
    tetrahedron_edges_.push_back({index.edge(t[0], t[1]), index.edge(t[0], t[2]),
                                  index.edge(t[0], t[3]), index.edge(t[1], t[2]),
                                  index.edge(t[1], t[3]), index.edge(t[2], t[3])});
  }
}

template <std::size_t n>
void SpringHessian::add(const std::array<std::int32_t, n>& vertices, const Blocks<n>& blocks,
                        std::span<const std::int32_t> edges) {
  std::size_t next = 0;
  for (std::size_t i = 0; i < n; ++i) {
    Block(matrix_.block(matrix_.row_start(static_cast<std::size_t>(vertices[i])))) += blocks[i][i];
    for (std::size_t j = i + 1; j < n; ++j) {
      const bool ascending = vertices[i] < vertices[j];
      Block(matrix_.block(edge_block_[static_cast<std::size_t>(edges[next++])])) +=
          ascending ? blocks[i][j] : blocks[j][i];
    }
  }
}

void SpringHessian::assemble(const SpringBody& body, std::span<const Vector3d> positions) {
  matrix_.set_zero();
  for (std::size_t i = 0; i < body.lengths.size(); ++i) {
    const Edge& edge = body.parts.edges[i];
    const std::array<std::int32_t, 1> self{static_cast<std::int32_t>(i)};
    add(edge,
        length_hessian({body.constants.length[i], body.lengths[i]}, points_of(positions, edge)),
        self);
  }
  for (std::size_t i = 0; i < body.areas.size(); ++i) {
    const Face& face = body.parts.faces[i];
    add(face, area_hessian({body.constants.area[i], body.areas[i]}, points_of(positions, face)),
        face_edges_[i]);
  }
  for (std::size_t i = 0; i < body.volumes.size(); ++i) {
    const geometry::Tetrahedron& t = body.tetrahedra[i];
    add(t, volume_hessian({body.constants.volume[i], body.volumes[i]}, points_of(positions, t)),
        tetrahedron_edges_[i]);
  }
}

}  // namespace haptrial::deformable
