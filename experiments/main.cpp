// The command. Exit status: 0 done, 1 failed, 2 bad input.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "core/base/error.h"
#include "experiments/commands.h"
#include "experiments/version.h"

namespace {

namespace experiments = haptrial::experiments;

constexpr int kFailed = 1;
constexpr int kBadInput = 2;

/// Also where nobody reads it any more, as in a terminal that was closed.
void complain(const std::string& sentence) {
  [[maybe_unused]] const int written = std::fputs(("haptrial: " + sentence + "\n").c_str(), stderr);
}

CLI::App* subcommand(CLI::App& app, const char* name, const char* what, const char* example) {
  CLI::App* sub = app.add_subcommand(name, what);
  sub->footer(std::string("Example:\n  ") + example);
  return sub;
}

/// Declares the subcommands; the one that is given sets `status`.
class Commands {
 public:
  Commands(CLI::App& app, int& status) : app_(app), status_(status) {
    add_dry_run();
    add_run();
    add_analyze();
    add_export();
    add_align();
    add_compare();
    add_info();
    add_recover();
    add_replay();
    add_validate();
    add_power();
    add_devices();
    add_device_test();
    add_mesh();
    add_bone();
    add_spectrum();
    add_rate();
  }

 private:
  void add_dry_run() {
    CLI::App* sub =
        subcommand(app_, "dry-run", "Run a study with virtual subjects, as fast as it goes",
                   "haptrial dry-run experiments/force_training.toml --jobs 2");
    sub->add_option("DEFINITION", dry_run_.definition, "Experiment definition (.toml)")->required();
    sub->add_option("--subjects", dry_run_.subjects, "How many; as the definition says by default");
    sub->add_option("--seed", dry_run_.seed, "Of every random number (1)");
    sub->add_option("--jobs", dry_run_.jobs, "Threads; one per processor by default");
    sub->add_option("--out", dry_run_.out, "New folder for the session files (out/NAME-001)");
    sub->add_option("--trials", dry_run_.trials, "Only the first so many of each subject");
    sub->add_option("--frames", dry_run_.frames,
                    "Also write so many pictures of each pass, as the subject saw it (0)");
    sub->callback([this] { status_ = experiments::dry_run(dry_run_); });
  }

  void add_run() {
    CLI::App* sub = subcommand(app_, "run", "Run one participant's session in real time",
                               "haptrial run experiments/force_training.toml --subject P01");
    sub->add_option("DEFINITION", run_.definition, "Experiment definition (.toml)")->required();
    sub->add_option("--subject", run_.subject, "Identifier: letters, digits, '-', '_'")->required();
    sub->add_option("--device", run_.device,
                    "virtual, mouse, force-dimension, open-haptics or replay:FILE (virtual)");
    sub->add_option("--library", run_.library,
                    "Path of the vendor's library; searched for by default");
    sub->add_flag("--window", run_.window, "Show the participant's screen");
    sub->add_flag("--keyboard", run_.keyboard, "Keys of this terminal steer the session");
    sub->add_flag("--console", run_.console,
                  "Serve the experimenter's page on the loopback address");
    sub->add_option("--port", run_.port, "Of the console (any that is free)");
    sub->add_option("--address", run_.address, "Of the console (127.0.0.1); needs --remote");
    sub->add_flag("--remote", run_.remote, "Let the console listen on another address");
    sub->add_flag("--lsl", run_.stream, "Stream to the Lab Streaming Layer, where it is installed");
    sub->add_flag("--resume", run_.resume, "Go on with the session that did not come to its end");
    sub->add_option("--handedness", run_.person.handedness, "Of the participant, for the file");
    sub->add_option("--age-band", run_.person.age_band, "Such as 18-25");
    sub->add_option("--sex", run_.person.sex, "Of the participant, for the file");
    sub->add_option("--consent", run_.person.consent_confirmed, "Such as yes, or a date");
    sub->add_option("--notes", run_.person.notes, "Free text, for the file");
    sub->add_option("--seed", run_.seed, "Of the study (1)");
    sub->add_option("--participant", run_.participant,
                    "Number that sets the order of conditions; at the end of ID by default");
    sub->add_option("--trials", run_.trials, "Only the first so many");
    sub->add_option("--out", run_.out, "Folder for the session file (out/sessions)");
    sub->callback([this] { status_ = experiments::run(run_); });
  }

