#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/files/csv.h"
#include "analysis/force_training/score/resample.h"

namespace haptrial::analysis {

/// Which columns of a table make a curve.
struct CurveColumns {
  std::string time{};            // empty: "time", or without names the first of two
  std::string value{};           // empty: the only column beside the time
  std::optional<double> rate{};  // > 0, in place of a column of times [Hz]
};

/// A curve from a table, with its own samples.
struct TableCurve {
  std::vector<double> values;
  std::vector<double> times;  // [s], as many as values; empty where there is a rate
  double rate{0.0};           // [Hz]

  SampledCurve view() const { return {values, times, rate}; }
};

/// @throws InputError, with the file and line, for a column that is not there or not clear from the
///   table, a value that is not a finite number, times that do not increase, fewer than two rows,
///   or a rate out of bounds.
TableCurve read_curve(const CsvTable& table, const CurveColumns& columns);

}  // namespace haptrial::analysis
