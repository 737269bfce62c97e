#include "analysis/statistics/design/design_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string_view>

#include "analysis/files/csv.h"
#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/design/wording.h"
#include "core/base/error.h"

namespace haptrial::analysis {
namespace {

constexpr double kAlpha = 0.05;

/// Ends a line of a study that its rule ends, as no p value but the rule's own allows for that.
const char* as_if_fixed(const DesignTests& tests) {
  return tests.ends_by_rule ? "; p and intervals as if the number of participants had been fixed"
                            : "";
}

/// The F of two conditions is the square of the t that may decide when the study ends, so that an
/// effect beside a rule has no verdict of its own.
std::string line_of(const DesignTests& tests, const Defined<EffectTest>& effect) {
  if (!effect) {
    return "Whether conditions differ is not defined, because " + effect.because() + ".";
  }
  const char* verdict = tests.ends_by_rule   ? ""
                        : effect->p < kAlpha ? "significant; "
                                             : "not shown; ";
  return fmt::format("Effect of {}: {}{}{}", effect->factor, verdict, effect_result(*effect),
                     as_if_fixed(tests));
}

bool decides(const SequentialResult& rule, const SideTest& test) {
  return text_of(rule.test) == text_of(test.sides);
}

/// A test is significant by its p, but the one that decides when a study ends by its rule alone.
bool is_significant(const SideTest& test, const std::optional<SequentialResult>& rule) {
  return rule && decides(*rule, test) ? rule->verdict == SequentialVerdict::kEffect
                                      : *test.holm < kAlpha;
}

/// A test that finds nothing says what it cannot exclude.
std::string line_of(const DesignTests& tests, const SideTest& test) {
  const std::optional<SequentialResult>& rule = tests.sequential;
  const std::string name = capitalized(tests.planned.name) + ", " + text_of(test.sides);
  if (!test.t || !test.holm) {
    return fmt::format("{}: not defined, because {}", name, test.t.because());
  }
  const std::string result = side_result(test) + as_if_fixed(tests);
  if (is_significant(test, rule)) {
    return fmt::format("{}: significant; {}", name, result);
  }
  const bool open = rule && decides(*rule, test) && rule->verdict == SequentialVerdict::kGoOn;
  return fmt::format("{}: {}, and differences up to {} are compatible with the data; {}", name,
                     open ? "not decided yet" : "not shown",
                     number(std::max(-test.t->low, test.t->high)), result);
}

bool is_planned(const DesignTests& tests, const PlannedTest& sides) {
  return std::ranges::any_of(tests.planned.tests, [&](const SideTest& planned) {
    return std::minmax(planned.sides.a, planned.sides.b) == std::minmax(sides.a, sides.b);
  });
}

std::string line_of_cell(const DesignTable& table, std::size_t cell) {
  std::vector<double> means;
  for (const auto& row : table.means) {
    if (row[cell]) {
      means.push_back(*row[cell]);
    }
  }
  return fmt::format("{}: mean {} ({}, {})", table.names[cell],
                     mean_with_interval(mean_and_interval(means)),
                     counted(means.size(), "participant"), counted(table.counts[cell], "value"));
}

/// "visual < haptic", "haptic and visual".
std::string sides_of(const SideTest& test) {
  return test.sides.tail == Tail::kTwoSided ? test.sides.a + " and " + test.sides.b
                                            : text_of(test.sides);
}

/// Whether one reason leaves nothing of a test, so that it need not be said of each number.
bool is_undefined(const SideTest& test) {
  return !test.t && !test.ranks && test.ranks.because() == test.t.because();
}

std::vector<std::string> lines_of(const TestFamily& family) {
  std::vector<std::string> lines{capitalized(family.name) + ":"};
  for (const SideTest& test : family.tests) {
    if (is_undefined(test)) {
      lines.push_back(fmt::format("  {}: {}", sides_of(test), side_result(test)));
      continue;
    }
    lines.push_back(fmt::format("  {}: {}; {}{}", sides_of(test), side_result(test),
                                test.paired ? "d_z" : "d",
                                (test.size ? " = " : " ") + effect(test.size)));
    lines.push_back(fmt::format("    {} {}; permutation {}; bootstrap 95 % CI {}",
                                test.paired ? "Wilcoxon" : "Mann–Whitney", ranks_p(test),
                                p_result(test.permutation_holm), bootstrap_result(test)));
  }
  return lines;
}

bool is_missing(std::string_view text) {
  constexpr std::array kMissing{"", ".", "na", "nan", "n/a"};
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::find(kMissing, lower) != kMissing.end();
}

/// The column of a name; a table that has none may have a column for each condition.
std::size_t column_of(const CsvTable& table, const std::string& name) {
  try {
    return table.column(name);
  } catch (const InputError& error) {
    if (table.has(name)) {
      throw;
    }
    throw InputError(fmt::format(
        "{}; a row has one value, with its participant and condition beside it: write a table with "
        "a column for each condition as one with a row for each",
        error.what()));
  }
}

/// Rows without a missing field. @param columns  that are read
std::vector<std::size_t> rows_with(const CsvTable& table,
                                   const std::vector<std::vector<std::size_t>>& columns,
                                   bool leave_out_missing) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    bool whole = true;
    for (const auto& kind : columns) {
      for (const std::size_t column : kind) {
        if (!is_missing(table.text(row, column))) {
          continue;
        }
        whole = false;
        if (!leave_out_missing) {
          table.refuse(row, column, "a name or a number, or --leave-out-missing");
        }
      }
    }
    if (whole) {
      rows.push_back(row);
    }
  }
  return rows;
}

}  // namespace

