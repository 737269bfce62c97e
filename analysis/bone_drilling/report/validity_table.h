#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "analysis/bone_drilling/report/validity_findings.h"

namespace haptrial::analysis::drilling {

/// One quantity of every procedure, with whose it is: what the statistics of validity() are made
/// from.
struct ValueTable {
  struct Row {
    std::optional<double> value;
    std::size_t participant{0};
    std::string group;
    bool expert{false};
    double number{1.0};  // of the procedure
  };
  std::vector<Row> rows;
};

/// Rows without values. @param v  with people
ValueTable table_of(const Validity& v, std::span<const ProcedureSummary> procedures);

/// A row for each participant, in order of number: the mean of the values there are; none where
/// there is none.
ValueTable participant_means(const ValueTable& table);

/// The values of rows that have both. @throws std::invalid_argument when the lengths differ.
std::pair<std::vector<double>, std::vector<double>> paired(const ValueTable& a,
                                                           const ValueTable& b);

/// (groups), then "all experts" and "all novices".
std::vector<GroupValues> group_values(const ValueTable& table, const ValidityPlan& plan);

/// Which end a quantity of experts is expected at: a one-tailed test looks there.
Tail tail_of(Expected experts);

Contrast contrast(const ValueTable& table, Expected experts);

}  // namespace haptrial::analysis::drilling
