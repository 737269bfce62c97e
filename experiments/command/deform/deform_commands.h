#pragma once

#include <optional>
#include <string>
#include <vector>

namespace haptrial::experiments {

/// The subcommands of haptrial deform: each prints to standard output and returns an exit status.
/// Bad input and failures come as InputError and RunError.

/// Input of every one of these commands.
struct DeformInput {
  std::string file;                  // .toml that states a body; of info also a mesh
  std::optional<double> max_memory;  // [GB]; default: what the system has free
};

struct DeformInfoOptions {
  DeformInput input;
  int resolution{20};             // cubes, of a surface mesh
  double scale{1.0};              // of a mesh
  std::vector<double> constants;  // of springs: length, area, volume [J]; none: no springs
};
int deform_info(const DeformInfoOptions& options);

struct DeformReferenceOptions {
  DeformInput input;
  std::string out;                 // new folder
  std::vector<std::string> loads;  // names; none: all
  std::string model{"static"};     // static, dynamic
  double seconds{1.0};             // of dynamic
  double step{1e-3};               // likewise [s]
  double damping{0.0};             // likewise, by mass [1/s]
};
int deform_reference(const DeformReferenceOptions& options);

struct DeformCalibrateOptions {
  DeformInput input;
  std::string out;                       // new folder
  std::string constants{"homogeneous"};  // homogeneous, grid, elements
  std::vector<int> grid;                 // nodes; none: 5 5 3
  std::string method{"descent"};         // descent, annealing
  std::optional<int> evaluations;        // default: 1000 of annealing, 200 of descent
  std::optional<int> samples;            // coarse ones of the annealing; default: 100
  int batch{1};                          // its candidates at once
  std::vector<double> range;             // of the common logarithms; none: from the material
  std::vector<double> hand;              // constants set by hand [J]; none: from the material
  double enough{0.0};                    // ends at this error [mm]
  std::string seed{"1"};
  std::optional<int> jobs;
};
int deform_calibrate(const DeformCalibrateOptions& options);

struct DeformSimulateOptions {
  DeformInput input;
  std::string out;               // new folder
  std::string load;              // name; empty: the first
  std::string model{"springs"};  // springs, elements
  std::string constants;         // constants.csv of a calibration; empty: the three below
  std::vector<double> three;     // length, area, volume [J]
  double seconds{1.0};           // at most, if it goes to rest
  bool to_rest{false};           // ends when the body rests
  int frames{20};                // over the seconds
  std::optional<double> step;    // [s]; default: half the stable one of springs, 1 ms of elements
  double damping{20.0};          // by mass [1/s]
};
int deform_simulate(const DeformSimulateOptions& options);

struct DeformSkinOptions {
  DeformInput input;
  std::string surface;              // mesh
  std::vector<std::string> states;  // displacements (.csv)
  std::string out;                  // new folder
  double scale{1.0};                // of the surface
  int neighbours{5};
  std::string format{"ply"};  // of the meshes written
};
int deform_skin(const DeformSkinOptions& options);

}  // namespace haptrial::experiments
