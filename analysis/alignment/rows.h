#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/alignment/buffer.h"
#include "analysis/alignment/curves.h"
#include "analysis/alignment/kernel.h"
#include "analysis/alignment/options.h"

namespace haptrial::analysis {

/// The search for every combination of options: row by row over the target, in double precision,
/// with a byte a cell for the way back. Rows know nothing of each other but D and e, so that the
/// patterns without a step along the row alone are free of chains. One object per thread.
class RowSearch {
 public:
  explicit RowSearch(const kernel::Kernels& kernels) : kernels_(kernels) {}

  /// Preconditions: options without a problem, and curves that Aligner takes.
  /// @param path  gets the cheapest path.
  /// @returns false where the options leave none.
  bool find(const CurveView& target, const CurveView& applied, const AlignmentOptions& options,
            std::vector<PathPoint>& path);

 private:
  const kernel::Kernels& kernels_;
  WorkBuffer<double> values_;
  WorkBuffer<std::uint8_t> directions_;
};

/// Sakoe and Chiba's band around the straight line from (0,0) to (rows - 1, columns - 1).
class Band {
 public:
  Band(std::size_t rows, std::size_t columns, std::optional<std::size_t> window);

  /// Columns of a row that lie within; neither falls from one row to the next.
  std::size_t first(std::size_t row) const;
  std::size_t last(std::size_t row) const;
  std::size_t widest() const;  // at least the cells of any row

 private:
  // (i,j) is inside where |2 i b - 2 j a| <= reach.
  std::int64_t a_, b_, reach_;
};

}  // namespace haptrial::analysis
