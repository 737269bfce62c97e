#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "experiments/power/power_folder.h"

namespace haptrial::experiments {

/// Share of the work that a process does.
struct PowerShare {
  int jobs{1};
  int part{1}, of{1};               // the units part - 1, part - 1 + of, …
  double start{0.0};                // share of them that comes last: other processes begin there
  std::optional<double> minutes{};  // begins no other unit afterwards
};

struct PowerProgress {
  std::size_t made{0};     // parts by this process
  std::size_t missing{0};  // that are left, of all processes
  std::uint64_t trials{0};
  double seconds{0.0};
  bool stopped{false};  // out of time, or interrupted
};

/// Asks one study whether its report has the test. @throws InputError naming the tests that it has
void check_watched(const PowerQuestion& question);

/// Makes the missing parts of this share, those aside that another process makes meanwhile, and
/// waits for these; if it dies they are made here. An interrupt ends it: units that are under way
/// are given up, those that are done stay. @throws RunError on a full disk, InputError for a bad
/// cell
PowerProgress fill(const PowerFolder& folder, const PowerQuestion& question,
                   const PowerShare& share);

}  // namespace haptrial::experiments
