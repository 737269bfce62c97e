#include "core/deformable/elements/elastic_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/deformable/body/load_case.h"
#include "core/deformable/elements/tet_laws.h"

namespace haptrial::deformable {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A tetrahedron at rest, its corners in the order of PatchLayout::corners.
struct RestTet {
  Matrix3d inverse;  // of the edges from its first corner, as columns [1/m]
  double volume;     // > 0 [m³]

  TetGradients gradients() const {
    TetGradients b;
    b.rightCols<3>() = inverse.transpose();
    b.col(0) = -inverse.colwise().sum().transpose();
    return b;
  }
};

/// Room for one patch, used again for the next.
struct PatchRoom {
  std::vector<Vector3d> moved;   // u of the patch's vertices
  std::vector<Vector3d> volume;  // d(volume strain sum) / du
  std::vector<Vector3d> forces;
  std::vector<double> blocks;  // 9 each, as BlockMatrix::places
};

template <class Function>
decltype(auto) with_law(Law law, Function&& function) {
  switch (law) {
    case Law::kLinear:
      return function.template operator()<Law::kLinear>();
    case Law::kCorotational:
      return function.template operator()<Law::kCorotational>();
    default:
      return function.template operator()<Law::kNeoHookean>();
  }
}

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

}  // namespace

std::vector<double> densities(const Elasticity& elasticity, std::size_t tetrahedra) {
  std::vector<double> all(tetrahedra, elasticity.materials.at(0).density);
  for (std::size_t t = 0; t < elasticity.material_of.size() && t < tetrahedra; ++t) {
    all[t] = elasticity.materials.at(elasticity.material_of[t]).density;
  }
  return all;
}

struct ElasticBody::Impl {
  geometry::TetMesh mesh;
  Elasticity elasticity;
  PatchLayout layout;
  std::vector<RestTet> rest;      // in the layout's order
  std::vector<double> volume;     // by patch [m³]
  std::vector<Moduli> moduli_of;  // by patch
  std::vector<double> masses;     // by vertex
  double rounding{};
  std::size_t most_vertices{};  // of a patch
  std::size_t most_tets{};

  void prepare();
  Matrix3d displacement_gradient(std::size_t tet, const std::vector<Vector3d>& moved) const;
  void gather(std::size_t patch, const Vectors& u, PatchRoom& room) const;
  template <Law law>
  bool read_patch(std::size_t patch, const PatchRoom& room, std::vector<TetLaw<law>>& laws,
                  double& theta) const;
  template <Law law>
  void add_forces(std::size_t patch, const std::vector<TetLaw<law>>& laws, double pressure,
                  PatchRoom& room) const;
  template <Law law>
  void add_stiffness(std::size_t patch, const std::vector<TetLaw<law>>& laws, double pressure,
                     PatchRoom& room, BlockMatrix& matrix) const;
  template <Law law>
  double evaluate(const Vectors& u, Vectors* forces, BlockMatrix* matrix) const;
};

void ElasticBody::Impl::prepare() {
  const std::size_t patches = layout.patches();
  rest.resize(mesh.tetrahedra.size());
  volume.assign(patches, 0);
  moduli_of.resize(patches);
  masses.assign(mesh.vertices.size(), 0);
  std::vector<double> force_scale(mesh.vertices.size(), 0);
  for (std::size_t p = 0; p < patches; ++p) {
    const std::int32_t first = layout.first_vertex[p];
    most_vertices = std::max(most_vertices, index(layout.first_vertex[p + 1] - first));
    most_tets = std::max(most_tets, index(layout.first_tet[p + 1] - layout.first_tet[p]));
    const std::size_t some = index(layout.tets[index(layout.first_tet[p])]);
    const Material& material =
        elasticity.materials[elasticity.material_of.empty() ? 0 : elasticity.material_of[some]];
    moduli_of[p] = moduli(material);
    for (std::size_t t = index(layout.first_tet[p]); t < index(layout.first_tet[p + 1]); ++t) {
      const auto vertex = [&](std::size_t corner) {
        return index(layout.vertices[index(first) + layout.corners[t][corner]]);
      };
      Matrix3d edges;
      for (int i = 0; i < 3; ++i) {
        edges.col(i) = mesh.vertices[vertex(index(i) + 1)] - mesh.vertices[vertex(0)];
      }
      rest[t] = {edges.inverse(), std::abs(edges.determinant()) / 6};
      volume[p] += rest[t].volume;
      const TetGradients b = rest[t].gradients();
      for (std::size_t c = 0; c < 4; ++c) {
        masses[vertex(c)] += 0.25 * material.density * rest[t].volume;
        force_scale[vertex(c)] += (2 * moduli_of[p].shear + moduli_of[p].bulk) * rest[t].volume *
                                  b.col(static_cast<int>(c)).norm();
      }
    }
  }
  double squares = 0;
  for (const double scale : force_scale) {
    squares += scale * scale;
  }
  rounding = std::numeric_limits<double>::epsilon() * std::sqrt(squares);
}

