#include "analysis/statistics/relation/random_blocks.h"

#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "analysis/statistics/base/decomposition.h"

namespace haptrial::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Which observations share all their groups.
Grouping cells_of(const std::vector<Grouping>& terms, std::size_t observations) {
  Grouping cells{std::vector<std::size_t>(observations, 0), 1};
  for (const Grouping& term : terms) {
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> numbers;
    for (std::size_t i = 0; i < observations; ++i) {
      cells.numbers[i] =
          numbers.try_emplace({cells.numbers[i], term.numbers[i]}, numbers.size()).first->second;
    }
    cells.count = numbers.size();
  }
  return cells;
}

struct Means {
  MatrixXd values;     // (cells x columns)
  VectorXd counts;     // (cells)
  MatrixXd remainder;  // (observations x columns)
};

Means means_of(const MatrixXd& values, const Grouping& cells) {
  const auto count = static_cast<Index>(cells.count);
  Means means{MatrixXd::Zero(count, values.cols()), VectorXd::Zero(count), values};
  for (Index i = 0; i < values.rows(); ++i) {
    const auto cell = static_cast<Index>(cells.numbers[static_cast<std::size_t>(i)]);
    means.values.row(cell) += values.row(i);
    means.counts[cell] += 1.0;
  }
  means.values = means.counts.cwiseInverse().asDiagonal() * means.values;
  for (Index i = 0; i < values.rows(); ++i) {
    means.remainder.row(i) -=
        means.values.row(static_cast<Index>(cells.numbers[static_cast<std::size_t>(i)]));
  }
  return means;
}

/// Sets of cells that share no group.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) {
      i = parent_[i] = parent_[parent_[i]];
    }
    return i;
  }
  void join(std::size_t i, std::size_t j) { parent_[find(i)] = find(j); }

 private:
  std::vector<std::size_t> parent_;
};

using Members = std::vector<std::vector<std::size_t>>;  // cells of each block

/// @param groups  (terms) of (cells)
Members connected(const std::vector<std::vector<std::size_t>>& groups, std::size_t cells) {
  Sets sets(cells);
  for (const auto& term : groups) {
    std::map<std::size_t, std::size_t> first;
    for (std::size_t cell = 0; cell < cells; ++cell) {
      sets.join(cell, first.try_emplace(term[cell], cell).first->second);
    }
  }
  std::map<std::size_t, std::size_t> numbers;
  Members members;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const auto [place, added] = numbers.try_emplace(sets.find(cell), members.size());
    if (added) {
      members.emplace_back();
    }
    members[place->second].push_back(cell);
  }
  return members;
}

RandomBlock block_of(const std::vector<std::vector<std::size_t>>& groups, const Means& means,
                     const std::vector<std::size_t>& members) {
  RandomBlock block;
  block.begins.push_back(0);
  std::vector<Grouping> own;
  for (const auto& term : groups) {
    std::vector<std::size_t> numbers;
    for (const std::size_t cell : members) {
      numbers.push_back(term[cell]);
    }
    own.push_back(grouping_of(numbers));
    block.begins.push_back(block.begins.back() + static_cast<Index>(own.back().count));
  }
  const Index rows = std::ssize(members);
  block.z = MatrixXd::Zero(rows, block.begins.back());
  block.values.resize(rows, means.values.cols());
  for (Index row = 0; row < rows; ++row) {
    const auto place = static_cast<std::size_t>(row);
    const auto cell = static_cast<Index>(members[place]);
    const double weight = std::sqrt(means.counts[cell]);
    for (std::size_t k = 0; k < own.size(); ++k) {
      block.z(row, block.begins[k] + static_cast<Index>(own[k].numbers[place])) = weight;
    }
    block.values.row(row) = weight * means.values.row(cell);
  }
  return block;
}

/// A rotation of the rows leaves I + Z Z' of the same form.
void shorten(RandomBlock& block) {
  const Index groups = block.z.cols();
  const Index columns = groups + block.values.cols();
  if (block.z.rows() > columns) {
    MatrixXd all(block.z.rows(), columns);
    all << block.z, block.values;
    const MatrixXd r = triangle(all);
    block.z = r.leftCols(groups);
    block.values = r.rightCols(block.values.cols());
  }
}

}  // namespace

Grouping grouping_of(std::span<const std::size_t> groups) {
  std::map<std::size_t, std::size_t> numbers;
  Grouping result;
  result.numbers.reserve(groups.size());
  for (const auto group : groups) {
    result.numbers.push_back(numbers.try_emplace(group, numbers.size()).first->second);
  }
  result.count = numbers.size();
  return result;
}

RandomBlocks random_blocks(const MatrixXd& values, const std::vector<Grouping>& terms) {
  const Grouping cells = cells_of(terms, static_cast<std::size_t>(values.rows()));
  const Means means = means_of(values, cells);
  std::vector<std::vector<std::size_t>> groups;  // (terms) of the cells
  for (const Grouping& term : terms) {
    groups.emplace_back(cells.count);
    for (std::size_t i = 0; i < cells.numbers.size(); ++i) {
      groups.back()[cells.numbers[i]] = term.numbers[i];
    }
  }
  RandomBlocks result;
  for (const auto& members : connected(groups, cells.count)) {
    result.blocks.push_back(block_of(groups, means, members));
    shorten(result.blocks.back());
  }
  result.deviations = triangle(means.remainder);
  return result;
}

}  // namespace haptrial::analysis
