#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

#include "core/deformable/calibration/calibrate.h"

namespace haptrial::experiments {

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
