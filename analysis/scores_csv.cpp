#include "analysis/scores_csv.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "core/base/error.h"

namespace haptrial::analysis {
namespace {

constexpr std::string_view kHeading =
    "subject,trial,block,repetition,condition,score,alignment_cost,rms_force,rms_slope,"
    "rms_unaligned\n";

std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    return text;
  }
  std::string result = "\"";
  for (const char c : text) {
    result += c;
    if (c == '"') {
      result += '"';
    }
  }
  return result + "\"";
}

/// Takes a table apart, field by field.
class Reader {
 public:
  Reader(std::string_view text, const std::string& file) : rest_(text), file_(file) {}

  bool at_end() const { return rest_.empty(); }
  void heading() {
    if (!rest_.starts_with(kHeading)) {
      fail("is not the heading of a table of scores");
    }
    rest_.remove_prefix(kHeading.size());
  }
  TrialScore row() {
    ++line_;
    TrialScore s;
    s.subject = text(',');
    for (std::int32_t* value : {&s.trial, &s.block, &s.repetition}) {
      *value = number<std::int32_t>(',');
    }
    s.condition = text(',');
    for (double* value : {&s.score, &s.alignment_cost, &s.rms_force, &s.rms_slope}) {
      *value = number<double>(',');
    }
    s.rms_unaligned = number<double>('\n');
    return s;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(
        fmt::format("{}:{}: {}; allowed: what haptrial analyze writes", file_, line_, what));
  }

  std::string text(char end) {
    std::string result;
    const bool quoted = rest_.starts_with('"');
    rest_.remove_prefix(quoted ? 1 : 0);
    while (!rest_.empty()) {
      const char c = rest_.front();
      if (quoted && rest_.starts_with("\"\"")) {
        rest_.remove_prefix(1);
      } else if (quoted ? c == '"' : c == end) {
        rest_.remove_prefix(quoted ? 1 : 0);
        break;
      } else if (!quoted && c == '\n') {
        break;
      }
      result += c;
      rest_.remove_prefix(1);
    }
    if (!rest_.starts_with(end)) {
      fail("the row does not have its ten fields");
    }
    rest_.remove_prefix(1);
    return result;
  }

  template <class T>
  T number(char end) {
    const std::string found = text(end);
    T value{};
    const auto [rest, error] = std::from_chars(found.data(), found.data() + found.size(), value);
    if (error != std::errc{} || rest != found.data() + found.size() ||
        !std::isfinite(static_cast<double>(value))) {
      fail(fmt::format("'{}' is not a number", found));
    }
    return value;
  }

  std::string_view rest_;
  const std::string& file_;
  int line_{1};
};

}  // namespace

std::vector<TrialScore> read_scores_csv(std::string_view text, const std::string& file_name) {
  Reader reader(text, file_name);
  reader.heading();
  std::vector<TrialScore> scores;
  while (!reader.at_end()) {
    scores.push_back(reader.row());
  }
  return scores;
}

std::string scores_csv(std::span<const TrialScore> scores) {
  std::string text(kHeading);
  for (const auto& s : scores) {
    text += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", field(s.subject), s.trial, s.block,
                        s.repetition, field(s.condition), s.score, s.alignment_cost, s.rms_force,
                        s.rms_slope, s.rms_unaligned);
  }
  return text;
}

}  // namespace haptrial::analysis
