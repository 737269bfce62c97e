#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/shortest_turn.h"
#include "core/bone/data/ear_side.h"
#include "core/bone/data/load_bone.h"
#include "core/bone/surface/surface_depths.h"
#include "core/render/bone/bone_scene.h"
#include "core/render/bone/bone_tools.h"
#include "core/render/gl/offscreen.h"
#include "experiments/command/arguments.h"
#include "experiments/command/bone/bone_carving.h"
#include "experiments/command/mesh_command.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

struct BonePictureOptions {
  std::string in;
  std::string out;
  std::vector<std::string> without;
  std::vector<std::string> drill;
  std::vector<std::string> cut;
  bool spare{false};
  std::vector<double> from{};
  std::vector<double> at;
  double zoom{1.0};
  std::string burr;
  std::optional<double> stereo;
  int width{1280};
  int height{720};
  std::optional<double> max_memory;
  bool overwrite{false};
};

constexpr int kFiner = 2;  // drawn pixels to one of the picture, each way

void check_options(const BonePictureOptions& options) {
  if (std::filesystem::path(options.out).extension() != ".png") {
    throw InputError(fmt::format("{}: is not a picture by its name; allowed: .png", options.out));
  }
  check_new(options.out, options.overwrite);
  constexpr int kLargest = 4096;
  for (const auto& [name, pixels] :
       {std::pair{"--width", options.width}, std::pair{"--height", options.height}}) {
    if (pixels < 16 || pixels > kLargest) {
      throw InputError(fmt::format("{} is {}; allowed: 16 to {} [px]", name, pixels, kLargest));
    }
  }
  if (!(options.zoom >= 0.01 && options.zoom <= 1000.0)) {
    throw InputError(fmt::format("--zoom is {}; allowed: 0.01 to 1000", options.zoom));
  }
  if (options.stereo && !(*options.stereo >= 0.0 && *options.stereo <= 1000.0)) {
    throw InputError(fmt::format("--stereo is {}; allowed: 0 to 1000 [mm]", *options.stereo));
  }
}

/// Three finite numbers. @throws InputError
Eigen::Vector3d vector_of(const char* name, const std::vector<double>& numbers) {
  const Eigen::Map<const Eigen::VectorXd> all(numbers.data(),
                                              static_cast<Eigen::Index>(numbers.size()));
  if (numbers.size() != 3 || !all.allFinite()) {
    throw InputError(fmt::format("{} is not a place; allowed: three numbers X,Y,Z", name));
  }
  return all.head<3>();
}

Eigen::AlignedBox3d box_of(const bone::BoneModel& model) {
  Eigen::AlignedBox3d box;
  geometry::visit_voxels(model.grid, [&](const bone::Voxel& voxel, std::size_t at) {
    if (model.labels[at] != 0) {
      box.extend(model.grid.centre(voxel));
    }
  });
  if (box.isEmpty()) {
    throw InputError("the bone is empty; choose one with at least one voxel");
  }
  return box;
}

Camera camera_of(const BonePictureOptions& options, const bone::BoneModel& model) {
  const Eigen::Vector3d from =
      options.from.empty() ? bone::outside_view(model) : vector_of("--from", options.from);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  if (from.cross(up).norm() < 1e-3 * from.norm() || from.norm() == 0.0) {
    throw InputError("--from is along z, the up direction; choose another direction");
  }
  const double aspect =
      static_cast<double>(options.width) / (options.stereo ? 2 : 1) / options.height;
  Camera camera = render::looking_at(box_of(model), from, up, aspect);
  if (!options.at.empty()) {
    const Eigen::Vector3d target = kMillimetre * vector_of("--at", options.at);
    camera.eye += target - camera.target;
    camera.target = target;
  }
  return render::zoomed(camera, options.zoom);
}

void add_burr(const BonePictureOptions& options, render::BoneFrame& frame) {
  if (options.burr.empty()) {
    return;
  }
  const Stroke burr = parse_stroke("--burr", options.burr);
  if (burr.from == burr.to) {
    throw InputError(
        "--burr has one place for its centre and its handle; write two: X,Y,Z,X2,Y2,Z2,DIAMETER");
  }
  render::SceneMesh mesh;
  const double diameter = 2.0 * burr.radius;
  const double shaft = render::burr_shaft(diameter);
  constexpr double kLength = 0.09;  // [m]
  mesh.mesh = std::make_shared<geometry::Mesh>(render::burr_mesh(diameter, shaft, kLength));
  mesh.casts = render::burr_shadow(diameter, shaft, kLength);
  mesh.pose.translation() = burr.from;
  mesh.pose.linear() =
      shortest_turn(Eigen::Vector3d::UnitZ(), burr.to - burr.from).toRotationMatrix();
  frame.meshes.push_back(std::move(mesh));
}

