#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/record/rows/session_types.h"
#include "experiments/command/mesh_command.h"

namespace haptrial::experiments {

/// The subcommands of haptrial: each prints to standard output and returns an exit status. Bad
/// input and failures come as InputError and RunError.

/// The shipped definitions.
int list_examples();

struct NewOptions {
  std::string file;
  std::string from{"first_experiment"};  // of the shipped definitions
};
int new_definition(const NewOptions& options);

/// What this machine can do. @param folder  where session files are to go
/// @returns 0 if sessions can run, else 1
int doctor(const std::string& folder);

struct DryRunOptions {
  std::string definition;
  std::optional<int> subjects;  // default: as the definition says
  std::string seed{"1"};
  std::optional<int> jobs;  // default: one per processor
  std::string out;          // default: a new folder out/NAME-001
  std::string parts;        // in its place, a folder that is gone on with
  int frames{0};
  std::optional<int> trials;       // default: all
  std::optional<int> session;      // of each subject; default: all, in their order
  std::string tutor;               // `FILE`, `FILE:TRIAL` or `FILE:TRIAL@SECONDS`; empty: none
  bool taught{false};              // each subject, by a second one over a simulated network
  std::string language;            // of what participants read; default: the definition's own
  std::vector<std::string> set{};  // KEY=VALUE of the definition
};
int dry_run(const DryRunOptions& options);

struct RunOptions {
  std::string definition;
  std::string subject;                          // empty: the next one of the roster
  std::vector<std::string> devices{"virtual"};  // in the order in which the protocol has them
  std::string library;                          // of the device's vendor, in place of the search
  std::string seed{"1"};
  std::optional<int> participant;  // default: the number at the end of the subject's identifier
  std::optional<int> session;      // default: the first that the subject has left
  std::string out;                 // default: out/sessions, out/teaching with --teach
  std::optional<int> trials;       // default: all
  std::string tutor;               // `FILE`, `FILE:TRIAL` or `FILE:TRIAL@SECONDS`; empty: none
  std::optional<int> teach;        // port at which the side that learns is awaited
  std::string learn_from;          // HOST:PORT of the side that teaches; empty: nobody
  std::string secret;              // file that both sides have
  bool console{false};
  std::vector<std::string> side_pages;  // of the protocol, beside the console
  bool keyboard{false};
  std::optional<std::string> address;  // of the console; default: the loopback's
  std::optional<int> port;             // of the console; default: any that is free
  bool remote{false};  // the console may listen on another address than the loopback's
  bool window{false};
  bool stream{false};
  bool stream_optional{false};
  bool resume{false};
  bool pilot{false};
  std::string language;  // of what the participant reads; default: the definition's own
  record::Participant person;
};
int run(const RunOptions& options);

/// Makes the file of a secret that two sides of a link share.
int make_secret(const std::string& file);

/// Who has done what in a study, and who is next.
struct RosterOptions {
  std::string definition;
  std::string folder;               // of session files
  std::optional<std::string> seed;  // of new participants; default: that of the sessions, or 1
  std::string json;                 // file for the same; empty: none
  std::string csv;                  // likewise, a row for each session
  std::string exclude;              // participant to be taken out before; empty: nobody
  std::string because;              // why
};
int roster(const RosterOptions& options);

struct ReplayOptions {
  std::string file;
  int trial{0};
  std::string phase;   // "training", "test"; empty: both
  std::string video;   // .mp4
  std::string frames;  // folder
  std::string sound;   // .wav, of a drilling
  int fps{30};
};
int replay(const ReplayOptions& options);

struct AnalyzeOptions {
  std::string folder;  // of session files; else the ones below
  std::string curves;  // folder of curves that something else recorded
  std::string conditions;
  std::string table;  // one table of all samples, in place of the two
  std::string out;
  std::string definition;            // for its [analysis]; default: as shipped
  std::vector<std::string> columns;  // "subject=Participant", of curves and table
  std::vector<std::string> factors;  // columns of the table; default: condition
  bool pilots{false};                // them alone, in place of the study
  std::vector<std::string> planned;  // in place of the definition's
  std::string reference;             // likewise
  std::optional<int> jobs;
};
int analyze(const AnalyzeOptions& options);

/// The tests that the design of a table calls for.
struct StatisticsOptions {
  std::string table;
  std::string subject{"subject"};    // columns
  std::vector<std::string> factors;  // default: condition
  std::string value{"score"};
  std::vector<std::string> planned;
  std::string reference;
  int resamples{9999};
  std::string seed{"1"};
  std::string json;  // file for the numbers
  std::optional<int> jobs;
};
int statistics(const StatisticsOptions& options);

/// Exactly one of bids, csv and curves names a new folder.
struct ExportOptions {
  std::vector<std::string> files;  // session files, or folders of them
  std::string bids;
  std::string csv;
  std::string curves;
  bool samples{false};               // of csv: every tick as well
  std::string name;                  // of the BIDS data set; default: the experiment's
  std::vector<std::string> authors;  // of the BIDS data set
  std::optional<int> jobs;
};
int export_sessions(const ExportOptions& options);

/// Two curves of any origin (.csv).
struct AlignOptions {
  std::string target;         // "-": standard input
  std::string applied;        // likewise, but not both
  std::string time;           // name of a column in both; see analysis::CurveColumns
  std::string value;          // likewise
  std::string applied_value;  // where the applied curve's name is another
  std::optional<double> rate;
  int samples{1000};
  double filter{0.1};
  double power{1.0};
  double slope_weight{0.5};
  std::optional<double> penalty;  // default: as the pattern is known
  std::string pattern{"published"};
  std::optional<double> window;
  bool open_begin{false};
  bool open_end{false};
  std::string out;  // new folder; empty: nothing is written
};
int align(const AlignOptions& options);

/// A recorded contact beside renderings of it.
struct EvaluateOptions {
  bool duck{false};       // the source's tables on a simulated duck, in place of it all
  std::string seed{"1"};  // of the duck
  std::vector<std::string> recording;  // one or two tables (.csv), their folder, a session file
  std::optional<std::string> object;   // of a session file
  std::optional<int> trial;            // likewise
  std::vector<std::string> tested_on;  // other recordings of the body, as `recording`
  std::string mesh;
  std::string units{"m"};              // of the mesh: m, cm, mm
  std::vector<std::string> renderers;  // default: all
  double stiffness{1000.0};            // [N/m]
  std::optional<double> friction;      // default: the best
  double rate{1000.0};                 // [Hz]
  int resolution{64};                  // of voxels and distance fields
  std::optional<double> shading;       // over edges less sharp than this [degrees]
  std::vector<double> tip;             // of the probe in the tracker's frame [mm]
  double radius{0.0};                  // of the tip's sphere [mm]
  std::vector<double> sensor;          // its orientation on the probe: w, x, y, z
  std::vector<double> free;            // without contact: from, to, from, to … [s]
  std::optional<double> lag;           // of the force's clock [ms]; default: estimated
  bool registered{false};              // poses are in the mesh's frame
  bool on_body{false};                 // forces are those on the body
  double threshold{1.0};               // of position errors [mm]
  std::vector<double> grating;         // wavelength [mm] and axis of a texture
  bool simulated{false};               // the recording is, and the report says so
  std::string out;                     // new folder; empty: nothing is written
};
int evaluate(const EvaluateOptions& options);

/// Two analysed studies.
struct CompareOptions {
  std::string first;  // folder
  std::string second;
  std::string out;                // folder for the page, the figure and the numbers; empty: none
  bool different_scoring{false};  // allowed, with an alarm
};
int compare(const CompareOptions& options);
int info(const std::string& file);
/// @param out  new session file; empty: beside the damaged one
/// @returns 0 when something was recovered, else 1.
int recover(const std::string& file, const std::string& out);
int validate(const std::string& definition);
/// @param protocol  empty: all
int keys(const std::string& protocol);

/// Two of an effect (delta and sd, or f), n and power; the third is computed.
struct PowerOptions {
  std::string test;                   // "t", "anova", "repeated"
  std::optional<std::string> design;  // of t: "two-sample" by default, "paired", "one-sample"
  std::optional<double> delta;        // difference of the means
  double sd{1.0};                     // in the same unit; of paired values that of the differences
  std::optional<double> f;            // of anova and repeated: Cohen's
  std::optional<int> groups;          // of anova; of repeated 1 if left out
  std::optional<std::string> effect;  // of repeated: "within" by default, "interaction", "between"
  std::optional<int> measurements;    // of repeated: conditions that everybody has
  std::optional<double> correlation;  // of repeated: of any two measurements
  std::optional<double> epsilon;      // of repeated: Greenhouse and Geisser's
  std::optional<long> n;              // participants in each group
  std::optional<double> power;
  double alpha{0.05};
  bool one_tailed{false};
};
int power(const PowerOptions& options);

int devices();

struct DeviceTestOptions {
  std::string name;
  std::string definition;  // whose set-up of the device is used; empty: the driver's defaults
  double seconds{120.0};
  std::string library;  // a path in place of the search for the vendor's library
};
/// @returns 0 when the device is fit for use, else 1.
int device_test(const DeviceTestOptions& options);

/// The subcommands of haptrial mesh.
struct MeshOptions {
  MeshInput input;
  std::string out;      // new file; its ending says the format
  std::string shape;    // make: sphere, torus, gear, rough
  std::string picture;  // new .png; empty: none
  std::string up{"y"};  // of pictures: x, y, z
  double weld{0.0};     // repair [m]
  VoxelizeOptions voxels;
  bool everywhere{false};  // distance: outside voxels too
  std::string points;      // distance: new volume of nearest points; empty: none
  bool overwrite{false};
};
int mesh_make(const MeshOptions& options);
int mesh_info(const MeshOptions& options);
int mesh_repair(const MeshOptions& options);
int mesh_voxelize(const MeshOptions& options);
int mesh_distance(const MeshOptions& options);
int mesh_tetrahedralize(const MeshOptions& options);

/// The subcommands of haptrial bone.
struct BoneOptions {
  std::string in;                    // bone, volume, or folder with a DICOM series
  std::string out;                   // new file (.nrrd)
  std::string shape;                 // make: temporal, mandible
  std::string seed{"1"};             // make
  std::optional<double> spacing;     // [mm]
  std::string as{"auto"};            // auto, labels, grey
  std::string threshold;             // of grey volumes: a number, or auto
  std::optional<double> dense;       // of grey volumes: the number of bone with density 1
  std::string labels;                // names of labels (.toml)
  std::vector<std::string> without;  // names of structures that are left out
  bool mirror{false};                // left and right are exchanged
  std::optional<double> max_memory;  // [GB]
  bool overwrite{false};
};
int bone_info(const BoneOptions& options);
int bone_make(const BoneOptions& options);

/// A picture of a bone off screen.
struct BonePictureOptions {
  std::string in;
  std::string out;                   // new .png
  std::vector<std::string> without;  // names of structures that are left out
  std::vector<std::string> drill;    // strokes: see experiments/command/tools/bone_carving.h
  std::vector<std::string> cut;      // planes
  bool spare{false};                 // nothing but bone is drilled or cut
  std::vector<double> from{-1.0, 0.2, 0.1};  // towards the eye: the side of a right ear
  std::vector<double> at;                    // what is in the middle [mm]; default: the bone's
  double zoom{1.0};
  std::string burr;              // from its centre to a place on its handle
  std::optional<double> stereo;  // between the eyes [mm]
  int width{1280};               // [px]
  int height{720};
  std::optional<double> max_memory;  // [GB]
  bool overwrite{false};
};
int bone_picture(const BonePictureOptions& options);

struct BoneStagesOptions {
  std::string definition;
  std::string out;  // new folder
  int count{4};     // of stills
};
int bone_stages(const BoneStagesOptions& options);

/// The subcommands of haptrial rate.
struct RatePrepareOptions {
  std::string folder;  // of drilling sessions
  std::string out;     // new folder for the raters; default: beside the study's
  bool sheets{false};  // pictures in place of films
  bool halves{false};  // half points are allowed
  int frames{12};      // on a sheet
  double speed{8.0};   // of films, times as fast as it went
  std::optional<int> jobs;
};
int rate_prepare(const RatePrepareOptions& options);

struct RateImportOptions {
  std::string folder;               // of the study
  std::vector<std::string> sheets;  // one for each rater
  bool overwrite{false};
};
int rate_import(const RateImportOptions& options);

struct RateSimulateOptions {
  std::string folder;  // of a study
  std::optional<int> jobs;
  bool overwrite{false};
};
int rate_simulate(const RateSimulateOptions& options);

struct SpectrumOptions {
  std::string file;              // a recording
  std::string out;               // table of spectra (.toml); empty: only print
  std::string burr{"cutting"};   // diamond, cutting
  std::string level{"typical"};  // of the table; "free": in the air
  double force{0.0};             // of a level in contact [N]
  int peaks{24};
  int segment{0};       // samples; 0: 40 ms or more
  bool add{false};      // to the table that is there
  std::string wav;      // new sound from the peaks; empty: none
  std::string picture;  // new .png or .svg; empty: none
  bool overwrite{false};
};
int spectrum(const SpectrumOptions& options);

}  // namespace haptrial::experiments
