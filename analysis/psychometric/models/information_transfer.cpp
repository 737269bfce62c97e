#include "analysis/psychometric/models/information_transfer.h"

#include <cmath>

namespace haptrial::analysis {

Defined<double> information_transfer(const std::vector<std::vector<int>>& counts) {
  double all = 0.0;
  std::vector<double> of_answer(counts.empty() ? 0 : counts.front().size(), 0.0);
  for (const auto& row : counts) {
    for (std::size_t a = 0; a < row.size(); ++a) {
      of_answer[a] += row[a];
      all += row[a];
    }
  }
  if (!(all > 0.0)) {
    return Undefined{"nothing was answered"};
  }
  double bits = 0.0;
  for (const auto& row : counts) {
    double of_stimulus = 0.0;
    for (const int each : row) {
      of_stimulus += each;
    }
    for (std::size_t a = 0; a < row.size(); ++a) {
      if (row[a] > 0) {
        bits += row[a] / all * std::log2(row[a] * all / (of_stimulus * of_answer[a]));
      }
    }
  }
  return bits;
}

}  // namespace haptrial::analysis