  void add_analyze() {
    CLI::App* sub =
        subcommand(app_, "analyze", "Score and test the sessions of a folder; write the report",
                   "haptrial analyze out/force_training-001");
    sub->add_option("DIR", analyze_.folder, "Folder of session files (.h5)");
    sub->add_option("--curves", analyze_.curves,
                    "In place of DIR: folder of curves that something else recorded (.csv)");
    sub->add_option("--conditions", analyze_.conditions,
                    "With --curves: table of their trials (.csv)");
    sub->add_option("--out", analyze_.out, "With --curves: folder for the report");
    sub->add_option("--definition", analyze_.definition,
                    "With --curves: score as this definition says; as shipped by default");
    sub->add_option("--time-column", analyze_.time_column, "With --curves (time)");
    sub->add_option("--target-column", analyze_.target_column, "With --curves (target_force)");
    sub->add_option("--applied-column", analyze_.applied_column, "With --curves (applied_force)");
    sub->add_option("--jobs", analyze_.jobs, "Threads; one per processor by default");
    sub->callback([this] { status_ = experiments::analyze(analyze_); });
  }

  void add_export() {
    CLI::App* sub = subcommand(app_, "export", "Write sessions in the forms of other programs",
                               "haptrial export --bids data-set out/force_training-001");
    sub->add_option("FILE", export_.files, "Session files (.h5), or folders of them")->required();
    sub->add_option("--bids", export_.bids, "New folder for a BIDS data set");
    sub->add_option("--csv", export_.csv, "New folder for tidy tables (.csv)");
    sub->add_option("--curves", export_.curves, "New folder for the scored curves (.csv)");
    sub->add_flag("--samples", export_.samples, "With --csv: every tick as well (.csv.gz)");
    sub->add_option("--name", export_.name, "With --bids: of the data set");
    sub->add_option("--author", export_.authors, "With --bids: of the data set; may be repeated")
        ->allow_extra_args(false);
    sub->add_option("--jobs", export_.jobs, "Threads; one per processor by default");
    sub->callback([this] { status_ = experiments::export_sessions(export_); });
  }

  void add_align() {
    CLI::App* sub =
        subcommand(app_, "align", "Align two curves of any origin (.csv) and score the second",
                   "haptrial align target.csv applied.csv --value force --out aligned");
    sub->add_option("TARGET", align_.target,
                    "Table of the target curve (.csv); - reads standard "
                    "input")
        ->required();
    sub->add_option("APPLIED", align_.applied, "Table of the applied curve")->required();
    sub->add_option("--time", align_.time, "Column of times in s, by name or number (time)");
    sub->add_option("--rate", align_.rate, "Rows a second, in place of a column of times");
    sub->add_option("--value", align_.value, "Column of values (the only other one)");
    sub->add_option("--applied-value", align_.applied_value, "The same of APPLIED (as --value)");
    sub->add_option("--samples", align_.samples, "Of the common time base (1000)");
    sub->add_option("--filter", align_.filter, "Width of the box filter on APPLIED in s (0.1)");
    sub->add_option("--power", align_.power, "Of the differences, 1 or more (1)");
    sub->add_option("--slope-weight", align_.slope_weight, "Of differences of slopes (0.5)");
    sub->add_option("--penalty", align_.penalty,
                    "Of a step that is not straight (0.5 with the published pattern, else 0)");
    sub->add_option("--pattern", align_.pattern,
                    "published, symmetric1, symmetric2, asymmetric or symmetricP1 (published)");
    sub->add_option("--window", align_.window, "Pair no samples farther apart than so many s");
    sub->add_flag("--open-begin", align_.open_begin, "APPLIED may begin before the match does");
    sub->add_flag("--open-end", align_.open_end, "APPLIED may go on after the match");
    sub->add_option("--out", align_.out, "New folder for the aligned curves, path and picture");
    sub->callback([this] { status_ = experiments::align(align_); });
  }

