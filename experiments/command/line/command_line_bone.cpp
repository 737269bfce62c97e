// Bones.

#include "experiments/command/drilling/drilling_commands.h"
#include "experiments/command/line/command_lines.h"
#include "experiments/command/line/subcommand_internal.h"
#include "experiments/command/tools/tool_commands.h"

namespace haptrial::experiments {
namespace {

void take_input(CLI::App& sub, BoneOptions& o) {
  sub.add_option("IN", o.in,
                 "Bone, volume or segmentation (.nrrd, .nhdr, .nii, .nii.gz), or folder with a "
                 "DICOM series")
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
  sub.add_flag("--mirror", o.mirror, "Exchange left and right: a left ear becomes a right one");
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
                 {"the bone OUT", "guide-scan.md"});
  auto& o = options_of<BoneImportOptions>(*sub, status, bone_import);
  take_input(*sub, o);
  take_output(*sub, o);
  sub->add_option("--crop", o.crop, "Box to keep: X0,X1,Y0,Y1,Z0,Z1 [mm], as info prints places")
      ->delimiter(',');
  sub->add_option("--around", o.around, "Cube to keep about a point: X,Y,Z,EDGE [mm]")
      ->delimiter(',');
  sub->add_option("--segmentation", o.segmentation,
                  "Structures of the scan as 3D Slicer saves them (.seg.nrrd)");
  sub->add_option("--structure", o.structures,
                  "Structure as a mesh: NAME=FILE (.stl, .obj, .ply) [mm]; may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--mesh-axes", o.mesh_axes,
                  "Axes of meshes: lps, ras or auto, as their files say (default: auto, then lps)");
  sub->add_flag("--largest", o.largest, "Leave out loose parts of bone: keep the largest");
  sub->add_option("--fill", o.fill, "Largest hole to fill with bone [mm3] (default: none)");
  sub->add_option("--histogram", o.histogram,
                  "New picture of a grey volume's values and thresholds (.png, .svg)");
}

void add_bone_info(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(bone, "info", "Show what a bone holds, structure by structure",
                             "haptrial bone info ear.nrrd");
  take_input(*sub, options_of<BoneOptions>(*sub, status, bone_info));
}

void add_bone_structures(CLI::App& bone, int& status) {
  CLI::App* sub =
      subcommand(bone, "structures", "List structures and name them anew",
                 "haptrial bone structures ear.nrrd --labels names.toml --out named.nrrd",
                 {"", "guide-scan.md"});
  auto& o = options_of<BoneStructuresOptions>(*sub, status, bone_structures);
  sub->add_option("IN", o.in, "Bone or volume with labels (.nrrd, .nhdr, .nii, .nii.gz)")
      ->required();
  sub->add_option("--labels", o.labels, "Names of labels (.toml)");
  sub->add_option("--out", o.out, "New bone under these names (.nrrd)");
  sub->add_option("--table", o.table,
                  "New table of names that are not known, with guesses, for --labels (.toml)");
  sub->add_option("--max-memory", o.max_memory,
                  "Limit of memory [GB]; a larger input is refused (default: the free memory)");
  sub->add_flag("--overwrite", o.overwrite, "Overwrite existing files");
}

void add_bone_export(CLI::App& bone, int& status) {
  CLI::App* sub =
      subcommand(bone, "export", "Write a bone, or what a session left of one, for other programs",
                 "haptrial bone export ear.nrrd ear.stl --structure 'facial nerve'",
                 {"the file OUT", "guide-scan.md"});
  auto& o = options_of<BoneExportOptions>(*sub, status, bone_export);
  sub->add_option("IN", o.in, "Bone (.nrrd) or session of bone drilling (.h5)")->required();
  sub->add_option("OUT", o.out, "New mesh (.stl, .obj, .ply) [mm] or labels (.seg.nrrd)")
      ->required();
  sub->add_option("--trial", o.trial, "Procedure of a session (default: 1)");
  sub->add_option("--structure", o.structure, "Structure of the mesh (default: the whole surface)");
  sub->add_flag("--ras", o.ras, "Write a mesh in RAS axes (default: LPS, as 3D Slicer reads them)");
  sub->add_flag("--overwrite", o.overwrite, "Overwrite an existing file");
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
  sub->add_option(
         "--from", o.from,
         "Direction from the bone to the eye: X,Y,Z (default: -1,0.2,0.1, of a left ear 1,0.2,0.1)")
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
                 "haptrial bone stages construct_validity --out stills");
  auto& o = options_of<BoneStagesOptions>(*sub, status, bone_stages);
  sub->add_option("DEFINITION", o.definition, "Definition with a table [cavity] (.toml)")
      ->required();
  sub->add_option("--out", o.out, "New folder for the stills")->required();
  sub->add_option("--count", o.count,
                  "Number of stills; the first shows the untouched bone (default: 4)");
}

