#include "analysis/power/depth_check.h"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>

namespace haptrial::analysis {

std::vector<DepthRow> depth_check(const PowerResult& result) {
  std::vector<DepthRow> rows;
  const auto add = [&](const PowerCell& cell) {
    if (!cell.sessions) {
      return;
    }
    for (const auto& [name, full] : cell.sessions->values) {
      const auto alone = cell.counts.values.find(name);
      if (alone == cell.counts.values.end() || full.count < 2 || alone->second.count < 2) {
        continue;
      }
      DepthRow row{words_of(result, cell), name, alone->second, full};
      const double error = std::hypot(row.responses.error(), row.sessions.error());
      row.z = error > 0.0 ? (row.sessions.mean - row.responses.mean) / error : 0.0;
      rows.push_back(std::move(row));
    }
  };
  std::ranges::for_each(result.nulls, add);
  std::ranges::for_each(result.cells, add);
  for (DepthRow& row : rows) {
    const double each = std::pow(0.99, 1.0 / static_cast<double>(rows.size()));
    const auto df = static_cast<double>(std::min(row.sessions.count, row.responses.count) - 1);
    row.agrees = std::abs(row.z) <= gsl_cdf_tdist_Pinv(0.5 * (1.0 + each), df);
  }
  return rows;
}

}  // namespace haptrial::analysis