  void add_compare() {
    CLI::App* sub = subcommand(
        app_, "compare", "Compare the scores of two analysed studies",
        "haptrial compare results/force_training results/force_training_curve --out out/compared");
    sub->add_option("FIRST", path_, "Folder of an analysed study")->required();
    sub->add_option("SECOND", second_, "Folder of another")->required();
    sub->add_option("--out", compare_out_, "Folder for a page, a figure and the numbers");
    sub->callback([this] { status_ = experiments::compare(path_, second_, compare_out_); });
  }

  void add_info() {
    CLI::App* sub =
        subcommand(app_, "info", "Say what a session file holds and whether it is complete",
                   "haptrial info out/force_training-001/S01.h5");
    sub->add_option("FILE", path_, "Session file (.h5)")->required();
    sub->callback([this] { status_ = experiments::info(path_); });
  }

  void add_recover() {
    CLI::App* sub = subcommand(app_, "recover", "Save what a damaged session file still holds",
                               "haptrial recover out/sessions/P01.h5.partial");
    sub->add_option("FILE", path_, "Damaged session file (.h5, .partial); it stays as it is")
        ->required();
    sub->add_option("OUT", recover_out_, "New session file (FILE.recovered.h5)");
    sub->callback([this] { status_ = experiments::recover(path_, recover_out_); });
  }

  void add_replay() {
    CLI::App* sub =
        subcommand(app_, "replay", "Show a recorded trial as the participant saw it; drill a bone again",
                   "haptrial replay out/force_training-001/S01.h5 --trial 3 --video trial-3.mp4");
    sub->add_option("FILE", replay_.file, "Session file (.h5)")->required();
    sub->add_option("--trial", replay_.trial,
                    "Number from 1; of a drilling all by default, and the first for a video");
    sub->add_option("--phase", replay_.phase, "training or test; both by default");
    sub->add_option("--video", replay_.video, "New video (.mp4), written by ffmpeg");
    sub->add_option("--frames", replay_.frames, "New folder for pictures (.png)");
    sub->add_option("--sound", replay_.sound, "New sound of a drilling (.wav)");
    sub->add_option("--fps", replay_.fps, "Pictures a second (30)");
    sub->callback([this] { status_ = experiments::replay(replay_); });
  }

  void add_validate() {
    CLI::App* sub = subcommand(app_, "validate", "Check a definition and say what it plans",
                               "haptrial validate experiments/force_training.toml");
    sub->add_option("DEFINITION", path_, "Experiment definition (.toml)")->required();
    sub->callback([this] { status_ = experiments::validate(path_); });
  }

  void add_power() {
    CLI::App* sub = subcommand(app_, "power", "Say how many participants a study needs",
                               "haptrial power t --design paired --delta 20 --sd 35 --power 0.8");
    sub->add_option("TEST", power_.test, "t or anova (one way)")->required();
    sub->add_option("--design", power_.design, "Of t: two-sample (default), paired, one-sample");
    sub->add_option("--delta", power_.delta, "Of t: the difference to find");
    sub->add_option("--sd", power_.sd,
                    "In the unit of --delta; with paired that of the differences (1)");
    sub->add_option("--f", power_.f, "Of anova: deviation of the groups' means by that within");
    sub->add_option("--groups", power_.groups, "Of anova: how many");
    sub->add_option("--n", power_.n, "Participants in each group");
    sub->add_option("--power", power_.power, "Chance of finding the effect");
    sub->add_option("--alpha", power_.alpha, "Chance of finding one that is none (0.05)");
    sub->add_flag("--one-tailed", power_.one_tailed, "Of t: the sign of the difference is planned");
    sub->callback([this] { status_ = experiments::power(power_); });
  }

