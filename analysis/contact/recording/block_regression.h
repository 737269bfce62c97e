#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace haptrial::evaluation {

/// A number with its two-sided interval.
struct Interval {
  double value{0.0};
  double low{0.0}, high{0.0};

  bool holds(double x) const { return low <= x && x <= high; }
};

/// Least squares on data whose neighbours are alike: samples of a recording.
struct BlockFit {
  Eigen::VectorXd coefficients;     // (p); those that the data do not fix are the smallest that fit
  Eigen::MatrixXd covariance;       // (p x p)
  std::vector<Interval> intervals;  // (p)
  double residual_rms{0.0};
  std::vector<std::string> confounded;  // sentences; empty: all coefficients are told apart
};

struct BlockOptions {
  int blocks{20};      // 2 .. samples; each should be longer than the noise remembers
  double level{0.95};  // coverage of the intervals, inside (0, 1)
};

/// y = X c + noise. The covariance is that of the jackknife which leaves out one of `blocks` runs
/// of neighbouring rows at a time; intervals are those of Student's t with blocks - 1 degrees of
/// freedom. They hold however the noise within a block is correlated.
///
/// A direction of the coefficients (columns scaled to equal length) whose eigenvalue is below
/// 1e-10 of the largest is not fixed by the data: its coefficients have infinite intervals. Two
/// coefficients whose estimates correlate beyond 0.95 cannot be told apart in practice. A sentence
/// in `confounded` says either.
/// @param x      (n x p), rows in order of time
/// @param y      (n)
/// @param names  (p) of the coefficients, for the sentences
/// @throws std::invalid_argument when sizes do not fit, a value is not finite, an option breaks its
/// bound, or there are fewer rows than blocks or than coefficients.
/// Source: Künsch 1989, Ann. Statist. 17, 1217 (blocks); Ibragimov and Müller 2010, J. Bus. Econ.
/// Stat. 28, 453 (Student's t over blocks).
BlockFit fit_blocks(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                    const std::vector<std::string>& names, const BlockOptions& options = {});

}  // namespace haptrial::evaluation
