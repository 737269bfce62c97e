#pragma once

#include <optional>
#include <string>

#include "core/geometry/mesh/mesh.h"
#include "core/geometry/mesh/work.h"
#include "core/geometry/volume/voxelize.h"
#include "core/render/mesh/scene.h"
#include "experiments/control/progress.h"
#include "experiments/control/signals.h"

namespace haptrial::experiments {

/// Input of every subcommand of haptrial mesh.
struct MeshInput {
  std::string file;
  double scale{1.0};                 // metres to the file's unit
  std::optional<double> max_memory;  // [GB]; default: what the system has free
};

/// How much memory work may take. The command asks before it takes what grows with its input.
class MemoryBudget {
 public:
  /// @throws InputError unless the limit is above 0.
  explicit MemoryBudget(std::optional<double> gigabytes);
  /// @throws InputError saying what `what` needs and what there is.
  void check(const std::string& what, double bytes) const;

 private:
  double bytes_;
  bool asked_;
};

/// Help of --max-memory.
inline constexpr const char* kMemoryHelp =
    "Limit of memory [GB]; a larger input is refused (default: the free memory)";

/// A report that shows a line of progress and lets SIGINT and SIGTERM cancel the work, while it is
/// in scope.
class ShownWork {
 public:
  explicit ShownWork(const std::string& what);
  geometry::WorkReport report();

 private:
  InterruptWatch watch_;
  Progress progress_;
};

/// The mesh of a file in metres. @throws InputError
geometry::Mesh load_mesh(const MeshInput& input, const MemoryBudget& budget);

struct VoxelizeOptions {
  int resolution{100};       // voxels along the longest axis
  int margin{0};             // more of them on every side
  bool over{false};          // one voxel over the surface
  std::string rule{"auto"};  // auto, parity, winding, flood
};
struct VoxelizedMesh {
  geometry::VoxelSolid solid;
  geometry::InsideRule rule;
  double seconds;  // voxelizing alone
};
/// @throws InputError
VoxelizedMesh voxelize_mesh(const geometry::Mesh& mesh, const VoxelizeOptions& options,
                            const MemoryBudget& budget);
const char* name_of(geometry::InsideRule rule);

/// Draws a scene into a new .png. @throws InputError
void write_picture(const std::string& file, std::span<const render::SceneTriangle> scene,
                   const render::SceneView& view, bool overwrite);
/// The view that "--up" asks for: x, y or z. @throws InputError
render::SceneView view_with_up(const std::string& up);

}  // namespace haptrial::experiments
