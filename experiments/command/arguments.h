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

/// @throws InputError if `file` exists and may not be overwritten; no file is always new.
void check_new(const std::string& file, bool overwrite);
/// Checks a figure likewise, .png or .svg.
void check_new_figure(const std::string& file, bool overwrite);

/// The number of threads: --jobs, or one per processor.
int checked_jobs(std::optional<int> jobs);
inline constexpr const char* kJobsHelp = "Number of threads (default: one per processor)";

}  // namespace haptrial::experiments