Matrix3d ElasticBody::Impl::displacement_gradient(std::size_t tet,
                                                  const std::vector<Vector3d>& moved) const {
  const auto& corners = layout.corners[tet];
  Matrix3d edges;
  for (int i = 0; i < 3; ++i) {
    edges.col(i) = moved[corners[index(i) + 1]] - moved[corners[0]];
  }
  return edges * rest[tet].inverse;
}

void ElasticBody::Impl::gather(std::size_t patch, const Vectors& u, PatchRoom& room) const {
  room.moved.clear();
  for (auto i = layout.first_vertex[patch]; i < layout.first_vertex[patch + 1]; ++i) {
    room.moved.push_back(u[index(layout.vertices[index(i)])]);
  }
}

/// @returns false if a tetrahedron is inverted.
template <Law law>
bool ElasticBody::Impl::read_patch(std::size_t patch, const PatchRoom& room,
                                   std::vector<TetLaw<law>>& laws, double& theta) const {
  laws.clear();
  theta = 0;
  for (auto t = index(layout.first_tet[patch]); t < index(layout.first_tet[patch + 1]); ++t) {
    laws.emplace_back(displacement_gradient(t, room.moved));
    if (laws.back().inverted) {
      return false;
    }
    theta += rest[t].volume * laws.back().theta;
  }
  theta /= volume[patch];
  return true;
}

template <Law law>
void ElasticBody::Impl::add_forces(std::size_t patch, const std::vector<TetLaw<law>>& laws,
                                   double pressure, PatchRoom& room) const {
  const std::size_t first = index(layout.first_tet[patch]);
  const double mu = moduli_of[patch].shear;
  room.forces.assign(room.moved.size(), Vector3d::Zero());
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const RestTet& tet = rest[first + i];
    const auto& corners = layout.corners[first + i];
    const Matrix3d stress = laws[i].stress(mu) + pressure * laws[i].volume_gradient();
    const Matrix3d pull = -tet.volume * stress * tet.inverse.transpose();
    for (int c = 0; c < 3; ++c) {
      room.forces[corners[index(c) + 1]] += pull.col(c);
    }
    room.forces[corners[0]] -= pull.rowwise().sum();
  }
}

template <Law law>
void ElasticBody::Impl::add_stiffness(std::size_t patch, const std::vector<TetLaw<law>>& laws,
                                      double pressure, PatchRoom& room, BlockMatrix& matrix) const {
  const std::size_t first = index(layout.first_tet[patch]);
  const std::size_t n = room.moved.size();
  const auto at = [n](std::size_t a, std::size_t b) {
    return 9 * (a * n - a * (a + 1) / 2 + b);  // a <= b
  };
  room.volume.assign(n, Vector3d::Zero());
  room.blocks.assign(9 * n * (n + 1) / 2, 0.0);
  TetBlocks blocks;
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const RestTet& tet = rest[first + i];
    const auto& corners = layout.corners[first + i];
    const TetGradients b = tet.gradients();
    const TetGradients volumes = tet.volume * laws[i].volume_gradient() * b;
    laws[i].set_blocks(b, moduli_of[patch].shear, pressure, tet.volume, blocks);
    std::size_t block = 0;
    for (std::size_t a = 0; a < 4; ++a) {
      room.volume[corners[a]] += volumes.col(static_cast<int>(a));
      for (std::size_t c = a; c < 4; ++c) {
        Eigen::Map<Matrix3d>(room.blocks.data() + at(corners[a], corners[c])) += blocks[block++];
      }
    }
  }
  const double bulk = moduli_of[patch].bulk / volume[patch];
  const double* from = room.blocks.data();
  const std::int32_t* place = matrix.places(patch).data();
  for (std::size_t a = 0; a < n; ++a) {
    const Vector3d left = bulk * room.volume[a];
    for (std::size_t b = a; b < n; ++b, from += 9) {
      Eigen::Map<Matrix3d>(matrix.block(*place++)) +=
          Eigen::Map<const Matrix3d>(from) + left * room.volume[b].transpose();
    }
  }
}

template <Law law>
double ElasticBody::Impl::evaluate(const Vectors& u, Vectors* forces, BlockMatrix* matrix) const {
  if (forces != nullptr) {
    forces->assign(u.size(), Vector3d::Zero());
  }
  if (matrix != nullptr) {
    matrix->set_zero();
  }
  PatchRoom room;
  std::vector<TetLaw<law>> laws;
  laws.reserve(most_tets);
  double energy = 0;
  for (std::size_t p = 0; p < layout.patches(); ++p) {
    gather(p, u, room);
    double theta = 0;
    if (!read_patch<law>(p, room, laws, theta)) {
      return kInfinite;
    }
    const Moduli& m = moduli_of[p];
    energy += 0.5 * m.bulk * theta * theta * volume[p];
    for (std::size_t i = 0; i < laws.size(); ++i) {
      energy += rest[index(layout.first_tet[p]) + i].volume * laws[i].energy(m.shear);
    }
    if (forces == nullptr) {
      continue;
    }
    add_forces<law>(p, laws, m.bulk * theta, room);
    for (std::size_t i = 0; i < room.forces.size(); ++i) {
      (*forces)[index(layout.vertices[index(layout.first_vertex[p]) + i])] += room.forces[i];
    }
    if (matrix != nullptr) {
      add_stiffness<law>(p, laws, m.bulk * theta, room, *matrix);
    }
  }
  return energy;
}

