#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/deformable/calibration/calibrate.h"
#include "experiments/command/deform/calibration_loads.h"

namespace haptrial::experiments {

/// Measures of a calibration under one load.
struct JudgedLoad {
  std::string name;
  LoadPart part{LoadPart::kSeen};
  std::string reference;  // who said where the body is: "elements", or a file
  bool markers{false};    // compared at measured places instead of vertices
  double moved{};         // root mean square of the reference's displacements [m]
  double hand{};          // error of the constants set by hand; infinite: unstable [m]
  double found{};         // error of those found [m]
  double shape{NAN};      // error of those found after the best rigid motion [m]
  double force{NAN};      // error of the force at the tool for its way, relative
  std::string unstable;   // why those found are not, if so
  std::vector<Eigen::Vector3d> at_reference, at_hand, at_found;  // vertices; empty: no rest
};

/// A calibration and what it was made of.
struct CalibrationRun {
  std::string method, constants, share, measure;  // as the options say
  std::array<double, 3> hand{};                   // set by hand [J]
  deformable::SearchRange range;                  // of the common logarithms
  std::uint64_t seed{};
  deformable::CalibrationResult result;
  deformable::SpringConstants springs;  // found
  double seconds{};                     // of the search in this run
  std::size_t earlier{};                // evaluations of a run before
  double tighter{};                     // change of the error by a rest a hundred times tighter [m]
  std::vector<JudgedLoad> loads;
  bool simulated{false};
};

/// Sets the measures of all loads with the constants set by hand and those found.
void judge_loads(const std::vector<AnsweredLoad>& loads, const deformable::SpringBody& springs,
                 const deformable::SpringConstants& hand, int threads, CalibrationRun& run);

/// The errors before and after, over the loads that calibration saw [m]; infinite: unstable.
double seen_error(const CalibrationRun& run, bool by_hand);

/// The error found as a share of the motion, the mean over the loads of one part; NaN without any,
/// infinite: unstable.
double share_left(const CalibrationRun& run, LoadPart part);

/// The evaluations of a calibration in a file that grows by one line each, so that a run that was
/// killed goes on. A line that was not finished is left out.
class CalibrationJournal {
 public:
  /// @param what  a number that differs for another body, load, search or reference
  /// @throws InputError where the file is another calibration's, or is no journal.
  CalibrationJournal(std::filesystem::path file, std::uint64_t what, std::size_t parameters);

  const std::vector<deformable::CalibrationStep>& known() const { return known_; }
  /// @throws RunError when the disk is full.
  void add(const deformable::CalibrationStep& step);
  /// The file is not needed any more.
  void remove();

 private:
  void read(const std::string& text, const std::string& head, std::size_t parameters);
  std::filesystem::path file_;
  std::vector<deformable::CalibrationStep> known_;
  std::ofstream out_;
};

/// A table of evaluations: error [mm], best so far, what was unstable, and the logarithms.
std::string evaluations_csv(const std::vector<deformable::CalibrationStep>& steps);

}  // namespace haptrial::experiments
