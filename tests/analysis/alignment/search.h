#pragma once

#include <vector>

#include "tests/analysis/alignment/cases.h"

namespace haptrial::test {}

namespace haptrial::analysis::test {

using namespace haptrial::test;  // helpers of all tests, beside those of this folder

/// The answer by trial of every legal path, for small curves. Written from the patterns as the
/// literature prints them and from the band as the documentation has it, not from the search.
class ExhaustiveSearch {
 public:
  ExhaustiveSearch(const Curve& target, const Curve& applied, const AlignmentOptions& options);

  /// The least cost; with an open end of a pattern that counts a straight step twice, the cost of
  /// the end where the cost over (N + paired applied samples) is least. Infinite without a path.
  double cost() const { return cost_; }
  bool is_inside(int row, int column) const;

 private:
  void visit(int row, int column, double cost);

  AlignmentOptions options_;
  int rows_, columns_;
  std::vector<std::vector<double>> errors_;
  std::vector<double> cost_by_end_;  // (columns)
  double cost_;
};

/// The cost of a path taken apart into steps of its pattern; NaN where that is not possible or it
/// does not run from end to end as the options want it.
double cost_of_legal_path(const Curve& target, const Curve& applied,
                          const AlignmentOptions& options, const std::vector<PathPoint>& path);

}  // namespace haptrial::analysis::test
