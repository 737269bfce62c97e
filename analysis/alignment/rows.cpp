#include "analysis/alignment/rows.h"

#include <algorithm>
#include <limits>

#include "analysis/alignment/error.h"

namespace haptrial::analysis {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Ways into a cell; the patterns' steps in the order in which ties go.
enum StepDirection : std::uint8_t { kStraight, kSecond, kThird };

/// Places before column 0 that a step may read; they are infinite.
constexpr std::size_t kLead = 2;

/// D and e of the row at work, and of those above it, each indexed by column.
struct Rows {
  double* cost;
  double* above;
  double* above_2;
  double* error;
  double* error_above;
  double* spare;

  void next() {
    std::swap(above_2, above);
    std::swap(above, cost);
    std::swap(error_above, error);
  }
};

template <class Power>
void fill_errors(const CurveView& target, std::size_t row, const CurveView& applied,
                 std::size_t first, std::size_t last, const AlignmentOptions& o, Power power,
                 double* error) {
  const double force = target.force[row], slope = target.slope[row];
  const double* forces = applied.force.data();
  const double* slopes = applied.slope.data();
  for (std::size_t j = first; j <= last; ++j) {
    error[j] =
        o.force_weight * power(force - forces[j]) + o.slope_weight * power(slope - slopes[j]);
  }
}

/// (1,1), (1,0) and (0,1), the first of weight 1 or 2. A chain runs along the row: one addition and
/// one comparison a cell.
template <int straight>
struct SymmetricSteps {
  static void fill(const Rows& rows, std::size_t first, std::size_t last, double penalty,
                   std::uint8_t* directions) {
    double left = kInfinity;
    for (std::size_t j = first; j <= last; ++j) {
      const double error = rows.error[j];
      const double from_diagonal = rows.above[j - 1] + straight * error;
      const double from_above = rows.above[j] + (error + penalty);
      const bool is_above = from_above < from_diagonal;
      const double best = is_above ? from_above : from_diagonal;
      const double from_left = left + (error + penalty);
      const bool is_left = from_left < best;
      left = is_left ? from_left : best;
      rows.cost[j] = left;
      directions[j] = static_cast<std::uint8_t>(is_left ? kThird : is_above ? kSecond : kStraight);
    }
  }

  static void start(const Rows& rows, std::size_t last, double penalty, std::uint8_t* directions) {
    rows.cost[0] = rows.error[0];
    for (std::size_t j = 1; j <= last; ++j) {
      rows.cost[j] = rows.cost[j - 1] + (rows.error[j] + penalty);
      directions[j] = kThird;
    }
  }

  template <class Note>
  static void back(StepDirection way, std::size_t& row, std::size_t& column, Note note) {
    row -= way != kThird;
    column -= way != kSecond;
    note();
  }
};

/// No step along the row alone: row 0 is entered at its start only.
struct StartsOnce {
  static void start(const Rows& rows, std::size_t last, double, std::uint8_t*) {
    rows.cost[0] = rows.error[0];
    std::fill(rows.cost + 1, rows.cost + last + 1, kInfinity);
  }
};

/// (1,1), (1,0) and (1,2).
struct AsymmetricSteps : StartsOnce {
  static void fill(const Rows& rows, std::size_t first, std::size_t last, double penalty,
                   std::uint8_t* directions) {
    for (std::size_t j = first; j <= last; ++j) {
      const double straight = rows.above[j - 1];
      const double stay = rows.above[j] + penalty;
      const double skip = rows.above[j - 2] + penalty;
      const bool is_stay = stay < straight;
      const double best = is_stay ? stay : straight;
      const bool is_skip = skip < best;
      rows.cost[j] = (is_skip ? skip : best) + rows.error[j];
      directions[j] = static_cast<std::uint8_t>(is_skip ? kThird : is_stay ? kSecond : kStraight);
    }
  }

  template <class Note>
  static void back(StepDirection way, std::size_t& row, std::size_t& column, Note note) {
    row -= 1;
    column -= way == kStraight ? 1 : way == kSecond ? 0 : 2;
    note();
  }
};

/// (1,1); (1,1) then (1,0); (1,1) then (0,1).
struct SymmetricP1Steps : StartsOnce {
  static void fill(const Rows& rows, std::size_t first, std::size_t last, double penalty,
                   std::uint8_t* directions) {
    for (std::size_t j = first; j <= last; ++j) {
      const double error = rows.error[j];
      const double straight = rows.above[j - 1] + 2.0 * error;
      const double aside = error + penalty;
      const double down = rows.above_2[j - 1] + (2.0 * rows.error_above[j] + aside);
      const double across = rows.above[j - 2] + (2.0 * rows.error[j - 1] + aside);
      const bool is_down = down < straight;
      const double best = is_down ? down : straight;
      const bool is_across = across < best;
      rows.cost[j] = is_across ? across : best;
      directions[j] = static_cast<std::uint8_t>(is_across ? kThird : is_down ? kSecond : kStraight);
    }
  }

  template <class Note>
  static void back(StepDirection way, std::size_t& row, std::size_t& column, Note note) {
    if (way != kStraight) {  // the pair in the middle of the step
      row -= way == kSecond;
      column -= way == kThird;
      note();
    }
    row -= 1;
    column -= 1;
    note();
  }
};

/// One search: the curves, the options and the memory.
struct Search {
  const CurveView& target;
  const CurveView& applied;
  const AlignmentOptions& options;
  void (*raise)(double* values, std::size_t count, double power);
  Band band;
  Rows rows;
  std::uint8_t* directions;
  std::size_t direction_stride;

  std::size_t row_count() const { return target.force.size(); }
  std::size_t column_count() const { return applied.force.size(); }

