#include "core/record/rows/damping_event.h"

#include <fmt/format.h>

#include <charconv>
#include <vector>

namespace haptrial::record {

std::string to_text(const DampingReduced& d) {
  return fmt::format(
      "trial {}: damping fell to {:.3f} of the definition's, and was reduced for {:.3f} s of the "
      "run",
      d.trial, d.least, d.seconds);
}

std::optional<DampingReduced> damping_reduced_of(std::string_view text) {
  std::vector<double> numbers;
  for (std::size_t at = 0; (at = text.find_first_of("0123456789", at)) != text.npos;) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), value);
    if (error != std::errc{}) {
      return std::nullopt;
    }
    numbers.push_back(value);
    at = static_cast<std::size_t>(end - text.data());
  }
  if (numbers.size() != 3) {
    return std::nullopt;
  }
  return DampingReduced{static_cast<int>(numbers[0]), numbers[1], numbers[2]};
}

}  // namespace haptrial::record
