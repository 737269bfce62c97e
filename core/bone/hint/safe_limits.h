#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace haptrial::hint {

/// Values that nearly all experts stayed below at [from, to) from a structure.
struct SafeInterval {
  double from{0.0}, to{0.0};  // distance of the removed voxel [m]
  double force{0.0};          // of the burr on bone [N]
  double speed{0.0};          // of its tip [m/s]
};

/// A structure and the intervals of which experts say something, ascending.
struct SafeStructure {
  std::string name;
  std::vector<SafeInterval> intervals;

  /// Null where nothing is known. Any thread; does not allocate.
  const SafeInterval* at(double distance) const noexcept;
};

/// Greatest safe forces and speeds near structures, learned from experts. A file carries them from
/// the analysis of a study to the sessions of another. Source: Morris 2006, §3.5.2.
struct SafeLimits {
  std::string study;            // from which they were learned
  std::size_t participants{0};  // experts
  std::size_t procedures{0};    // theirs
  double share{0.95};           // of the experts' removals that stayed below each limit, 0 to 1
  bool simulated{false};        // an expert was a program
  std::vector<SafeStructure> structures;

  /// Null for a structure of which nothing is known.
  const SafeStructure* of(const std::string& name) const noexcept;
};

/// The text of such a file (TOML, SI units).
std::string safe_limits_text(const SafeLimits& limits);

/// @throws InputError with a sentence for every problem of the file.
SafeLimits load_safe_limits(const std::filesystem::path& file);

}  // namespace haptrial::hint