  void add_devices() {
    CLI::App* sub = subcommand(app_, "devices", "List the devices", "haptrial devices");
    sub->callback([this] { status_ = experiments::devices(); });
  }

  void add_device_test() {
    CLI::App* sub = subcommand(app_, "device-test", "Check a device and say whether it is fit",
                               "haptrial device-test force-dimension");
    sub->add_option("NAME", device_test_.name, "virtual, mouse, force-dimension or open-haptics")
        ->required();
    sub->add_option("--definition", device_test_.definition,
                    "Set the device up as this experiment does (.toml)");
    sub->add_option("--seconds", device_test_.seconds, "How long (120)");
    sub->add_option("--library", device_test_.library,
                    "Path of the vendor's library; searched for by default");
    sub->callback([this] { status_ = experiments::device_test(device_test_); });
  }

  void add_mesh() {
    CLI::App* mesh =
        subcommand(app_, "mesh", "Check, repair, voxelize, measure and split surface meshes",
                   "haptrial mesh tetrahedralize bunny.ply bunny.vtu");
    mesh->require_subcommand(1);
    CLI::App* make = mesh_subcommand(*mesh, "make", "Make a mesh to try things on",
                                     "haptrial mesh make gear gear.ply");
    make->add_option("SHAPE", mesh_.shape, "sphere, torus, gear or rough")->required();
    make->add_option("OUT", mesh_.out, "New mesh (.obj, .ply, .stl, .off)")->required();
    make->callback([this] { status_ = experiments::mesh_make(mesh_); });

    CLI::App* info = mesh_subcommand(*mesh, "info", "Say what a mesh is and what is wrong with it",
                                     "haptrial mesh info gear.ply");
    add_mesh_input(*info);
    add_mesh_picture(*info);
    info->callback([this] { status_ = experiments::mesh_info(mesh_); });

    CLI::App* repair = mesh_subcommand(*mesh, "repair", "Weld, clean and orient a mesh",
                                       "haptrial mesh repair scan.stl clean.ply --weld 1e-5");
    add_mesh_input(*repair);
    repair->add_option("OUT", mesh_.out, "New mesh (.obj, .ply, .stl, .off)")->required();
    repair->add_option("--weld", mesh_.weld, "Vertices within this distance become one [m] (0)");
    repair->callback([this] { status_ = experiments::mesh_repair(mesh_); });

    CLI::App* voxelize =
        mesh_subcommand(*mesh, "voxelize", "Label the voxels of a grid as inside or outside",
                        "haptrial mesh voxelize gear.ply gear.nrrd --resolution 135");
    add_mesh_input(*voxelize);
    voxelize->add_option("OUT", mesh_.out, "New volume (.nrrd, .h5)")->required();
    add_mesh_voxels(*voxelize);
    add_mesh_picture(*voxelize);
    voxelize->callback([this] { status_ = experiments::mesh_voxelize(mesh_); });

    add_mesh_distance(*mesh);

    CLI::App* split =
        mesh_subcommand(*mesh, "tetrahedralize", "Fill a mesh with tetrahedra, five to a voxel",
                        "haptrial mesh tetrahedralize gear.ply gear.vtu --resolution 40");
    add_mesh_input(*split);
    split->add_option("OUT", mesh_.out, "New mesh (.node with .ele, .vtu, .msh, .h5)")->required();
    add_mesh_voxels(*split);
    add_mesh_picture(*split);
    split->callback([this] { status_ = experiments::mesh_tetrahedralize(mesh_); });
  }

