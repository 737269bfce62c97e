#pragma once

#include <optional>

namespace haptrial::experiments {

/// `value` if it lies from low to high. @throws InputError naming the argument `what`.
int checked_number(const char* what, int value, int low, int high);

/// The number of threads: --jobs, or one per processor.
int checked_jobs(std::optional<int> jobs);

}  // namespace haptrial::experiments
