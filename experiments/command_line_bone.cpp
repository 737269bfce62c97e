// Bones.

#include "experiments/command_line_internal.h"

namespace haptrial::experiments {
namespace {

void take_input(CLI::App& sub, BoneOptions& o) {
  sub.add_option("IN", o.in,
                 "Bone or volume (.nrrd, .nhdr, .nii, .nii.gz), or folder with a DICOM series")
      ->required();
  sub.add_option("--as", o.as, "auto, labels or grey: what its numbers are (auto)");
  sub.add_option("--spacing", o.spacing,
                 "Edge of a voxel [mm]; of grey volumes 0.5, of labels their own by default");
  sub.add_option("--threshold", o.threshold,
                 "Bone begins at this number, or auto (300 in Hounsfield units)");
  sub.add_option("--dense", o.dense,
                 "Bone is dense from this number on (1500 in Hounsfield units)");
  sub.add_option("--labels", o.labels, "Names of labels (.toml)");
  sub.add_option("--without", o.without, "Structures to leave out, by name")->delimiter(',');
  sub.add_option("--max-memory", o.max_memory,
                 "Refuse what may take more [GB]; what the system has by default");
}

void take_output(CLI::App& sub, BoneOptions& o) {
  sub.add_option("OUT", o.out, "New bone (.nrrd)")->required();
  sub.add_flag("--overwrite", o.overwrite, "Replace a file that is there");
}

void add_import(CLI::App& bone, int& status) {
  CLI::App* sub =
      subcommand(bone, "import", "Make a bone of a CT or of labels",
                 "haptrial bone import head.nii.gz head.nrrd --threshold 300 --spacing 0.5");
  auto& o = options_of<BoneOptions>(*sub, status, bone_import);
  take_input(*sub, o);
  take_output(*sub, o);
}

void add_bone_info(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(bone, "info", "Say what a bone holds, structure by structure",
                             "haptrial bone info ear.nrrd");
  take_input(*sub, options_of<BoneOptions>(*sub, status, bone_info));
}

void add_make(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(bone, "make", "Make a bone from shapes and a seed",
                             "haptrial bone make mandible jaw.nrrd --seed 2 --spacing 0.5");
  auto& o = options_of<BoneOptions>(*sub, status, bone_make);
  sub->add_option("BONE", o.shape, "temporal or mandible")->required();
  take_output(*sub, o);
  sub->add_option("--seed", o.seed, "Of the anatomy (1)");
  sub->add_option("--spacing", o.spacing, "Edge of a voxel [mm] (0.5)");
}

void add_picture(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(bone, "picture", "Draw a bone, whole or drilled",
                             "haptrial bone picture ear.nrrd ear.png --from -1,0.2,0.1");
  auto& o = options_of<BonePictureOptions>(*sub, status, bone_picture);
  sub->add_option("IN", o.in, "Bone (.nrrd)")->required();
  sub->add_option("OUT", o.out, "New picture (.png)")->required();
  sub->add_option("--from", o.from, "From the bone towards the eye: X,Y,Z (-1,0.2,0.1)")
      ->delimiter(',');
  sub->add_option("--at", o.at, "What is in the middle: X,Y,Z [mm]; the bone's by default")
      ->delimiter(',');
  sub->add_option("--zoom", o.zoom, "Things become so many times as large (1)");
  sub->add_option("--without", o.without, "Structures to leave out, by name")->delimiter(',');
  sub->add_option("--drill", o.drill, "Drilled away: X,Y,Z,[X2,Y2,Z2,]DIAMETER [mm], any number")
      ->allow_extra_args(false);
  sub->add_option("--cut", o.cut, "Sawn away: X,Y,Z,NX,NY,NZ,WIDTH [mm], any number")
      ->allow_extra_args(false);
  sub->add_flag("--spare", o.spare, "Drill and saw bone only");
  sub->add_option("--burr", o.burr, "Show one: X,Y,Z,X2,Y2,Z2,DIAMETER [mm], from its centre on");
  sub->add_option("--stereo", o.stereo, "Two pictures, for eyes so far apart [mm]");
  sub->add_option("--width", o.width, "[px] (1280)");
  sub->add_option("--height", o.height, "[px] (720)");
  sub->add_option("--max-memory", o.max_memory,
                  "Refuse what may take more [GB]; what the system has by default");
  sub->add_flag("--overwrite", o.overwrite, "Replace a file that is there");
}

void add_stages(CLI::App& bone, int& status) {
  CLI::App* sub =
      subcommand(bone, "stages", "Stills of a cavity, stage by stage, for participants",
                 "haptrial bone stages experiments/construct_validity.toml --out stills");
  auto& o = options_of<BoneStagesOptions>(*sub, status, bone_stages);
  sub->add_option("DEFINITION", o.definition, "With a table [cavity] (.toml)")->required();
  sub->add_option("--out", o.out, "New folder")->required();
  sub->add_option("--count", o.count, "Stills, the untouched bone first (4)");
}

}  // namespace

void add_bone(CLI::App& app, int& status) {
  CLI::App* bone = subcommand(app, "bone", "Import bones, make and draw them, say what they hold",
                              "haptrial bone make temporal ear.nrrd --seed 3");
  bone->require_subcommand(1);
  add_import(*bone, status);
  add_bone_info(*bone, status);
  add_make(*bone, status);
  add_picture(*bone, status);
  add_stages(*bone, status);
}

}  // namespace haptrial::experiments