  /// The directions of a row, by column.
  std::uint8_t* directions_of(std::size_t row) const {
    return directions + row * direction_stride - band.first(row);
  }

  void fill_error_row(std::size_t row, std::size_t first, std::size_t last) const {
    if (!has_short_power(options.power)) {
      raise_error_row(row, first, last);
      return;
    }
    with_power(options.power, [&](auto power) {
      fill_errors(target, row, applied, first, last, options, power, rows.error);
    });
  }

  void raise_error_row(std::size_t row, std::size_t first, std::size_t last) const {
    const auto differences = [&](std::span<const double> CurveView::*values, double* to) {
      const double value = (target.*values)[row];
      const double* others = (applied.*values).data();
      for (std::size_t j = first; j <= last; ++j) {
        to[j] = value - others[j];
      }
      raise(to + first, last - first + 1, options.power);
    };
    differences(&CurveView::force, rows.error);
    differences(&CurveView::slope, rows.spare);
    for (std::size_t j = first; j <= last; ++j) {
      rows.error[j] = options.force_weight * rows.error[j] + options.slope_weight * rows.spare[j];
    }
  }

  /// Puts infinity before the row's first cell, where later rows may read. Nothing lies after the
  /// last: the rows that the memory held before ended no later.
  static void close(double* values, std::size_t first) {
    std::fill(values + first - kLead, values + first, kInfinity);
  }

  template <class Steps>
  void fill_matrix() {
    for (std::size_t i = 0; i < row_count(); ++i, rows.next()) {
      const std::size_t first = band.first(i), last = band.last(i);
      fill_error_row(i, first, last);
      close(rows.error, first);
      if (i > 0) {
        Steps::fill(rows, first, last, options.penalty, directions_of(i));
      } else if (options.open_begin) {
        std::copy(rows.error, rows.error + last + 1, rows.cost);
      } else {
        Steps::start(rows, last, options.penalty, directions_of(0));
      }
      close(rows.cost, first);
    }
  }

  /// The column where the path ends, of equal ones the last; the last row is rows.above.
  std::size_t end_column() const {
    const std::size_t last = column_count() - 1;
    if (!options.open_end) {
      return last;
    }
    const std::size_t first = band.first(row_count() - 1);
    const bool normalized = doubles_straight(options.pattern);
    const auto measure = [&](std::size_t j) {
      const double norm = static_cast<double>(row_count() + j + 1);
      return normalized ? rows.above[j] / norm : rows.above[j];
    };
    std::size_t best = last;
    for (std::size_t j = last; j-- > first;) {
      if (measure(j) < measure(best)) {
        best = j;
      }
    }
    return best;
  }

  template <class Steps>
  bool walk(std::vector<PathPoint>& path) const {
    std::size_t row = row_count() - 1, column = end_column();
    if (!(rows.above[column] < kInfinity)) {
      return false;
    }
    path.resize(row_count() + column_count() - 1);
    std::size_t free = path.size();
    const auto note = [&] {
      path[--free] = {static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(column)};
    };
    note();
    while (row > 0 || (column > 0 && !options.open_begin)) {
      Steps::back(static_cast<StepDirection>(directions_of(row)[column]), row, column, note);
    }
    path.erase(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(free));
    return true;
  }

  template <class Steps>
  bool find(std::vector<PathPoint>& path) {
    fill_matrix<Steps>();
    return walk<Steps>(path);
  }
};

}  // namespace

Band::Band(std::size_t rows, std::size_t columns, std::optional<std::size_t> window)
    : a_(static_cast<std::int64_t>(rows) - 1),
      b_(static_cast<std::int64_t>(columns) - 1),
      reach_(2 * a_ * b_) {
  if (!window) {
    return;
  }
  const auto widest = static_cast<std::int64_t>(std::min(*window, kMostAlignmentSamples));
  reach_ = std::min(reach_, std::max(2 * widest * std::min(a_, b_), std::max(a_, b_)));
}

std::size_t Band::first(std::size_t row) const {
  const std::int64_t low = 2 * static_cast<std::int64_t>(row) * b_ - reach_;
  return low <= 0 ? 0 : static_cast<std::size_t>((low + 2 * a_ - 1) / (2 * a_));
}

std::size_t Band::last(std::size_t row) const {
  if (a_ == 0) {
    return static_cast<std::size_t>(b_);
  }
  const std::int64_t high = 2 * static_cast<std::int64_t>(row) * b_ + reach_;
  return static_cast<std::size_t>(std::min(b_, high / (2 * a_)));
}

std::size_t Band::widest() const {
  return static_cast<std::size_t>(a_ == 0 ? b_ + 1 : std::min(b_, reach_ / a_) + 1);
}

bool RowSearch::find(const CurveView& target, const CurveView& applied,
                     const AlignmentOptions& options, std::vector<PathPoint>& path) {
  const std::size_t count = target.force.size(), stride = applied.force.size() + kLead;
  constexpr std::size_t kRows = 6;
  double* values = values_.at_least(kRows * stride);
  std::fill_n(values, kRows * stride, kInfinity);
  const auto row = [&](std::size_t k) { return values + k * stride + kLead; };
  const Band band(count, applied.force.size(), options.window);
  Search search{target,
                applied,
                options,
                kernels_.raise,
                band,
                {row(0), row(1), row(2), row(3), row(4), row(5)},
                directions_.at_least(count * band.widest()),
                band.widest()};
  switch (options.pattern) {
    case StepPattern::kSymmetric2:
      return search.find<SymmetricSteps<2>>(path);
    case StepPattern::kAsymmetric:
      return search.find<AsymmetricSteps>(path);
    case StepPattern::kSymmetricP1:
      return search.find<SymmetricP1Steps>(path);
    default:
      return search.find<SymmetricSteps<1>>(path);
  }
}

}  // namespace haptrial::analysis
