#include "experiments/command/deform/deform_files.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "analysis/files/csv.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/deformable/springs/constants_table.h"
#include "core/geometry/files/tet_files.h"

namespace haptrial::experiments {
namespace {

using analysis::CsvTable;
using Eigen::Vector3d;

std::vector<Vector3d> vectors(const CsvTable& table, const char* x, const char* y, const char* z) {
  const auto xs = table.numbers(table.column(x));
  const auto ys = table.numbers(table.column(y));
  const auto zs = table.numbers(table.column(z));
  std::vector<Vector3d> found;
  for (std::size_t i = 0; i < xs.size(); ++i) {
    found.emplace_back(xs[i], ys[i], zs[i]);
  }
  return found;
}

geometry::TetField stress_field(const std::vector<deformable::TetState>& states) {
  geometry::TetField field{"stress_Pa", 6, {}};
  for (const auto& state : states) {
    const Eigen::Matrix3d& s = state.stress;
    field.values.insert(field.values.end(), {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)});
  }
  return field;
}

geometry::TetField mises_field(const std::vector<deformable::TetState>& states) {
  geometry::TetField field{"von_mises_Pa", 1, {}};
  for (const auto& state : states) {
    const Eigen::Matrix3d deviator =
        state.stress - state.stress.trace() / 3.0 * Eigen::Matrix3d::Identity();
    field.values.push_back(std::sqrt(1.5 * deviator.squaredNorm()));
  }
  return field;
}

}  // namespace

std::string displacements_csv(const geometry::TetMesh& mesh, const std::vector<Vector3d>& u) {
  std::string text = "vertex,x_m,y_m,z_m,ux_m,uy_m,uz_m\n";
  for (std::size_t v = 0; v < u.size(); ++v) {
    const Vector3d& p = mesh.vertices[v];
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{:.9g},{:.9g},{:.9g}\n", v, p.x(), p.y(),
                   p.z(), u[v].x(), u[v].y(), u[v].z());
  }
  return text;
}

std::vector<Vector3d> read_displacements(const std::filesystem::path& file,
                                         const geometry::TetMesh& mesh) {
  const CsvTable table = CsvTable::load(file);
  const std::vector<Vector3d> rows = vectors(table, "ux_m", "uy_m", "uz_m");
  if (rows.size() != mesh.vertices.size()) {
    throw InputError(fmt::format("{}: has {} rows; the body has {} vertices", file.string(),
                                 rows.size(), mesh.vertices.size()));
  }
  if (!table.has("vertex")) {
    return rows;
  }
  const std::size_t column = table.column("vertex");
  const std::vector<double> numbers = table.numbers(column);
  std::vector<Vector3d> found(rows.size(), Vector3d::Constant(NAN));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double n = numbers[i];
    if (!(n >= 0 && n < static_cast<double>(rows.size())) || n != std::floor(n) ||
        !std::isnan(found[static_cast<std::size_t>(n)].x())) {
      table.refuse(i, column, fmt::format("each vertex from 0 to {} once", rows.size() - 1));
    }
    found[static_cast<std::size_t>(n)] = rows[i];
  }
  return found;
}

bool has_markers(const std::filesystem::path& file) {
  const CsvTable table = CsvTable::load(file);
  return !table.has("vertex") && table.has("x_m");
}

std::vector<deformable::Marker> read_markers(const std::filesystem::path& file,
                                             const geometry::TetMesh& mesh) {
  const CsvTable table = CsvTable::load(file);
  const auto rest = vectors(table, "x_m", "y_m", "z_m");
  const auto moved = vectors(table, "ux_m", "uy_m", "uz_m");
  constexpr double kOutside = -0.5;  // a weight: half an element
  std::vector<deformable::Marker> markers;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    markers.push_back(deformable::marker_at(mesh, rest[i], rest[i] + moved[i]));
    if (markers.back().weights.minCoeff() < kOutside) {
      table.refuse(i, table.column("x_m"), "a place in the body or less than half an element out");
    }
  }
  return markers;
}

deformable::SpringConstants read_constants(const std::filesystem::path& file,
                                           const deformable::SpringBody& body) {
  return deformable::parse_constants(file_text(file), file.string(), body);
}

void write_state(const std::filesystem::path& file, const geometry::TetMesh& mesh,
                 const std::vector<Vector3d>& displacement,
                 const std::vector<deformable::TetState>& states) {
  geometry::TetMesh moved = mesh;
  geometry::TetField field{"displacement_m", 3, {}};
  for (std::size_t v = 0; v < displacement.size(); ++v) {
    moved.vertices[v] += displacement[v];
    field.values.insert(field.values.end(), displacement[v].begin(), displacement[v].end());
  }
  std::vector<geometry::TetField> of_tetrahedra;
  if (!states.empty()) {
    of_tetrahedra = {stress_field(states), mises_field(states)};
  }
  geometry::write_vtu(file, moved, {field}, of_tetrahedra);
}

}  // namespace haptrial::experiments
