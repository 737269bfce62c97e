#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/deformable/elements/setup_body.h"
#include "core/deformable/elements/static_solver.h"
#include "core/deformable/springs/spring_body.h"
#include "experiments/command/mesh_command.h"

namespace CLI {
class App;
}

namespace haptrial::experiments {

/// Input of every subcommand of haptrial deform.
struct DeformInput {
  std::string file;
  std::optional<double> max_memory;  // [GB]
};
void add_deform_input(CLI::App& sub, DeformInput& input,
                      const char* what = "Definition of a body and its loads (.toml)");

/// Body of a file, ready for use.
struct DeformBody {
  deformable::DeformSetup setup;
  geometry::TetMesh mesh;
  deformable::Elasticity elasticity;
};

/// @throws InputError for a file that is not good, elements that are inverted or flat, and memory
/// that there is not.
DeformBody load_deform_body(const DeformInput& input);

/// Springs of length, area and volume, with the masses of the body's materials.
deformable::SpringBody springs_of(const DeformBody& body,
                                  const deformable::UniformConstants& constants);

/// A load with its name, ready for any model.
struct NamedLoad {
  deformable::SetupLoad setup;
  deformable::LoadCase load;
  bool simulated{false};  // from a session that was
};

// Memory that is used beside the mesh, by tetrahedron [bytes]; measured on lattices of 135,000 and
// 625,000.
inline constexpr double kByPart = 330.0;           // edges and faces
inline constexpr double kBySpring = 400.0;         // springs and their packs
inline constexpr double kByMovingElement = 950.0;  // a dynamic solver

/// @throws InputError where that is not there
void check_memory_of(const DeformBody& body, double by_tetrahedron, const MemoryBudget& budget);

/// Statics by elements, asked for memory before.
deformable::StaticSolver static_solver(const DeformBody& body,
                                       const deformable::ElasticBody& elastic,
                                       const MemoryBudget& budget);

/// The rest vertices moved.
std::vector<Eigen::Vector3d> moved_by(const geometry::TetMesh& mesh,
                                      const std::vector<Eigen::Vector3d>& displacement);

/// @throws geometry::Cancelled when the program was asked to stop.
void check_interrupt();

double root_mean_square(const std::vector<Eigen::Vector3d>& vectors);

}  // namespace haptrial::experiments
