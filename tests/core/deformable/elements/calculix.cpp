#include "tests/core/deformable/elements/calculix.h"

#include <fmt/format.h>

#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "core/base/file_text.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::deformable::calculix {
namespace {

std::string mesh_text(const ElasticBody& body) {
  std::string text = "*NODE, NSET=NALL\n";
  const auto& mesh = body.mesh();
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Eigen::Vector3d& x = mesh.vertices[v];
    text += fmt::format("{},{:.12e},{:.12e},{:.12e}\n", v + 1, x.x(), x.y(), x.z());
  }
  text += "*ELEMENT, TYPE=C3D4, ELSET=EALL\n";
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto& c = mesh.tetrahedra[t];
    text += fmt::format("{},{},{},{},{}\n", t + 1, c[0] + 1, c[1] + 1, c[2] + 1, c[3] + 1);
  }
  return text;
}

std::string material_text(const ElasticBody& body) {
  const Material& material = body.elasticity().materials.at(0);
  const Moduli m = moduli(material);
  const std::string law =
      body.elasticity().law == Law::kLinear
          ? fmt::format("*ELASTIC\n{:.12e},{:.12e}\n", material.young, material.poisson)
          : fmt::format("*HYPERELASTIC, NEO HOOKE\n{:.12e},{:.12e}\n", m.shear / 2, 2 / m.bulk);
  return "*MATERIAL, NAME=M\n" + law + "*SOLID SECTION, ELSET=EALL, MATERIAL=M\n";
}

std::string step_text(const ElasticBody& body, const LoadCase& load, int increments) {
  const bool linear = body.elasticity().law == Law::kLinear;
  std::string text = linear ? "*STEP\n*STATIC\n"
                            : fmt::format(
                                  "*STEP, NLGEOM, INC=1000\n*STATIC, DIRECT\n{:.12e},1.\n"
                                  "*CONTROLS, PARAMETERS=FIELD\n1.e-11,1.e-11\n",
                                  1.0 / increments);
  text += "*BOUNDARY\n";
  for (const Hold& hold : load.holds) {
    for (int axis = 0; axis < 3; ++axis) {
      text += fmt::format("{},{},{},{:.12e}\n", hold.vertex + 1, axis + 1, axis + 1,
                          hold.displacement[axis]);
    }
  }
  Vectors forces(body.mesh().vertices.size(), Eigen::Vector3d::Zero());
  for (const NodalForce& f : load.forces) {
    forces[static_cast<std::size_t>(f.vertex)] += f.force;
  }
  if (!load.forces.empty()) {
    text += "*CLOAD\n";
  }
  for (std::size_t v = 0; v < forces.size(); ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      if (forces[v][axis] == 0) {
        continue;
      }
      text += fmt::format("{},{},{:.12e}\n", v + 1, axis + 1, forces[v][axis]);
    }
  }
  return text + "*NODE PRINT, NSET=NALL, FREQUENCY=100000\nU\n*END STEP\n";
}

}  // namespace

Vectors displacements(const ElasticBody& body, const LoadCase& load, int increments) {
  const test::TemporaryFolder folder;
  write_text(folder / "body.inp",
             mesh_text(body) + material_text(body) + step_text(body, load, increments));
  const std::string command = "cd '" + folder.path().string() +
                              "' && OMP_NUM_THREADS=1 timeout 300 ccx body > log.txt 2>&1";
  const int status = std::system(command.c_str());
  std::istringstream lines(status == 0 ? file_text(folder / "body.dat") : "");
  Vectors u(body.mesh().vertices.size(), Eigen::Vector3d::Zero());
  std::size_t read = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::size_t node = 0;
    double x = 0, y = 0, z = 0;
    if (!(words >> node >> x >> y >> z) || node < 1 || node > u.size()) {
      continue;
    }
    u[node - 1] = {x, y, z};
    ++read;
  }
  if (read != u.size()) {
    throw std::runtime_error("ccx printed no displacements: " + file_text(folder / "log.txt"));
  }
  return u;
}

}  // namespace haptrial::deformable::calculix
