// How long a participant waits for the first picture of a bone, step by step, and the memory that a
// session with this bone takes at most.
//
//   bench_first_picture DEFINITION   a definition of bone_drilling, whose first bone is taken

#include <fmt/core.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <memory>
#include <string>

#include "core/render/gl/offscreen.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/display/bone_display.h"
#include "protocols/bone_drilling/display/bone_stage.h"
#include "protocols/bone_drilling/load_bones.h"

namespace {

using namespace haptrial;
using namespace haptrial::protocols;
using Clock = std::chrono::steady_clock;

double memory_GB() {
  std::ifstream in("/proc/self/status");
  for (std::string word; in >> word;) {
    if (word == "VmHWM:") {
      double kilobytes = 0.0;
      in >> kilobytes;
      return 1e-6 * kilobytes;
    }
  }
  return 0.0;
}

double processor_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

class Steps {
 public:
  void done(const char* what) {
    const auto now = Clock::now();
    const double used = processor_time();
    fmt::print("{:28} {:7.2f} s, of processors {:7.2f} s, at most {:5.2f} GB\n", what,
               std::chrono::duration<double>(now - before_).count(), used - used_, memory_GB());
    before_ = Clock::now();
    used_ = used;
  }

 private:
  Clock::time_point before_{Clock::now()};
  double used_{processor_time()};
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "bench_first_picture DEFINITION\n");
    return 2;
  }
  Steps steps;
  const BoneDefinition d = load_bone_definition(argv[1]);
  steps.done("definition and bone read");
  auto stage = std::make_shared<BoneStage>();
  stage->model = d.bones.front();
  const geometry::VoxelGrid& grid = stage->model->grid;
  fmt::print("{} x {} x {} voxels of {:.4g} mm\n", grid.size[0], grid.size[1], grid.size[2],
             1e3 * grid.spacing);
  stage->start_view = d.simulator.camera.start;
  stage->simulator = std::make_unique<bone::Simulator>(*stage->model, simulator_for(d, grid));
  steps.done("simulator");
  stage->companions =
      std::make_unique<bone::ThreadedCompanions>(*stage->simulator, companions_for(d, grid));
  steps.done("companions");
  stage->depths = depths_of(*stage->model);
  steps.done("structures near every voxel");
  auto surface = built_surface(*stage);
  steps.done("surface");
  render::OffscreenContext context(d.display.width, d.display.height);
  steps.done("opening OpenGL");
  BoneDisplay display(context.gl(), d, stage, d.display.width, d.display.height, {},
                      std::move(surface));
  display.draw({});
  steps.done("first picture");
  display.draw({});
  steps.done("second picture");
  display.draw({});
  steps.done("third picture");
  return 0;
}
