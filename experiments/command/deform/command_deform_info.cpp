#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>

#include "core/base/error.h"
#include "core/deformable/body/fastest_vibration.h"
#include "core/deformable/springs/spring_tangent.h"
#include "experiments/command/arguments.h"
#include "experiments/command/deform/deform_body.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

struct DeformInfoOptions {
  DeformInput input;
  std::optional<int> resolution;
  std::optional<double> scale;
  std::vector<double> constants;
};

using Eigen::Vector3d;
using geometry::TetMesh;
using geometry::Tetrahedron;

constexpr int kResolution = 20;
constexpr double kScale = 1.0;  // [m]
constexpr double kFlat = 1e-6;  // six volumes, of the longest edge's cube, as check_body()

/// One tetrahedron's shape.
struct Shape {
  double volume;   // signed [m³]
  double longest;  // edge [m]
  double quality;  // three times the inscribed radius over the circumscribed one; 1: regular
  double angle;    // the least between two faces [rad]
};

Shape shape_of(const TetMesh& mesh, const Tetrahedron& t) {
  std::array<Vector3d, 4> p;
  for (std::size_t i = 0; i < p.size(); ++i) {
    p[i] = mesh.vertices[static_cast<std::size_t>(t[i])];
  }
  const Vector3d a = p[1] - p[0], b = p[2] - p[0], c = p[3] - p[0];
  Shape shape{a.dot(b.cross(c)) / 6.0, 0.0, 0.0, std::numbers::pi};
  std::array<Vector3d, 4> normals;  // outwards, twice as long as the faces are large
  normals[0] = (p[2] - p[1]).cross(Vector3d(p[3] - p[1]));
  normals[1] = c.cross(b);
  normals[2] = a.cross(c);
  normals[3] = b.cross(a);
  double faces = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    faces += 0.5 * normals[i].norm();
    for (std::size_t j = 0; j < i; ++j) {
      shape.longest = std::max(shape.longest, (p[i] - p[j]).norm());
      const double cosine = -normals[i].normalized().dot(normals[j].normalized());
      shape.angle = std::min(shape.angle, std::acos(std::clamp(cosine, -1.0, 1.0)));
    }
  }
  const double inner = 3.0 * std::abs(shape.volume) / faces;
  const Vector3d towards =
      a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) + c.squaredNorm() * a.cross(b);
  const double outer = towards.norm() / (12.0 * std::abs(shape.volume));
  shape.quality = outer > 0.0 && std::isfinite(outer) ? 3.0 * inner / outer : 0.0;
  return shape;
}

/// Prints the shapes of the tetrahedra.
bool print_shapes(const TetMesh& mesh) {
  double volume = 0.0, angle = std::numbers::pi;
  std::size_t inverted = 0, flat = 0, first_bad = mesh.tetrahedra.size();
  std::vector<double> qualities;
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    const Shape shape = shape_of(mesh, mesh.tetrahedra[i]);
    const double limit = kFlat * std::pow(shape.longest, 3) / 6.0;
    inverted += shape.volume < -limit ? 1 : 0;
    flat += std::abs(shape.volume) <= limit ? 1 : 0;
    if (shape.volume <= limit) {
      first_bad = std::min(first_bad, i);
    }
    volume += shape.volume;
    angle = std::min(angle, shape.angle);
    qualities.push_back(shape.quality);
  }
  std::sort(qualities.begin(), qualities.end());
  fmt::print(
      "quality     {:.3f} at least, {:.3f} in the middle (regular: 1); angles of faces from "
      "{:.1f} degrees on\n",
      qualities.front(), qualities[qualities.size() / 2], angle * 180.0 / std::numbers::pi);
  fmt::print("inverted    {}, flat {}", inverted, flat);
  fmt::print("{}\n", first_bad < mesh.tetrahedra.size()
                         ? fmt::format(": first tetrahedron {}", first_bad)
                         : "");
  fmt::print("volume      {:.6g} m3\n", volume);
  return inverted + flat == 0;
}

void print_counts(const TetMesh& mesh) {
  const auto parts = deformable::mesh_parts(mesh.tetrahedra);
  const auto connected = deformable::connected_parts(mesh.tetrahedra, mesh.vertices.size());
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : mesh.vertices) {
    box.extend(p);
  }
  const Vector3d size = box.sizes();
  fmt::print("mesh        {} tetrahedra, {} vertices, {} edges, {} faces, {} of them outside\n",
             mesh.tetrahedra.size(), mesh.vertices.size(), parts.edges.size(), parts.faces.size(),
             parts.surface.size());
  fmt::print("size        {:.6g} x {:.6g} x {:.6g} m from ({:.6g}, {:.6g}, {:.6g})\n", size.x(),
             size.y(), size.z(), box.min().x(), box.min().y(), box.min().z());
  const auto count = *std::max_element(connected.begin(), connected.end()) + 1;
  fmt::print("parts       {}\n", count);
}

void print_memory(const TetMesh& mesh) {
  constexpr double kMegabyte = 1e6;
  const auto needs = [&](deformable::LinearSolver solver) {
    return deformable::static_memory(mesh.vertices.size(), mesh.tetrahedra.size(), solver) /
           kMegabyte;
  };
  fmt::print("memory      {:.3g} MB for statics by conjugate gradients, {:.3g} MB by Cholesky\n",
             needs(deformable::LinearSolver::kConjugateGradients),
             needs(deformable::LinearSolver::kCholesky));
}