  void add_mesh_distance(CLI::App& mesh) {
    CLI::App* sub =
        mesh_subcommand(mesh, "distance", "Give every voxel its exact distance to the surface",
                        "haptrial mesh distance gear.ply gear-distance.nrrd --everywhere");
    add_mesh_input(*sub);
    sub->add_option("OUT", mesh_.out, "New volume of distances [m] (.nrrd, .h5)")->required();
    sub->add_option("--resolution", mesh_.voxels.resolution, "Voxels along the longest axis (100)");
    sub->add_option("--inside", mesh_.voxels.rule,
                    "auto, parity, winding or flood: what makes a voxel an inside one (auto)");
    sub->add_flag("--everywhere", mesh_.everywhere, "Outside too, where distances are positive");
    sub->add_option("--margin", mesh_.voxels.margin, "More voxels on every side (0)");
    sub->add_option("--points", mesh_.points, "Also a new volume of nearest points [m]");
    sub->add_option("--picture", mesh_.picture, "New picture of the slice in the middle (.png)");
    sub->add_option("--up", mesh_.up, "Axis that points up in it: x, y or z (y)");
    sub->callback([this] { status_ = experiments::mesh_distance(mesh_); });
  }

  void add_bone() {
    CLI::App* bone = subcommand(app_, "bone", "Import bones, make and draw them, say what they hold",
                                "haptrial bone make temporal ear.nrrd --seed 3");
    bone->require_subcommand(1);
    CLI::App* taking =
        subcommand(*bone, "import", "Make a bone of a CT or of labels",
                   "haptrial bone import head.nii.gz head.nrrd --threshold 300 --spacing 0.5");
    add_bone_input(*taking);
    add_bone_output(*taking);
    taking->callback([this] { status_ = experiments::bone_import(bone_); });

    CLI::App* info = subcommand(*bone, "info", "Say what a bone holds, structure by structure",
                                "haptrial bone info ear.nrrd");
    add_bone_input(*info);
    info->callback([this] { status_ = experiments::bone_info(bone_); });

    CLI::App* make = subcommand(*bone, "make", "Make a bone from shapes and a seed",
                                "haptrial bone make mandible jaw.nrrd --seed 2 --spacing 0.5");
    make->add_option("BONE", bone_.shape, "temporal or mandible")->required();
    add_bone_output(*make);
    make->add_option("--seed", bone_.seed, "Of the anatomy (1)");
    make->add_option("--spacing", bone_.spacing, "Edge of a voxel [mm] (0.5)");
    make->callback([this] { status_ = experiments::bone_make(bone_); });
    add_bone_picture(*bone);
    CLI::App* stages =
        subcommand(*bone, "stages", "Stills of a cavity, stage by stage, for participants",
                   "haptrial bone stages experiments/construct_validity.toml --out stills");
    stages->add_option("DEFINITION", bone_stages_.definition, "With a table [cavity] (.toml)")
        ->required();
    stages->add_option("--out", bone_stages_.out, "New folder")->required();
    stages->add_option("--count", bone_stages_.count, "Stills, the untouched bone first (4)");
    stages->callback([this] { status_ = experiments::bone_stages(bone_stages_); });
  }

  void add_bone_picture(CLI::App& bone) {
    CLI::App* sub = subcommand(bone, "picture", "Draw a bone, whole or drilled",
                               "haptrial bone picture ear.nrrd ear.png --from -1,0.2,0.1");
    auto& o = bone_picture_;
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
    sub->callback([this] { status_ = experiments::bone_picture(bone_picture_); });
  }

  void add_bone_input(CLI::App& sub) {
    sub.add_option("IN", bone_.in,
                   "Bone or volume (.nrrd, .nhdr, .nii, .nii.gz), or folder with a DICOM series")
        ->required();
    sub.add_option("--as", bone_.as, "auto, labels or grey: what its numbers are (auto)");
    sub.add_option("--spacing", bone_.spacing,
                   "Edge of a voxel [mm]; of grey volumes 0.5, of labels their own by default");
    sub.add_option("--threshold", bone_.threshold,
                   "Bone begins at this number, or auto (300 in Hounsfield units)");
    sub.add_option("--dense", bone_.dense,
                   "Bone is dense from this number on (1500 in Hounsfield units)");
    sub.add_option("--labels", bone_.labels, "Names of labels (.toml)");
    sub.add_option("--without", bone_.without, "Structures to leave out, by name")->delimiter(',');
    sub.add_option("--max-memory", bone_.max_memory,
                   "Refuse what may take more [GB]; what the system has by default");
  }

