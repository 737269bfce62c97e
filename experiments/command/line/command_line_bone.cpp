// Bones.

#include "experiments/command/line/command_line_internal.h"

namespace haptrial::experiments {
namespace {

void take_input(CLI::App& sub, BoneOptions& o) {
  sub.add_option("IN", o.in,
                 "Bone or volume (.nrrd, .nhdr, .nii, .nii.gz), or folder with a DICOM series")
      ->required();
  sub.add_option("--as", o.as, "Kind of values: auto, labels or grey (default: auto)");
  sub.add_option(
      "--spacing", o.spacing,
      "Edge of a voxel [mm] (default: 0.5 for grey volumes, that of the file for labels)");
  sub.add_option("--threshold", o.threshold,
                 "Lowest value of bone, or auto (default: 300 in Hounsfield units)");
  sub.add_option("--dense", o.dense,
                 "Lowest value of fully dense bone (default: 1500 in Hounsfield units)");
  sub.add_option("--labels", o.labels, "Names of labels (.toml)");
  sub.add_option("--without", o.without, "Structures to leave out: NAME,NAME")->delimiter(',');
  sub.add_option("--max-memory", o.max_memory,
                 "Limit of memory [GB]; a larger input is refused (default: the free memory)");
}

void take_output(CLI::App& sub, BoneOptions& o) {
  sub.add_option("OUT", o.out, "New bone (.nrrd)")->required();
  sub.add_flag("--overwrite", o.overwrite, "Overwrite an existing file");
}

void add_bone_import(CLI::App& bone, int& status) {
  CLI::App* sub =
      subcommand(bone, "import", "Make a bone from CT or from labels",
                 "haptrial bone import head.nii.gz head.nrrd --threshold 300 --spacing 0.5",
                 {"the bone OUT", "algorithms/bone-data.md"});
  auto& o = options_of<BoneOptions>(*sub, status, bone_import);
  take_input(*sub, o);
  take_output(*sub, o);
}

void add_bone_info(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(bone, "info", "Show what a bone holds, structure by structure",
                             "haptrial bone info ear.nrrd");
  take_input(*sub, options_of<BoneOptions>(*sub, status, bone_info));
}

void add_bone_make(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(bone, "make", "Make a bone from shapes and a seed",
                             "haptrial bone make mandible jaw.nrrd --seed 2 --spacing 0.5");
  auto& o = options_of<BoneOptions>(*sub, status, bone_make);
  sub->add_option("BONE", o.shape, "Bone to make: temporal or mandible")->required();
  take_output(*sub, o);
  sub->add_option("--seed", o.seed, "Seed of the anatomy (default: 1)");
  sub->add_option("--spacing", o.spacing, "Edge of a voxel [mm] (default: 0.5)");
}

void add_picture(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(bone, "picture", "Draw a bone, whole or drilled",
                             "haptrial bone picture ear.nrrd ear.png --from -1,0.2,0.1");
  auto& o = options_of<BonePictureOptions>(*sub, status, bone_picture);
  sub->add_option("IN", o.in, "Bone (.nrrd)")->required();
  sub->add_option("OUT", o.out, "New picture (.png)")->required();
  sub->add_option("--from", o.from,
                  "Direction from the bone to the eye: X,Y,Z (default: -1,0.2,0.1)")
      ->delimiter(',');
  sub->add_option("--at", o.at,
                  "Point in the middle of the picture: X,Y,Z [mm] (default: the bone's middle)")
      ->delimiter(',');
  sub->add_option("--zoom", o.zoom, "Magnification (default: 1)");
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
  sub->add_option("--width", o.width, "Width of the picture [px] (default: 1280)");
  sub->add_option("--height", o.height, "Height of the picture [px] (default: 720)");
  sub->add_option("--max-memory", o.max_memory,
                  "Limit of memory [GB]; a larger input is refused (default: the free memory)");
  sub->add_flag("--overwrite", o.overwrite, "Overwrite an existing file");
}

void add_stages(CLI::App& bone, int& status) {
  CLI::App* sub =
      subcommand(bone, "stages", "Draw stills of a cavity, stage by stage, for participants",
                 "haptrial bone stages experiments/construct_validity.toml --out stills");
  auto& o = options_of<BoneStagesOptions>(*sub, status, bone_stages);
  sub->add_option("DEFINITION", o.definition, "Definition with a table [cavity] (.toml)")
      ->required();
  sub->add_option("--out", o.out, "New folder for the stills")->required();
  sub->add_option("--count", o.count,
                  "Number of stills; the first shows the untouched bone (default: 4)");
}

}  // namespace

void add_bone(CLI::App& app, int& status) {
  CLI::App* bone =
      subcommand(app, "bone", "Import, make, draw and describe bones",
                 "haptrial bone make temporal ear.nrrd --seed 3", {"", "guide-bone.md"});
  bone->require_subcommand(1);
  add_bone_import(*bone, status);
  add_bone_info(*bone, status);
  add_bone_make(*bone, status);
  add_picture(*bone, status);
  add_stages(*bone, status);
}

}  // namespace haptrial::experiments