ElasticBody::ElasticBody(const geometry::TetMesh& mesh, Elasticity elasticity)
    : impl_(std::make_unique<Impl>()) {
  check_body(mesh, "body");
  for (std::size_t i = 0; i < elasticity.materials.size(); ++i) {
    check_material(elasticity.materials[i], fmt::format("material {}", i));
  }
  const auto& of = elasticity.material_of;
  if (elasticity.materials.empty() || (!of.empty() && of.size() != mesh.tetrahedra.size())) {
    throw InputError(fmt::format("{} materials and {} material numbers for {} tetrahedra",
                                 elasticity.materials.size(), of.size(), mesh.tetrahedra.size()));
  }
  for (std::size_t t = 0; t < of.size(); ++t) {
    if (of[t] >= elasticity.materials.size()) {
      throw InputError(fmt::format("tetrahedron {} has the material {}; there are 0 to {}", t,
                                   of[t], elasticity.materials.size() - 1));
    }
  }
  impl_->mesh = mesh;
  impl_->elasticity = std::move(elasticity);
  const auto& tets = impl_->mesh.tetrahedra;
  impl_->layout = patch_layout(
      tets, volume_patches(tets, impl_->elasticity.material_of, impl_->elasticity.volume));
  impl_->prepare();
}

ElasticBody::~ElasticBody() = default;
ElasticBody::ElasticBody(ElasticBody&&) noexcept = default;

const geometry::TetMesh& ElasticBody::mesh() const { return impl_->mesh; }
const Elasticity& ElasticBody::elasticity() const { return impl_->elasticity; }
const PatchLayout& ElasticBody::patches() const { return impl_->layout; }
std::span<const double> ElasticBody::masses() const { return impl_->masses; }
double ElasticBody::rounding_force() const { return impl_->rounding; }

std::int32_t ElasticBody::inverted(const Vectors& u) const {
  std::int32_t first = -1;
  PatchRoom room;
  for (std::size_t p = 0; p < impl_->layout.patches(); ++p) {
    impl_->gather(p, u, room);
    for (auto t = index(impl_->layout.first_tet[p]); t < index(impl_->layout.first_tet[p + 1]);
         ++t) {
      if (volume_change(impl_->displacement_gradient(t, room.moved)) > -1) {
        continue;
      }
      const std::int32_t tet = impl_->layout.tets[t];
      first = first < 0 ? tet : std::min(first, tet);
    }
  }
  return first;
}

double ElasticBody::energy(const Vectors& u) const {
  return with_law(impl_->elasticity.law,
                  [&]<Law law>() { return impl_->evaluate<law>(u, nullptr, nullptr); });
}

double ElasticBody::forces(const Vectors& u, Vectors& forces) const {
  return with_law(impl_->elasticity.law,
                  [&]<Law law>() { return impl_->evaluate<law>(u, &forces, nullptr); });
}

double ElasticBody::stiffness(const Vectors& u, Vectors& forces, BlockMatrix& stiffness) const {
  return with_law(impl_->elasticity.law,
                  [&]<Law law>() { return impl_->evaluate<law>(u, &forces, &stiffness); });
}

std::vector<TetState> ElasticBody::states(const Vectors& u) const {
  const Law kind = impl_->elasticity.law;
  return with_law(kind, [&]<Law law>() {
    std::vector<TetState> states(impl_->rest.size());
    PatchRoom room;
    std::vector<TetLaw<law>> laws;
    for (std::size_t p = 0; p < impl_->layout.patches(); ++p) {
      impl_->gather(p, u, room);
      double theta = 0;
      if (!impl_->read_patch<law>(p, room, laws, theta)) {
        throw InputError(fmt::format("tetrahedron {} is inverted", inverted(u)));
      }
      const std::size_t first = index(impl_->layout.first_tet[p]);
      for (std::size_t i = 0; i < laws.size(); ++i) {
        const Matrix3d f =
            Matrix3d::Identity() + impl_->displacement_gradient(first + i, room.moved);
        const Matrix3d piola = laws[i].stress(impl_->moduli_of[p].shear) +
                               impl_->moduli_of[p].bulk * theta * laws[i].volume_gradient();
        const Matrix3d cauchy =
            law == Law::kLinear ? piola : (piola * f.transpose() / f.determinant()).eval();
        states[index(impl_->layout.tets[first + i])] = {f, cauchy};
      }
    }
    return states;
  });
}

std::vector<double> ElasticBody::volume_strains(const Vectors& u) const {
  return with_law(impl_->elasticity.law, [&]<Law law>() {
    std::vector<double> strains(impl_->layout.patches());
    PatchRoom room;
    std::vector<TetLaw<law>> laws;
    for (std::size_t p = 0; p < strains.size(); ++p) {
      impl_->gather(p, u, room);
      impl_->read_patch<law>(p, room, laws, strains[p]);
    }
    return strains;
  });
}

}  // namespace haptrial::deformable