  void add_bone_output(CLI::App& sub) {
    sub.add_option("OUT", bone_.out, "New bone (.nrrd)")->required();
    sub.add_flag("--overwrite", bone_.overwrite, "Replace a file that is there");
  }

  CLI::App* mesh_subcommand(CLI::App& mesh, const char* name, const char* what,
                            const char* example) {
    CLI::App* sub = subcommand(mesh, name, what, example);
    sub->add_flag("--overwrite", mesh_.overwrite, "Replace files that are there");
    return sub;
  }

  void add_mesh_input(CLI::App& sub) {
    sub.add_option("IN", mesh_.input.file, "Mesh (.obj, .ply, .stl, .off)")->required();
    sub.add_option("--scale", mesh_.input.scale, "Metres to one unit of the file (1)");
    sub.add_option("--max-memory", mesh_.input.max_memory,
                   "Refuse what may take more [GB]; what the system has by default");
  }

  void add_mesh_voxels(CLI::App& sub) {
    sub.add_option("--resolution", mesh_.voxels.resolution, "Voxels along the longest axis (100)");
    sub.add_flag("--over", mesh_.voxels.over, "Go one voxel over the surface");
    sub.add_option("--inside", mesh_.voxels.rule,
                   "auto, parity, winding or flood: what makes a voxel an inside one (auto)");
  }

  void add_mesh_picture(CLI::App& sub) {
    sub.add_option("--picture", mesh_.picture, "New picture (.png)");
    sub.add_option("--up", mesh_.up, "Axis that points up in it: x, y or z (y)");
  }

  void add_spectrum() {
    CLI::App* sub = subcommand(app_, "spectrum", "Make a table of a drill's sound from a recording",
                               "haptrial spectrum drill.wav drill.toml --level free");
    sub->add_option("FILE", spectrum_.file, "Recording (.wav, .flac, .aiff)")->required();
    sub->add_option("OUT", spectrum_.out, "New table (.toml); printed only by default");
    sub->add_option("--burr", spectrum_.burr, "diamond or cutting (cutting)");
    sub->add_option("--level", spectrum_.level,
                    "Name of the level; 'free': the drill is in the air (typical)");
    sub->add_option("--force", spectrum_.force, "With which the burr pressed on bone [N] (0)");
    sub->add_option("--peaks", spectrum_.peaks, "At most so many (24)");
    sub->add_option("--segment", spectrum_.segment,
                    "Samples in a segment, a power of two; 40 ms or more by default");
    sub->add_flag("--add", spectrum_.add, "Add the level to the table that is there");
    sub->add_option("--wav", spectrum_.wav, "Also make a new sound from the peaks (.wav)");
    sub->add_option("--picture", spectrum_.picture, "Draw both spectra (.png, .svg)");
    sub->add_flag("--overwrite", spectrum_.overwrite, "Replace files that are there");
    sub->callback([this] { status_ = experiments::spectrum(spectrum_); });
  }