void add_place(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(
      bone, "place", "Draw a bone as it lies before its first cut, with names",
      "haptrial bone place construct_validity placed.png", {"the picture OUT", "guide-scan.md"});
  auto& o = options_of<BonePlaceOptions>(*sub, status, bone_place);
  sub->add_option("DEFINITION", o.definition, "Definition of bone drilling (.toml)")->required();
  sub->add_option("OUT", o.out, "New picture (.png)")->required();
  sub->add_option("--bone", o.bone, "Number of the bone in the definition's list (default: 1)");
  sub->add_flag("--overwrite", o.overwrite, "Overwrite an existing file");
}

void add_page(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(
      bone, "page", "Show a trainee what went well in drillings: a page for a browser",
      "haptrial bone page out/sessions/P05.h5 --study out/validity-001 --out P05.html",
      {"the page OUT, and of several procedures one page each beside it", "guide-bone.md"});
  auto& o = options_of<BonePageOptions>(*sub, status, bone_page);
  sub->add_option("SESSION", o.sessions, "Drilling sessions of one participant (.h5)")->required();
  sub->add_option("--out", o.out, "New page (.html)")->required();
  sub->add_option("--study", o.study,
                  "Folder of a study; participants of its expert groups are the experts");
  sub->add_option("--expert", o.experts,
                  "Session of an expert (.h5), shown beside on the same bone; may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--trial", o.trial, "Procedure of each session (default: all)");
  sub->add_flag("--overwrite", o.overwrite, "Overwrite existing pages");
}

void add_safe(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(
      bone, "safe", "Learn safe forces and speeds near structures from experts, for hints",
      "haptrial bone safe safe.toml --study out/validity-001",
      {"the file OUT, which [hints] of a definition names", "algorithms/live-hints.md"});
  auto& o = options_of<BoneSafeOptions>(*sub, status, bone_safe);
  sub->add_option("OUT", o.out, "New file of safe values (.toml)")->required();
  sub->add_option("--study", o.study,
                  "Folder of a study; participants of its expert groups are the experts");
  sub->add_option("--expert", o.experts, "Session of an expert (.h5); may be repeated")
      ->allow_extra_args(false);
  sub->add_flag("--overwrite", o.overwrite, "Overwrite an existing file");
}

}  // namespace

void add_bone(CLI::App& app, int& status) {
  CLI::App* bone =
      subcommand(app, "bone", "Import, make, draw and describe bones",
                 "haptrial bone make temporal ear.nrrd --seed 3", {"", "guide-bone.md"});
  bone->require_subcommand(1);
  add_bone_import(*bone, status);
  add_bone_info(*bone, status);
  add_bone_structures(*bone, status);
  add_bone_export(*bone, status);
  add_bone_make(*bone, status);
  add_picture(*bone, status);
  add_stages(*bone, status);
  add_place(*bone, status);
  add_page(*bone, status);
  add_safe(*bone, status);
}

}  // namespace haptrial::experiments
