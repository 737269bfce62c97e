#include "analysis/force_training/score/curve_csv.h"

#include <fmt/format.h>

#include <cmath>

#include "core/base/error.h"

namespace haptrial::analysis {
namespace {

std::size_t time_column(const CsvTable& table, const std::string& name) {
  if (!name.empty()) {
    return table.column(name);
  }
  if (table.has("time")) {
    return table.column("time");
  }
  const bool unnamed_pair = table.columns() == std::vector<std::string>{"1", "2"};
  if (unnamed_pair) {
    return 0;
  }
  throw InputError(
      fmt::format("{}: no column is named 'time'; name the column of times ({}) or give a rate",
                  table.name(), fmt::join(table.columns(), ", ")));
}

std::size_t value_column(const CsvTable& table, const std::string& name,
                         std::optional<std::size_t> time) {
  if (!name.empty()) {
    return table.column(name);
  }
  if (!time && table.has("time")) {
    time = table.column("time");
  }  // passed over for the rate
  const std::size_t others = table.columns().size() - (time ? 1 : 0);
  if (others == 0) {
    throw InputError(fmt::format("{}: no column is left for the values; add one", table.name()));
  }
  if (others != 1) {
    throw InputError(fmt::format("{}: {} columns could hold the values; name one of them ({})",
                                 table.name(), others, fmt::join(table.columns(), ", ")));
  }
  return time && *time == 0 ? 1 : 0;
}

}  // namespace

TableCurve read_curve(const CsvTable& table, const CurveColumns& columns) {
  TableCurve curve;
  std::optional<std::size_t> time;
  if (columns.rate) {
    if (!columns.time.empty()) {
      throw InputError(fmt::format("{}: has a rate and a column '{}' of times; give one of them",
                                   table.name(), columns.time));
    }
    if (!(*columns.rate > 0.0 && std::isfinite(*columns.rate))) {
      throw InputError(fmt::format("the rate of {} is {} Hz; allowed: a finite number above 0",
                                   table.name(), *columns.rate));
    }
    curve.rate = *columns.rate;
  } else {
    time = time_column(table, columns.time);
  }
  const std::size_t value = value_column(table, columns.value, time);
  if (table.rows() < 2) {
    throw InputError(
        fmt::format("{}:{}: is the only row; allowed: at least two", table.name(), table.line(0)));
  }
  curve.values = table.numbers(value);
  if (time) {
    curve.times = table.numbers(*time);
  }
  for (std::size_t row = 1; row < curve.times.size(); ++row) {
    if (!(curve.times[row] > curve.times[row - 1])) {
      table.refuse(row, *time,
                   fmt::format("above {}, the time of the row before", table.text(row - 1, *time)));
    }
  }
  return curve;
}

}  // namespace haptrial::analysis
