#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace haptrial::analysis {

/// The group of each observation, 0 .. count - 1.
struct Grouping {
  std::vector<std::size_t> numbers;  // (observations)
  std::size_t count{0};
};

/// @param groups  any numbers; counted anew in order of appearance.
Grouping grouping_of(std::span<const std::size_t> groups);

/// Observations that share no group, directly or through others, with those of another block.
struct RandomBlock {
  Eigen::MatrixXd z;                 // (rows x groups), the columns of the first term first
  std::vector<Eigen::Index> begins;  // (terms + 1) first column of each term
  Eigen::MatrixXd values;            // (rows x columns)
};

/// The rows of a linear model with random intercepts, turned and sorted so that the covariance
/// I + sum_k rho_k Z_k Z_k' falls into small blocks: participants, for terms nested in them.
struct RandomBlocks {
  std::vector<RandomBlock> blocks;
  Eigen::MatrixXd deviations;  // (up to columns x columns) of rows with the covariance I
};

/// Observations that share all their groups become one row, their mean times the root of their
/// number; their deviations from it go to `deviations`. A block keeps at most as many rows as it
/// has columns.
/// @param values  (observations x columns): intercept, predictors, response.
/// @param terms   may be none.
RandomBlocks random_blocks(const Eigen::MatrixXd& values, const std::vector<Grouping>& terms);

}  // namespace haptrial::analysis