std::vector<std::string> effect_lines(const DesignTests& tests) {
  std::vector<std::string> lines;
  for (const auto& effect : tests.effects) {
    lines.push_back(line_of(tests, effect));
  }
  return lines;
}

std::vector<std::string> planned_lines(const DesignTests& tests) {
  std::vector<std::string> lines;
  for (const SideTest& test : tests.planned.tests) {
    lines.push_back(line_of(tests, test));
  }
  if (tests.sequential) {
    lines.push_back("When the study ends: " + words_of(*tests.sequential));
  }
  return lines;
}

std::vector<std::string> unplanned_lines(const DesignTests& tests) {
  std::vector<std::string> lines;
  for (const TestFamily& family : tests.families) {
    if (family.tests.size() < 2) {
      continue;  // the effect says the same
    }
    for (const SideTest& test : family.tests) {
      if (test.holm && *test.holm < kAlpha && !is_planned(tests, test.sides)) {
        lines.push_back(fmt::format("Not planned, {}: significant; {}{}", sides_of(test),
                                    side_result(test), as_if_fixed(tests)));
      }
    }
  }
  return lines;
}

std::vector<std::string> design_lines(const DesignTable& table, const DesignTests& tests) {
  std::vector<std::string> lines;
  const auto append = [&](const std::vector<std::string>& more) {
    lines.insert(lines.end(), more.begin(), more.end());
  };
  lines.push_back(
      fmt::format("Varied {}; {}", tests.design, counted(table.subjects.size(), "participant")));
  if (!tests.incomplete.empty()) {
    lines.push_back(fmt::format("Left out for lack of a value in some condition: {}",
                                fmt::join(tests.incomplete, ", ")));
  }
  for (std::size_t cell = 0; cell < table.cells.size(); ++cell) {
    lines.push_back(line_of_cell(table, cell));
  }
  append(effect_lines(tests));
  if (table.factors.size() == 1 && table.cells.size() > 1) {
    lines.push_back(fmt::format("On ranks ({}): {}",
                                table.factors[0].within ? "Friedman" : "Kruskal–Wallis",
                                rank_result(tests.ranks)));
  }
  if (!tests.planned.tests.empty()) {
    append(lines_of(tests.planned));
  }
  for (const TestFamily& family : tests.families) {
    append(lines_of(family));
  }
  lines.push_back("p values of a family are adjusted together by Holm's method.");
  return lines;
}

ObservedTable read_observations(const std::string& file, const std::vector<std::string>& subject,
                                const std::vector<std::string>& factors, const std::string& value,
                                bool leave_out_missing) {
  const CsvTable table = CsvTable::load(file);
  const auto columns_of = [&](const std::vector<std::string>& names) {
    std::vector<std::size_t> columns;
    for (const std::string& name : names) {
      columns.push_back(column_of(table, name));
    }
    return columns;
  };
  const auto who = columns_of(subject);
  const auto levels = columns_of(factors);
  const std::size_t measured = column_of(table, value);
  const auto rows = rows_with(table, {who, levels, {measured}}, leave_out_missing);
  const std::vector<double> values = table.numbers(measured, rows);
  ObservedTable result{{}, table.rows(), table.rows() - rows.size()};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Observation o{std::string(table.text(rows[i], who.front())), {}, values[i]};
    for (std::size_t k = 1; k < who.size(); ++k) {
      o.subject += " " + std::string(table.text(rows[i], who[k]));
    }
    for (const std::size_t column : levels) {
      o.levels.emplace_back(table.text(rows[i], column));
    }
    result.observations.push_back(std::move(o));
  }
  return result;
}

}  // namespace haptrial::analysis
