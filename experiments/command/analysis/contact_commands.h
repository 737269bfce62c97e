#pragma once

#include <optional>
#include <string>
#include <vector>

namespace haptrial::experiments {

// Each subcommand prints to standard output and returns an exit status. Bad input and failures come
// as InputError and RunError.

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
  std::vector<double> load;            // known: weight in W, offset of the sensor, x y z each [N]
  std::optional<double> lag;           // of the force's clock [ms]; default: estimated
  bool registered{false};              // poses are in the mesh's frame
  bool on_body{false};                 // forces are those on the body
  double threshold{1.0};               // of position errors [mm]
  std::vector<double> grating;         // wavelength [mm] and axis of a texture
  bool simulated{false};               // the recording is, and the report says so
  std::string out;                     // new folder; empty: nothing is written
};
int evaluate(const EvaluateOptions& options);

}  // namespace haptrial::experiments
