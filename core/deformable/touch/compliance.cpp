#include "core/deformable/touch/compliance.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <utility>

#include "core/deformable/elements/volume_patches.h"
#include "core/deformable/touch/condense.h"
#include "core/geometry/mesh/mesh.h"

namespace haptrial::deformable {

using Eigen::Vector3d;

namespace {

constexpr std::size_t kMostSampled = 64;   // places where stiffness is bounded
constexpr std::size_t kMostInPatch = 200;  // vertices that a ball may reach

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

/// The places of each touched vertex and of those whose elements' volume is kept with theirs; -1:
/// none.
struct Numbers {
  std::vector<std::int32_t> place;     // by vertex
  std::vector<std::int32_t> vertices;  // by place
  std::size_t touched{0};

  Numbers(const HapticMesh& mesh, const PatchLayout& layout)
      : place(mesh.tets.vertices.size(), -1) {
    for (const Face& face : mesh.felt) {
      std::ranges::for_each(face, [&](std::int32_t v) { take(v); });
    }
    touched = vertices.size();
    const std::vector<std::int32_t> top = place;
    for (std::size_t p = 0; p < layout.patches(); ++p) {
      const auto own = std::span(layout.vertices)
                           .subspan(index(layout.first_vertex[p]),
                                    index(layout.first_vertex[p + 1] - layout.first_vertex[p]));
      if (std::ranges::any_of(own, [&](std::int32_t v) { return top[index(v)] >= 0; })) {
        std::ranges::for_each(own, [&](std::int32_t v) { take(v); });
      }
    }
  }

