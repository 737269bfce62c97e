#include "core/record/read/trial_facts_of.h"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace haptrial::record {
namespace {

/// All the numbers in a text.
std::vector<double> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  for (std::size_t at = 0; (at = text.find_first_of("0123456789", at)) != text.npos;) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), value);
    if (error != std::errc{}) {
      return {};
    }
    numbers.push_back(value);
    at = static_cast<std::size_t>(end - text.data());
  }
  return numbers;
}

/// "trial=3 practice=0 condition=haptic"
std::vector<SkippedRow> skipped_in(const std::vector<EventRow>& events) {
  std::vector<SkippedRow> rows;
  for (const EventRow& event : events) {
    const std::vector<double> numbers =
        event.kind == "skipped" ? numbers_in(event.text) : std::vector<double>();
    if (numbers.size() >= 2) {
      rows.push_back({event.time_ns, static_cast<std::int32_t>(numbers[0]), numbers[1] != 0.0});
    }
  }
  return rows;
}

/// "trial 3: damping fell to 0.052 of the definition's, and was reduced for 1.250 s of the run"
std::vector<DampingRow> damping_in(const std::vector<EventRow>& events) {
  std::vector<DampingRow> rows;
  for (const EventRow& event : events) {
    const std::vector<double> numbers =
        event.kind == "damping_reduced" ? numbers_in(event.text) : std::vector<double>();
    if (numbers.size() == 3) {
      rows.push_back(
          {event.time_ns, static_cast<std::int32_t>(numbers[0]), numbers[1], numbers[2]});
    }
  }
  return rows;
}

}  // namespace

std::vector<SkippedRow> skipped_trials(const SessionReader& reader) {
  std::vector<SkippedRow> rows = reader.has(table_of<SkippedRow>()) ? reader.rows<SkippedRow>()
                                                                    : skipped_in(reader.events());
  std::vector<SkippedRow> once;
  for (const SkippedRow& row : rows) {
    if (std::ranges::none_of(once, [&](const SkippedRow& other) {
          return other.trial == row.trial && other.practice == row.practice;
        })) {
      once.push_back(row);
    }
  }
  return once;
}

std::vector<DampingRow> reduced_damping(const SessionReader& reader) {
  return reader.has(table_of<DampingRow>()) ? reader.rows<DampingRow>()
                                            : damping_in(reader.events());
}

}  // namespace haptrial::record