/// Prints mass and the longest step of elements at rest with lumped masses, as an explicit method
/// would need it.
void print_material(const DeformBody& body) {
  const deformable::ElasticBody elastic(body.mesh, body.elasticity);
  double mass = 0.0;
  for (const double m : elastic.masses()) {
    mass += m;
  }
  fmt::print("materials   {}\nmass        {:.6g} kg\n", body.setup.materials.size(), mass);
  deformable::BlockMatrix stiffness(elastic.patches().groups(), body.mesh.vertices.size());
  deformable::Vectors forces;
  elastic.stiffness(deformable::Vectors(body.mesh.vertices.size(), Vector3d::Zero()), forces,
                    stiffness);
  fmt::print("step        {:.3g} s at most for elements, explicitly\n",
             2.0 / deformable::fastest_vibration(stiffness, elastic.masses()));
}

void print_springs(const DeformBody& body, const std::vector<double>& constants) {
  for (const double constant : constants) {
    checked_real("--springs", constant, 0.0, 1e30);
  }
  if (std::ranges::count(constants, 0.0) == 3) {
    throw InputError("--springs are all 0; allowed: one at least above 0");
  }
  const auto springs = springs_of(body, {constants[0], constants[1], constants[2]});
  fmt::print("step        {:.3g} s at most for springs of {:g}, {:g} and {:g} J\n",
             deformable::stable_step(springs), constants[0], constants[1], constants[2]);
}

bool is_mesh(const std::filesystem::path& file) {
  constexpr std::array kEndings{".obj", ".ply", ".stl"};
  return std::ranges::find(kEndings, file.extension().string()) != kEndings.end();
}

/// A mesh alone, as a body of some material.
TetMesh mesh_alone(const DeformInfoOptions& o, const MemoryBudget& budget) {
  deformable::DeformSetup setup;
  const std::filesystem::path file(o.input.file);
  (file.extension() == ".node" ? setup.source.tetrahedra : setup.source.mesh) =
      std::filesystem::absolute(file);
  if (file.extension() != ".node" && !is_mesh(file)) {
    throw InputError(fmt::format("{}: allowed: .toml, .obj, .ply, .stl or .node", o.input.file));
  }
  setup.source.scale = checked_real("--scale", o.scale.value_or(kScale), 1e-12, 1e12);
  setup.source.resolution =
      checked_number("--resolution", o.resolution.value_or(kResolution), 1, 1000);
  return deformable::body_of(
      setup, [&](const std::string& what, double bytes) { budget.check(what, bytes); });
}

/// Options that would be without effect.
void check_source_options(const DeformInfoOptions& o) {
  const std::filesystem::path ending = std::filesystem::path(o.input.file).extension();
  if (ending == ".toml" && (o.resolution || o.scale)) {
    throw InputError(fmt::format("{} is for a mesh; {} says it itself, in [body]",
                                 o.resolution ? "--resolution" : "--scale", o.input.file));
  }
  if (ending == ".node" && o.resolution) {
    throw InputError(fmt::format(
        "--resolution is for a surface that is filled; {} has its tetrahedra", o.input.file));
  }
}

int deform_info(const DeformInfoOptions& options) {
  check_source_options(options);
  const MemoryBudget budget(options.input.max_memory);
  const bool stated = std::filesystem::path(options.input.file).extension() == ".toml";
  DeformBody body;
  if (stated) {
    body.setup = deformable::read_setup(options.input.file);
    body.mesh = deformable::body_of(
        body.setup, [&](const std::string& what, double bytes) { budget.check(what, bytes); });
  } else {
    body.mesh = mesh_alone(options, budget);
  }
  check_memory_of(body, kByPart, budget);
  print_counts(body.mesh);
  const bool good = print_shapes(body.mesh);
  print_memory(body.mesh);
  if (!good) {
    deformable::check_body(body.mesh, options.input.file);
  }
  if (stated) {
    body.elasticity = deformable::elasticity_of(body.setup, body.mesh);
    print_material(body);
  }
  if (!options.constants.empty()) {
    print_springs(body, options.constants);
  }
  return 0;
}

}  // namespace

void add_deform_info(CLI::App& deform, int& status) {
  CLI::App* sub = subcommand(deform, "info", "Describe a body: shapes, volume, mass, step, memory",
                             "haptrial deform info gear.toml", {"", "guide-deformable.md"});
  auto& o = options_of<DeformInfoOptions>(*sub, status, deform_info);
  add_deform_input(*sub, o.input,
                   "Definition of a body (.toml), mesh (.obj, .ply, .stl) or tetrahedra (.node)");
  sub->add_option("--resolution", o.resolution,
                  with_default("Number of cubes along the longest axis of a mesh", kResolution));
  sub->add_option("--scale", o.scale, with_default("Length of one unit of a mesh [m]", kScale));
  sub->add_option("--springs", o.constants,
                  "Constants of springs, of lengths, areas and volumes [J], whose stable step is "
                  "computed")
      ->expected(3);
}

}  // namespace haptrial::experiments