 private:
  void take(std::int32_t v) {
    if (place[index(v)] < 0) {
      place[index(v)] = static_cast<std::int32_t>(vertices.size());
      vertices.push_back(v);
    }
  }
};

}  // namespace

Compliance::Compliance(SharedHapticMesh mesh, const Tissue& tissue) : mesh_(std::move(mesh)) {
  const ElasticBody body(mesh_->tets, elasticity_of(*mesh_, tissue));
  number_places(body.patches());
  invert(body);
}

void Compliance::number_places(const PatchLayout& layout) {
  const Numbers numbers(*mesh_, layout);
  touched_ = numbers.touched;
  vertices_ = numbers.vertices;
  geometry::Mesh surface;
  for (const std::int32_t v : vertices_) {
    rest_.push_back(mesh_->tets.vertices[index(v)]);
  }
  surface.vertices.assign(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(touched_));
  for (const Face& face : mesh_->felt) {
    faces_.push_back({numbers.place[index(face[0])], numbers.place[index(face[1])],
                      numbers.place[index(face[2])]});
    surface.triangles.push_back({faces_.back()[0], faces_.back()[1], faces_.back()[2]});
  }
  surface_ = std::make_unique<contact::ContactSurface>(surface, 1);
  std::vector<std::vector<std::int32_t>> at(touched_);
  for (const geometry::Tetrahedron& t : mesh_->tets.tetrahedra) {
    geometry::Tetrahedron placed{};
    bool outer = false;
    for (std::size_t i = 0; i < 4; ++i) {
      placed[i] = numbers.place[index(t[i])];
      outer = outer || (placed[i] >= 0 && index(placed[i]) < touched_);
    }
    for (std::size_t i = 0; outer && i < 4; ++i) {
      if (index(placed[i]) < touched_) {
        at[index(placed[i])].push_back(static_cast<std::int32_t>(outer_tets_.size()));
      }
    }
    if (outer) {
      outer_tets_.push_back(placed);
    }
  }
  first_tet_.push_back(0);
  for (const auto& own : at) {
    tets_.insert(tets_.end(), own.begin(), own.end());
    first_tet_.push_back(static_cast<std::int32_t>(tets_.size()));
  }
}

std::span<const std::int32_t> Compliance::tets_at(std::int32_t place) const noexcept {
  const std::int32_t first = first_tet_[index(place)];
  return std::span(tets_).subspan(index(first), index(first_tet_[index(place) + 1] - first));
}

void Compliance::invert(const ElasticBody& body) {
  BlockMatrix stiffness(body.patches().groups(), mesh_->tets.vertices.size());
  Vectors none(mesh_->tets.vertices.size(), Vector3d::Zero());
  Vectors forces;
  body.stiffness(none, forces, stiffness);
  std::vector<std::int32_t> outer, below;          // vertices that are not held
  std::vector<std::int32_t> column(places(), -1);  // of the inverse; by place, each from 0
  for (std::size_t p = 0; p < places(); ++p) {
    if (mesh_->held[index(vertices_[p])] == 0) {
      std::vector<std::int32_t>& part = p < touched_ ? outer : below;
      column[p] = static_cast<std::int32_t>(part.size());
      part.push_back(vertices_[p]);
    }
  }
  const SurfaceInverse inverse =
      surface_inverse(stiffness, mesh_->tets.vertices, mesh_->held, outer, below);
  blocks_.resize(places() * touched_);
  for (std::size_t row = 0; row < places(); ++row) {
    const Eigen::MatrixXf& part = row < touched_ ? inverse.outer : inverse.below;
    for (std::size_t col = 0; col < touched_; ++col) {
      Block& block = blocks_[row * touched_ + col];
      block = {};
      for (std::size_t k = 0; k < 9 && column[row] >= 0 && column[col] >= 0; ++k) {
        block[k % 3 + 4 * (k / 3)] = part(3 * column[row] + static_cast<Eigen::Index>(k % 3),
                                          3 * column[col] + static_cast<Eigen::Index>(k / 3));
      }
    }
  }
}

double Compliance::stiffest_at(std::int32_t centre, double radius) const {
  std::vector<std::int32_t> patch;
  for (std::size_t p = 0; p < touched_; ++p) {
    if ((rest_[p] - rest(centre)).norm() <= radius || std::cmp_equal(p, centre)) {
      patch.push_back(static_cast<std::int32_t>(p));
    }
  }
  if (patch.size() > kMostInPatch || std::ranges::any_of(patch, [&](std::int32_t p) {
        return mesh_->held[index(vertex(p))] != 0;
      })) {
    return std::numeric_limits<double>::infinity();
  }
  const auto n = static_cast<Eigen::Index>(patch.size());
  Eigen::MatrixXd all(3 * n, 3 * n);
  Eigen::MatrixXd together(3 * n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    together.middleRows<3>(3 * i).setIdentity();
    for (Eigen::Index j = 0; j < n; ++j) {
      for (int axis = 0; axis < 3; ++axis) {
        all.block<3, 1>(3 * i, 3 * j + axis) =
            response(patch[static_cast<std::size_t>(i)], patch[static_cast<std::size_t>(j)],
                     Eigen::Vector3f::Unit(axis))
                .cast<double>();
      }
    }
  }
  const Eigen::Matrix3d k =
      together.transpose() * all.selfadjointView<Eigen::Lower>().ldlt().solve(together);
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(k).eigenvalues().maxCoeff();
}

std::shared_ptr<const SurfaceSamples> Compliance::samples(int steps) const {
  const std::lock_guard guard(samples_lock_);
  std::shared_ptr<const SurfaceSamples>& known = samples_[steps];
  if (!known) {
    known = std::make_shared<const SurfaceSamples>(faces_, rest_, steps);
  }
  return known;
}

double Compliance::stiffest(double radius) const {
  double most = 0.0;
  const std::size_t step = std::max<std::size_t>(1, touched_ / kMostSampled);
  for (std::size_t p = 0; p < touched_; p += step) {
    most = std::max(most, stiffest_at(static_cast<std::int32_t>(p), radius));
  }
  return most;
}

ComplianceMemory compliance_memory(const HapticMesh& mesh) {
  const Numbers numbers(
      mesh, patch_layout(mesh.tets.tetrahedra,
                         volume_patches(mesh.tets.tetrahedra, {}, VolumeForm::kPatches)));
  const auto outer = 3.0 * static_cast<double>(numbers.touched);
  const auto below = 3.0 * static_cast<double>(numbers.vertices.size() - numbers.touched);
  const double kept = (outer + below) / 3.0 * outer / 3.0 * sizeof(Compliance::Block);
  // Dense matrices of surface_inverse(), and the fronts of half the body beside them.
  const double whole = (outer + below) * (outer + below) * sizeof(double);
  return {kept, kept + 3.0 * whole};
}

}  // namespace haptrial::deformable
