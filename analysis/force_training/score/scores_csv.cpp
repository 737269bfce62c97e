#include "analysis/force_training/score/scores_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>

#include "analysis/quality/trial_quality.h"
#include "core/base/error.h"

namespace haptrial::analysis {
namespace {

// The levels of several factors stand between the two.
constexpr std::string_view kTrial = "subject,trial,block,repetition,condition,";
constexpr std::string_view kScore = "score,alignment_cost,rms_force,rms_slope,rms_unaligned";
constexpr std::size_t kFixedColumns = 10;

/// The columns of a trial's quality, which tables of older versions do not have.
const std::string& quality_heading() {
  static const std::string heading = [] {
    std::string names;
    for (const QualityColumn& column : quality_columns()) {
      names += fmt::format(",{}", column.name);
    }
    return names + ",flags";
  }();
  return heading;
}

/// Columns of studies that recall a path.
constexpr std::string_view kPath = ",path_error,kept";

/// The column of studies with several sessions that train: numbers of trials are a session's.
constexpr std::string_view kSession = ",session";

bool has_sessions(std::span<const TrialScore> scores) {
  return std::ranges::adjacent_find(scores, std::ranges::not_equal_to(), &TrialScore::session) !=
         scores.end();
}

bool has_paths(std::span<const TrialScore> scores) {
  return std::any_of(scores.begin(), scores.end(),
                     [](const TrialScore& s) { return s.path_error || s.kept; });
}

std::string cell(const std::optional<double>& value) {
  return value ? fmt::format(",{}", *value) : std::string(",");
}

bool has_columns(std::span<const std::string> factors) { return factors.size() > 1; }

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
  /// @returns the names of the factors.
  std::vector<std::string> heading() {
    if (!rest_.starts_with(kTrial)) {
      fail(kNoHeading);
    }
    rest_.remove_prefix(kTrial.size());
    std::vector<std::string> factors;
    while (!rest_.starts_with(kScore)) {
      const std::size_t end = rest_.find('\n');
      if (end == rest_.npos || rest_.substr(0, end).find(',') == rest_.npos) {
        fail(kNoHeading);
      }
      factors.push_back(text(','));
    }
    rest_.remove_prefix(kScore.size());
    levels_ = factors.size();
    columns_ = kFixedColumns + levels_;
    has_quality_ = rest_.starts_with(quality_heading());
    if (has_quality_) {
      rest_.remove_prefix(quality_heading().size());
      columns_ += quality_columns().size() + 1;
    }
    has_path_ = has_quality_ && rest_.starts_with(kPath);
    if (has_path_) {
      rest_.remove_prefix(kPath.size());
      columns_ += 2;
    }
    has_session_ = has_quality_ && rest_.starts_with(kSession);
    if (has_session_) {
      rest_.remove_prefix(kSession.size());
      columns_ += 1;
    }
    if (!rest_.starts_with('\n')) {
      fail(kNoHeading);
    }
    rest_.remove_prefix(1);
    return factors.empty() ? std::vector<std::string>{"condition"} : factors;
  }
  TrialScore row() {
    ++line_;
    TrialScore s;
    s.subject = text(',');
    for (std::int32_t* value : {&s.trial, &s.block, &s.repetition}) {
      *value = number<std::int32_t>(',');
    }
    s.condition = text(',');
    for (std::size_t k = 0; k < levels_; ++k) {
      s.levels.push_back(text(','));
    }
    if (s.levels.empty()) {
      s.levels = {s.condition};
    }
    for (double* value : {&s.score, &s.alignment_cost, &s.rms_force, &s.rms_slope}) {
      *value = number<double>(',');
    }
    s.rms_unaligned = number<double>(has_quality_ ? ',' : '\n');
    if (has_quality_) {
      for (const QualityColumn& column : quality_columns()) {
        column.field(s.quality) = optional_number(',');
      }
      text(has_path_ || has_session_ ? ',' : '\n');  // the flags follow from the numbers
    }
    if (has_path_) {
      s.path_error = optional_number(',');
      s.kept = optional_number(has_session_ ? ',' : '\n');
    }
    if (has_session_) {
      s.session = number<std::int32_t>('\n');
    }
    return s;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}; analyse the study again with haptrial analyze", file_,
                                 line_, what));
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
      fail(fmt::format("the row does not have its {} fields", columns_));
    }
    rest_.remove_prefix(1);
    return result;
  }

  std::optional<double> optional_number(char end) {
    const std::string found = text(end);
    return found.empty() ? std::nullopt : std::optional(number_of<double>(found));
  }

  template <class T>
  T number(char end) {
    return number_of<T>(text(end));
  }

  template <class T>
  T number_of(const std::string& found) {
    T value{};
    const auto [rest, error] = std::from_chars(found.data(), found.data() + found.size(), value);
    if (error != std::errc{} || rest != found.data() + found.size() ||
        !std::isfinite(static_cast<double>(value))) {
      fail(fmt::format("'{}' is not a number", found));
    }
    return value;
  }

  static constexpr const char* kNoHeading = "is not the heading of a table of scores";

  std::string_view rest_;
  const std::string& file_;
  int line_{1};
  std::size_t columns_{kFixedColumns};
  std::size_t levels_{0};
  bool has_quality_{false};
  bool has_path_{false};
  bool has_session_{false};
};

}  // namespace

ScoresTable read_scores_csv(std::string_view text, const std::string& file_name) {
  Reader reader(text, file_name);
  ScoresTable table;
  table.factors = reader.heading();
  while (!reader.at_end()) {
    table.scores.push_back(reader.row());
  }
  return table;
}

std::string scores_csv(std::span<const TrialScore> scores, std::span<const std::string> factors) {
  std::string text(kTrial);
  const auto columns = has_columns(factors) ? factors : std::span<const std::string>{};
  for (const std::string& factor : columns) {
    text += field(factor) + ",";
  }
  text += kScore;
  const bool paths = has_paths(scores);
  const bool sessions = has_sessions(scores);
  text += quality_heading();
  text += std::string(paths ? kPath : "") + std::string(sessions ? kSession : "") + "\n";
  for (const auto& s : scores) {
    text += fmt::format("{},{},{},{},{},", field(s.subject), s.trial, s.block, s.repetition,
                        field(s.condition));
    for (std::size_t k = 0; k < columns.size(); ++k) {
      text += field(s.levels.at(k)) + ",";
    }
    text += fmt::format("{},{},{},{},{}", s.score, s.alignment_cost, s.rms_force, s.rms_slope,
                        s.rms_unaligned);
    for (const QualityColumn& column : quality_columns()) {
      text += cell(column.of(s.quality));
    }
    text += "," + field(flag_names(s.quality));
    text += paths ? cell(s.path_error) + cell(s.kept) : "";
    text += (sessions ? fmt::format(",{}", s.session) : "") + "\n";
  }
  return text;
}

}  // namespace haptrial::analysis