int bone_picture(const BonePictureOptions& options) {
  check_options(options);
  const MemoryBudget budget(options.max_memory);
  bone::LoadOptions load;
  load.without = options.without;
  load.room = [&budget](const std::string& what, double bytes) { budget.check(what, bytes); };
  const bone::BoneModel model = [&] {
    ShownWork work("reading");
    return bone::load_bone(options.in, load, work.report());
  }();
  bone::BoneVolume volume(model);
  const std::vector<bool> shows = bone::all_but_bone(model.structures);
  std::vector<bool> spared;
  if (options.spare) {
    spared = shows;
  }
  for (const std::string& stroke : options.drill) {
    carve(volume, parse_stroke("--drill", stroke), spared);
  }
  for (const std::string& cut : options.cut) {
    carve(volume, parse_plane_cut("--cut", cut), spared);
  }
  render::BoneFrame frame;
  frame.camera = camera_of(options, model);
  if (options.stereo) {
    frame.stereo = render::StereoPair{*options.stereo * kMillimetre, {}};
  }
  frame.bones = {{0, &volume, Eigen::Isometry3d::Identity()}};
  add_burr(options, frame);

  render::BoneStyle style = render::microscope_style();
  style.vignette = 0.0;
  style.visible_array = false;  // one picture
  const int width = kFiner * options.width;
  const int height = kFiner * options.height;
  render::OffscreenContext context(width, height);
  render::BoneScene scene(context.gl(), style, model.structures,
                          std::make_shared<bone::StructureDepths>(model, shows));
  scene.draw(frame, width, height);
  render::write_png(options.out, render::coarser(context.read(), kFiner));
  fmt::print("wrote       {}: {} triangles\n", options.out, scene.figures().triangles);
  return 0;
}

}  // namespace

void add_bone_picture(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(bone, "picture", "Draw a bone, whole or drilled",
                             "haptrial bone picture ear.nrrd ear.png --from -1,0.2,0.1");
  auto& o = options_of<BonePictureOptions>(*sub, status, bone_picture);
  sub->add_option("IN", o.in, "Bone (.nrrd)")->required();
  sub->add_option("OUT", o.out, "New picture (.png)")->required();
  sub->add_option(
         "--from", o.from,
         "Direction from the bone to the eye: X,Y,Z (default: -1,0.2,0.1, of a left ear 1,0.2,0.1)")
      ->delimiter(',');
  sub->add_option("--at", o.at,
                  "Point in the middle of the picture: X,Y,Z [mm] (default: the bone's middle)")
      ->delimiter(',');
  sub->add_option("--zoom", o.zoom, with_default("Magnification", o.zoom));
  sub->add_option("--without", o.without, "Structures to leave out: NAME,NAME")->delimiter(',');
  sub->add_option("--drill", o.drill,
                  "Stroke to drill away: X,Y,Z,[X2,Y2,Z2,]DIAMETER [mm]; may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--cut", o.cut, "Plane to saw away: X,Y,Z,NX,NY,NZ,WIDTH [mm]; may be repeated")
      ->allow_extra_args(false);
  sub->add_flag("--spare", o.spare, "Drill and saw only bone, no other structure");
  sub->add_option("--burr", o.burr,
                  "Burr to draw, from its centre along its handle: X,Y,Z,X2,Y2,Z2,DIAMETER [mm]");
  sub->add_option("--stereo", o.stereo,
                  "Distance of the eyes [mm], for a pair of pictures (default: one picture)");
  sub->add_option("--width", o.width, with_default("Width of the picture [px]", o.width));
  sub->add_option("--height", o.height, with_default("Height of the picture [px]", o.height));
  sub->add_option("--max-memory", o.max_memory, kMemoryHelp);
  sub->add_flag("--overwrite", o.overwrite, "Overwrite an existing file");
}

}  // namespace haptrial::experiments
