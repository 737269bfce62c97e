#pragma once

#include <optional>
#include <string>

#include "core/record/session_types.h"
#include "experiments/mesh_command.h"

namespace haptrial::experiments {

/// The subcommands of haptrial: each prints to standard output and returns an exit status. Bad
/// input and failures come as InputError and RunError.

struct DryRunOptions {
  std::string definition;
  std::optional<int> subjects;  // default: as the definition says
  std::string seed{"1"};
  std::optional<int> jobs;  // default: one per processor
  std::string out;          // default: a new folder out/NAME-001
  int frames{0};
  int trials{0};
};
int dry_run(const DryRunOptions& options);

struct RunOptions {
  std::string definition;
  std::string subject;
  std::string device{"virtual"};
  std::string seed{"1"};
  std::optional<int> participant;  // default: the number at the end of the subject's identifier
  std::string out{"out/sessions"};
  int trials{0};
  bool console{false};
  bool keyboard{false};
  std::string address{"127.0.0.1"};
  int port{0};         // of the console; 0: any that is free
  bool remote{false};  // the console may listen on another address than the loopback's
  bool window{false};
  bool stream{false};
  bool resume{false};
  record::Participant person;
};
int run(const RunOptions& options);

struct ReplayOptions {
  std::string file;
  int trial{0};
  std::string phase;   // "training", "test"; empty: both
  std::string video;   // .mp4
  std::string frames;  // folder
  int fps{30};
};
int replay(const ReplayOptions& options);

int analyze(const std::string& folder, std::optional<int> jobs);
/// @param out  folder for the page, the figure and the numbers; empty: only print
int compare(const std::string& first, const std::string& second, const std::string& out);
int info(const std::string& file);
/// @param out  new session file; empty: beside the damaged one
/// @returns 0 when something was recovered, else 1.
int recover(const std::string& file, const std::string& out);
int validate(const std::string& definition);
int devices();

struct DeviceTestOptions {
  std::string name;
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

}  // namespace haptrial::experiments
