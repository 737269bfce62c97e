#include "analysis/contact/exam/soft_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "core/base/error.h"
#include "core/deformable/elements/setup_body.h"

namespace haptrial::evaluation {
namespace {

using deformable::Material;
using deformable::NodalForce;
using Eigen::Vector3d;

constexpr int kFixed = 1, kGripped = 2;  // markers

/// The number of a material among those of the body, which are few.
std::uint8_t number_of(const Material& material, std::vector<Material>& materials,
                       const std::filesystem::path& file) {
  const auto same = [&](const Material& m) {
    return m.young == material.young && m.poisson == material.poisson &&
           m.density == material.density;
  };
  const auto found = std::ranges::find_if(materials, same);
  const auto number = found - materials.begin();
  if (found == materials.end()) {
    if (number > UINT8_MAX) {
      throw InputError(
          fmt::format("{}: more than {} materials; fewer are allowed", file.string(), number));
    }
    materials.push_back(material);
  }
  return static_cast<std::uint8_t>(number);
}

void read_node(std::int32_t v, const std::vector<double>& row, const std::filesystem::path& file,
               SoftBody& body) {
  if (row.size() != 4) {
    throw InputError(fmt::format(
        "{}: vertex {} has {} numbers behind its place; allowed: 4, its force and a marker",
        file.string(), v, row.size()));
  }
  const Vector3d force(row[0], row[1], row[2]);
  if (!force.isZero(0.0)) {
    body.forces.push_back({v, force});
  }
  if (row[3] == kFixed) {
    body.fixed.push_back(v);
  } else if (row[3] == kGripped) {
    body.gripped.push_back(v);
  } else if (row[3] != 0.0) {
    throw InputError(
        fmt::format("{}: vertex {} has the marker {}; allowed: 0, 1 (fixed) and 2 (gripped)",
                    file.string(), v, row[3]));
  }
}

}  // namespace

deformable::LoadCase load_case_of(const SoftBody& body, const Vector3d& tool, double load) {
  deformable::LoadCase one{"exam", {}, {}};
  for (const std::int32_t v : body.fixed) {
    one.holds.push_back({v, Vector3d::Zero()});
  }
  for (const std::int32_t v : body.gripped) {
    one.holds.push_back({v, tool});
  }
  for (const NodalForce& f : body.forces) {
    one.forces.push_back({f.vertex, load * f.force});
  }
  return one;
}

std::string node_text(const SoftBody& body) {
  const std::size_t n = body.mesh.vertices.size();
  std::vector<int> marker(n, 0);
  std::vector<Vector3d> force(n, Vector3d::Zero());
  for (const std::int32_t v : body.fixed) {
    marker[static_cast<std::size_t>(v)] = kFixed;
  }
  for (const std::int32_t v : body.gripped) {
    marker[static_cast<std::size_t>(v)] = kGripped;
  }
  for (const NodalForce& f : body.forces) {
    force[static_cast<std::size_t>(f.vertex)] += f.force;
  }
  std::string text = fmt::format("{} 3 3 1\n", n);
  for (std::size_t v = 0; v < n; ++v) {
    const Vector3d &p = body.mesh.vertices[v], &f = force[v];
    fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {} {} {}\n", v, p.x(), p.y(), p.z(),
                   f.x(), f.y(), f.z(), marker[v]);
  }
  return text;
}

std::string element_text(const SoftBody& body) {
  const auto& e = body.elasticity;
  std::string text = fmt::format("{} 4 3\n", body.mesh.tetrahedra.size());
  for (std::size_t i = 0; i < body.mesh.tetrahedra.size(); ++i) {
    const geometry::Tetrahedron& t = body.mesh.tetrahedra[i];
    const Material& m = e.materials[e.material_of.empty() ? 0 : e.material_of[i]];
    fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {} {} {}\n", i, t[0], t[1], t[2], t[3],
                   m.young, m.poisson, m.density);
  }
  return text;
}

SoftBody read_soft_body(const std::filesystem::path& node_file) {
  SoftBody body;
  deformable::TetgenColumns columns;
  body.mesh = deformable::read_tetgen(node_file, 1.0, &columns);
  for (std::size_t v = 0; v < columns.nodes.size(); ++v) {
    read_node(static_cast<std::int32_t>(v), columns.nodes[v], node_file, body);
  }
  body.elasticity.materials.clear();
  for (const std::vector<double>& row : columns.tetrahedra) {
    if (row.size() != 3) {
      throw InputError(fmt::format(
          "{}: a tetrahedron has {} numbers behind its corners; allowed: 3, Young's modulus, "
          "Poisson's ratio and density",
          std::filesystem::path(node_file).replace_extension(".ele").string(), row.size()));
    }
    const Material material{row[0], row[1], row[2]};
    deformable::check_material(material, node_file.string());
    body.elasticity.material_of.push_back(
        number_of(material, body.elasticity.materials, node_file));
  }
  return body;
}

}  // namespace haptrial::evaluation
