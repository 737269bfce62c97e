#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::everyday_test {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

inline const std::filesystem::path kFolder = HAPTRIAL_SOURCE_DIR "/docs/worked/everyday";

using Row = std::map<std::string, std::string>;

/// Fields of a line, of which some stand in quotes.
inline std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

inline double number_in(const Row& row, const std::string& column) {
  return std::stod(row.at(column));
}

inline double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value;
  }
  return sum / static_cast<double>(values.size());
}

/// Least-squares slope by the normal equations.
inline double slope_of(const std::vector<double>& x, const std::vector<double>& y) {
  double xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_of(x)) * (x[i] - mean_of(x));
    xy += (x[i] - mean_of(x)) * (y[i] - mean_of(y));
  }
  return xy / xx;
}

/// Quantile of the normal distribution, by bisection.
inline double normal_quantile(double p) {
  double low = -8.0, high = 8.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(-middle / std::sqrt(2.0)) < p ? low : high) = middle;
  }
  return low;
}

/// A staircase as Levitt describes it, walked through the outcomes of a track again.
struct Walk {
  int down;          // right answers to a step down
  std::size_t skip;  // first reversals that do not count
  double origin;     // of logarithmic levels
  bool logarithmic{true};

  double estimate(const std::vector<Row>& rows, const std::string& track) const {
    std::vector<double> reversals;
    int right = 0, direction = 0;
    for (const Row& row : rows) {
      if (row.at("track") != track) {
        continue;
      }
      right = number_in(row, "outcome") == 1.0 ? right + 1 : 0;
      const int step = right == 0 ? 1 : right == down ? -1 : 0;
      if (step * direction < 0) {
        const double level = number_in(row, "applied");
        reversals.push_back(logarithmic ? std::log10(level - origin) : level);
      }
      direction = step != 0 ? step : direction;
      right = step != 0 ? 0 : right;
    }
    reversals.erase(reversals.begin(), reversals.begin() + static_cast<std::ptrdiff_t>(skip));
    return logarithmic ? origin + std::pow(10.0, mean_of(reversals)) : mean_of(reversals);
  }
};

/// One experiment, rehearsed whole.
class EverydayTest : public testing::Test {
 protected:
  void rehearse(const std::string& name, int participants,
                const std::filesystem::path& folder = kFolder) {
    const std::string file = "'" + (folder / (name + ".toml")).string() + "'";
    out_ = folder_ / name;
    const auto valid = test::run_command("haptrial validate " + file);
    ASSERT_EQ(valid.status, 0) << valid.errors;
    EXPECT_THAT(valid.output, Not(HasSubstr("warning")));
    const auto run =
        test::run_command("haptrial dry-run " + file + " --subjects " +
                          std::to_string(participants) + " --out '" + out_.string() + "'");
    ASSERT_EQ(run.status, 0) << run.errors;
    EXPECT_THAT(run.output + run.errors, Not(HasSubstr("aborted")));
    const auto analysed = test::run_command("haptrial analyze '" + out_.string() + "'");
    ASSERT_EQ(analysed.status, 0) << analysed.errors;
    EXPECT_EQ(analysed.errors, "");
    for (const char* trouble : {"trials are missing", "could not be determined", "no mean, because",
                                "without an interval", "at an end of the range", "nan"}) {
      EXPECT_THAT(analysed.output, Not(HasSubstr(trouble)));
    }
    results_ = json::parse(test::read_text(out_ / "results.json"));
    expect_no_caution();
    read_trials();
  }

  /// Few trials make Bayesian fits say where their priors decide, some bootstrap samples tell
  /// nothing, and a few of many functions deviate from their answers by chance; no stated estimate
  /// needs another caution.
  void expect_no_caution() const {
    for (const json& function : results_.value("functions", json::array())) {
      for (const std::string warning : function["warnings"]) {
        EXPECT_THAT(warning, testing::AnyOf(testing::StartsWith("Bayesian fit: "),
                                            HasSubstr("bootstrap samples do not tell"),
                                            HasSubstr("as long as chance alone would make")));
      }
    }
  }

  void read_trials() {
    for (Row row : table_of("trials.csv")) {
      if (row["counted"] == "1") {
        trials_[row["participant"]].push_back(std::move(row));
      }
    }
  }
  /// Rows of a table that was written beside the report.
  std::vector<Row> table_of(const std::string& file) const {
    std::istringstream text(test::read_text(out_ / file));
    std::string line;
    std::getline(text, line);
    const std::vector<std::string> names = fields_of(line);
    std::vector<Row> rows;
    while (std::getline(text, line)) {
      const std::vector<std::string> fields = fields_of(line);
      Row& row = rows.emplace_back();
      for (std::size_t i = 0; i < names.size() && i < fields.size(); ++i) {
        row[names[i]] = fields[i];
      }
    }
    return rows;
  }

  const json& quantity(const std::string& name) const {
    for (const json& each : results_["quantities"]) {
      if (each["name"] == name) {
        return each;
      }
    }
    throw std::runtime_error("no quantity " + name);
  }
  /// Mean over participants under a condition. @param condition  "all": there is one
  double reported(const std::string& name, const std::string& condition = "all") const {
    for (const json& each : quantity(name)["conditions"]) {
      if (each["condition"] == condition) {
        return each["mean"]["mean"];
      }
    }
    throw std::runtime_error("no condition " + condition);
  }
  /// The same of one value of each participant, computed from the trials under the condition.
  template <class Value>
  double over_participants(Value&& value, const std::string& column = "",
                           const std::string& level = "") const {
    std::vector<double> values;
    for (const auto& [participant, rows] : trials_) {
      std::vector<Row> own;
      std::ranges::copy_if(rows, std::back_inserter(own), [&](const Row& row) {
        return column.empty() || row.at(column) == level;
      });
      values.push_back(value(own));
    }
    return mean_of(values);
  }
  /// The estimate of every track's procedure, by participant and track.
  std::map<std::pair<std::string, std::string>, double> estimates() const {
    std::map<std::pair<std::string, std::string>, double> all;
    for (const json& track : results_["tracks"]) {
      if (!track["estimates"].empty()) {
        all[{track["participant"], track["track"]}] = track["estimates"][0]["value"];
      }
    }
    return all;
  }

  void expect_staircases(const Walk& walk, std::size_t tracks) {
    const auto found = estimates();
    EXPECT_EQ(found.size(), tracks);
    for (const auto& [of, value] : found) {
      EXPECT_NEAR(value, walk.estimate(trials_[of.first], of.second), 1e-9 * value)
          << of.first << ", " << of.second;
    }
  }

  test::TemporaryFolder folder_;
  std::filesystem::path out_;
  json results_;
  std::map<std::string, std::vector<Row>> trials_;  // that counted, by participant
};

}  // namespace haptrial::everyday_test
