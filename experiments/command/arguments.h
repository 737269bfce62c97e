#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace haptrial::experiments {

/// `value` if it lies from low to high. @throws InputError naming the argument `what`.
int checked_number(const char* what, int value, int low, int high);

double checked_real(const char* what, double value, double low, double high);

/// A seed from its text. @throws InputError unless it is a whole number that 64 bits hold.
std::uint64_t checked_seed(const std::string& text);

/// The number of threads: --jobs, or one per processor.
int checked_jobs(std::optional<int> jobs);

}  // namespace haptrial::experiments
