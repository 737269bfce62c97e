#include "analysis/force_training/exchange/curve_study.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"

namespace haptrial::exchange {

const std::vector<std::string>& import_columns() {
  static const std::vector<std::string> names{
      "subject",   "trial",  "condition", "block", "repetition",   "phase",        "rate", "file",
      "simulated", "target", "applied",   "time",  "target_force", "applied_force"};
  return names;
}

ImportColumns::ImportColumns(const std::vector<std::string>& given) {
  for (const std::string& one : given) {
    const std::size_t sign = one.find('=');
    if (sign == one.npos || sign == 0 || sign + 1 == one.size()) {
      throw InputError(
          fmt::format("--column is '{}'; allowed: COLUMN=NAME, as in subject=Participant", one));
    }
    const std::string column = one.substr(0, sign);
    const auto& known = import_columns();
    if (std::find(known.begin(), known.end(), column) == known.end()) {
      throw InputError(fmt::format("--column names '{}', which no import reads; allowed: {}",
                                   column, fmt::join(known, ", ")));
    }
    if (!names_.emplace(column, one.substr(sign + 1)).second) {
      throw InputError(fmt::format("--column names {} twice; name each column once", column));
    }
  }
}

const std::string& ImportColumns::given(const std::string& column) const {
  static const std::string none;
  const auto at = names_.find(column);
  return at == names_.end() ? none : at->second;
}

std::string ImportColumns::name(const std::string& column) const {
  return given(column).empty() ? column : given(column);
}

bool ImportColumns::has(const analysis::CsvTable& table, const std::string& column) const {
  return !given(column).empty() || table.has(column);
}

std::size_t ImportColumns::place(const analysis::CsvTable& table, const std::string& column) const {
  if (!has(table, column)) {
    throw InputError(
        fmt::format("{}: there is no column '{}'; name one of {} with --column {}=NAME",
                    table.name(), column, fmt::join(table.columns(), ", "), column));
  }
  return table.column(name(column));
}

}  // namespace haptrial::exchange