  void add_rate() {
    CLI::App* rate = subcommand(app_, "rate", "Let raters score drillings blindly",
                                "haptrial rate prepare out/validity-001 --sheets");
    rate->require_subcommand(1);
    CLI::App* prepare = rate->add_subcommand(
        "prepare", "Make films or sheets under random codes, a rating sheet and a sealed key");
    prepare->add_option("DIR", rate_prepare_.folder, "Folder of drilling sessions (.h5)")
        ->required();
    prepare->add_option("--out", rate_prepare_.out, "New folder for the raters (DIR-rating)");
    prepare->add_flag("--sheets", rate_prepare_.sheets, "Pictures in place of films");
    prepare->add_option("--frames", rate_prepare_.frames, "Pictures on a sheet (12)");
    prepare->add_option("--speed", rate_prepare_.speed, "Of films, times as fast as it went (8)");
    prepare->add_flag("--half-points", rate_prepare_.halves, "Allow scores such as 3.5");
    prepare->add_option("--jobs", rate_prepare_.jobs, "Threads; one per processor by default");
    prepare->callback([this] { status_ = experiments::rate_prepare(rate_prepare_); });
    CLI::App* import = rate->add_subcommand("import", "Read filled-in sheets into a study");
    import->add_option("SHEET", rate_import_.sheets, "Filled-in sheets (.csv), one for each rater")
        ->required();
    import->add_option("--study", rate_import_.folder, "Folder that was prepared")->required();
    import->add_flag("--overwrite", rate_import_.overwrite, "Replace ratings that are there");
    import->callback([this] { status_ = experiments::rate_import(rate_import_); });
    CLI::App* simulate = rate->add_subcommand(
        "simulate", "Let two simulated raters score a dry run by the written rubric");
    simulate->add_option("DIR", rate_simulate_.folder, "Folder of drilling sessions (.h5)")
        ->required();
    simulate->add_flag("--overwrite", rate_simulate_.overwrite, "Replace ratings that are there");
    simulate->add_option("--jobs", rate_simulate_.jobs, "Threads; one per processor by default");
    simulate->callback([this] { status_ = experiments::rate_simulate(rate_simulate_); });
  }

  CLI::App& app_;
  int& status_;
  experiments::DryRunOptions dry_run_;
  experiments::RunOptions run_;
  experiments::ReplayOptions replay_;
  experiments::PowerOptions power_;
  experiments::DeviceTestOptions device_test_;
  experiments::ExportOptions export_;
  experiments::AlignOptions align_;
  experiments::AnalyzeOptions analyze_;
  experiments::MeshOptions mesh_;
  experiments::BoneOptions bone_;
  experiments::BonePictureOptions bone_picture_;
  experiments::BoneStagesOptions bone_stages_;
  experiments::SpectrumOptions spectrum_;
  experiments::RatePrepareOptions rate_prepare_;
  experiments::RateImportOptions rate_import_;
  experiments::RateSimulateOptions rate_simulate_;
  std::string path_;
  std::string second_;
  std::string compare_out_;
  std::string recover_out_;
};  // namespace

/// A mistyped subcommand by its name, rather than as one that is missing.
void check_subcommand(CLI::App& app, int argc, char** argv) {
  std::string known;
  for (const CLI::App* sub : app.get_subcommands([](CLI::App*) { return true; })) {
    known += (known.empty() ? "" : ", ") + sub->get_name();
    if (argc > 1 && sub->get_name() == argv[1]) {
      return;
    }
  }
  if (argc > 1 && argv[1][0] != '-') {
    throw haptrial::InputError(
        fmt::format("'{}' is not a subcommand; allowed: {}", argv[1], known));
  }
}

int run_command(int argc, char** argv) {
  CLI::App app("Force-feedback experiments: run them, record them, know what they showed.");
  app.name("haptrial");
  app.set_version_flag("--version", fmt::format("haptrial {} ({})", experiments::program_version(),
                                                experiments::program_commit()));
  app.require_subcommand(1);
  app.footer("haptrial SUBCOMMAND --help shows an example of each.");
  int status = 0;
  const Commands commands(app, status);
  check_subcommand(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    complain(std::string(error.what()) + "; see haptrial --help");
    return kBadInput;
  }
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const int status = run_command(argc, argv);
    if (std::fflush(stdout) != 0) {
      throw haptrial::RunError("standard output cannot be written");
    }
    return status;
  } catch (const haptrial::InputError& error) {
    complain(error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    complain(error.what());
    return kFailed;
  }
}
