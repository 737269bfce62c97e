#include "analysis/statistics/design/design_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <system_error>
#include <tuple>

#include "analysis/statistics/base/descriptive.h"
#include "core/base/error.h"

namespace haptrial::analysis {
namespace {

std::optional<double> number_in(const std::string& text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  return read.ec == std::errc() && read.ptr == end && std::isfinite(value) ? std::optional(value)
                                                                           : std::nullopt;
}

/// Numbers by their value, before names by their letters.
struct LevelOrder {
  bool operator()(const std::string& a, const std::string& b) const {
    const auto key = [](const std::string& text) {
      const auto number = number_in(text);
      return std::tuple(!number, number.value_or(0.0), text);
    };
    return key(a) < key(b);
  }
};

using Levels = std::set<std::string, LevelOrder>;

std::vector<std::string> ordered(Levels found, const std::vector<std::string>& first) {
  std::vector<std::string> result;
  for (const std::string& wanted : first) {
    if (found.erase(wanted) > 0) {
      result.push_back(wanted);
    }
  }
  result.insert(result.end(), found.begin(), found.end());
  return result;
}

Factor factor_of(std::span<const Observation> observations, std::size_t place,
                 const std::string& name, const std::vector<std::string>& first) {
  Levels levels;
  std::map<std::string, std::set<std::string>> by_subject;
  for (const Observation& o : observations) {
    levels.insert(o.levels[place]);
    by_subject[o.subject].insert(o.levels[place]);
  }
  const bool within = levels.size() < 2 ||
                      std::any_of(by_subject.begin(), by_subject.end(),
                                  [](const auto& subject) { return subject.second.size() > 1; });
  return {name, ordered(std::move(levels), first), within};
}

void add_cells(DesignTable& table) {
  std::size_t count = 1;
  for (const Factor& factor : table.factors) {
    count *= factor.levels.size();
  }
  for (std::size_t cell = 0; cell < count; ++cell) {
    std::vector<std::size_t> levels(table.factors.size());
    std::size_t rest = cell;
    for (std::size_t f = table.factors.size(); f-- > 0;) {
      levels[f] = rest % table.factors[f].levels.size();
      rest /= table.factors[f].levels.size();
    }
    std::string name;
    for (std::size_t f = 0; f < levels.size(); ++f) {
      name += (f > 0 ? ", " : "") + table.factors[f].levels[levels[f]];
    }
    table.cells.push_back(std::move(levels));
    table.names.push_back(std::move(name));
  }
}

/// "a" with "b, c" and "a, b" with "c" are both "a, b, c", and tests go by such names.
void refuse_equal_names(const DesignTable& table) {
  std::set<std::string> names;
  for (const std::string& name : table.names) {
    if (!names.insert(name).second) {
      throw InputError(
          "two conditions are called '" + name +
          "', the names of their levels one after the other; name levels without ', '");
    }
  }
}

std::size_t cell_of(const DesignTable& table, const Observation& o) {
  std::size_t cell = 0;
  for (std::size_t f = 0; f < table.factors.size(); ++f) {
    const auto& levels = table.factors[f].levels;
    const auto level = std::find(levels.begin(), levels.end(), o.levels[f]);
    cell = cell * levels.size() + static_cast<std::size_t>(level - levels.begin());
  }
  return cell;
}

/// Combinations of levels that nobody has are no cells.
void drop_empty_cells(DesignTable& table) {
  for (std::size_t cell = table.cells.size(); cell-- > 0;) {
    if (table.counts[cell] > 0) {
      continue;
    }
    const auto at = static_cast<std::ptrdiff_t>(cell);
    table.crossed = false;
    table.cells.erase(table.cells.begin() + at);
    table.names.erase(table.names.begin() + at);
    table.counts.erase(table.counts.begin() + at);
    for (auto& row : table.means) {
      row.erase(row.begin() + at);
    }
  }
}

}  // namespace

std::vector<std::size_t> DesignTable::complete() const {
  std::vector<std::size_t> result;
  for (std::size_t s = 0; s < subjects.size(); ++s) {
    const auto own = [&](std::size_t cell) {  // its levels between participants are the subject's
      for (std::size_t f = 0; f < factors.size(); ++f) {
        if (factors[f].within) {
          continue;
        }
        for (std::size_t other = 0; other < cells.size(); ++other) {
          if (means[s][other] && cells[other][f] != cells[cell][f]) {
            return false;
          }
        }
      }
      return true;
    };
    bool whole = true;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      whole = whole && (means[s][cell].has_value() || !own(cell));
    }
    if (whole) {
      result.push_back(s);
    }
  }
  return result;
}

std::size_t DesignTable::participants(std::size_t cell) const {
  return static_cast<std::size_t>(std::count_if(
      means.begin(), means.end(), [&](const auto& row) { return row[cell].has_value(); }));
}

std::vector<std::string> DesignTable::levels_of(std::size_t subject, std::size_t factor) const {
  std::vector<std::string> found;
  for (std::size_t level = 0; level < factors[factor].levels.size(); ++level) {
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      if (cells[cell][factor] == level && means[subject][cell]) {
        found.push_back(factors[factor].levels[level]);
        break;
      }
    }
  }
  return found;
}

std::vector<std::string> DesignTable::with_several(std::size_t factor) const {
  std::vector<std::string> several;
  for (std::size_t s = 0; s < subjects.size(); ++s) {
    if (levels_of(s, factor).size() > 1) {
      several.push_back(subjects[s]);
    }
  }
  return several;
}

DesignTable design_table(std::span<const Observation> observations,
                         const std::vector<std::string>& factors,
                         const std::vector<std::string>& first) {
  DesignTable table;
  for (std::size_t f = 0; f < factors.size(); ++f) {
    table.factors.push_back(factor_of(observations, f, factors[f], first));
  }
  if (observations.empty()) {
    return table;
  }
  add_cells(table);
  table.counts.assign(table.cells.size(), 0);
  std::map<std::string, std::vector<std::vector<double>>> values;
  for (const Observation& o : observations) {
    auto& of_subject = values[o.subject];
    of_subject.resize(table.cells.size());
    const std::size_t cell = cell_of(table, o);
    of_subject[cell].push_back(o.value);
    ++table.counts[cell];
  }
  for (const auto& [subject, cells] : values) {
    table.subjects.push_back(subject);
    auto& row = table.means.emplace_back(table.cells.size());
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      if (const auto m = moments(cells[cell])) {
        row[cell] = m->mean();
      }
    }
  }
  drop_empty_cells(table);
  refuse_equal_names(table);
  return table;
}

}  // namespace haptrial::analysis
