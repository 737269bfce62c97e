#include "core/deformable/body/block_matrix.h"

#include <algorithm>
#include <utility>

namespace haptrial::deformable {

struct BlockMatrix::Member {
  std::int32_t group;
  std::int32_t local;
};

/// The groups that have each vertex, and which of the group's vertices it is.
/// @param first  receives vertices + 1 places in the result
std::vector<BlockMatrix::Member> BlockMatrix::members_by_vertex(const CoupledGroups& groups,
                                                                std::vector<std::int32_t>& first) {
  std::fill(first.begin(), first.end(), 0);
  for (const std::int32_t v : groups.vertices) {
    ++first[static_cast<std::size_t>(v) + 1];
  }
  for (std::size_t v = 0; v + 1 < first.size(); ++v) {
    first[v + 1] += first[v];
  }
  std::vector<Member> members(groups.vertices.size());
  std::vector<std::int32_t> at(first.begin(), first.end() - 1);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::int32_t begin = groups.first[g];
    for (std::int32_t i = begin; i < groups.first[g + 1]; ++i) {
      const auto v = static_cast<std::size_t>(groups.vertices[static_cast<std::size_t>(i)]);
      members[static_cast<std::size_t>(at[v]++)] = {static_cast<std::int32_t>(g), i - begin};
    }
  }
  return members;
}

BlockMatrix::BlockMatrix(const CoupledGroups& groups, std::size_t vertices) {
  first_place_.push_back(0);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::int32_t n = groups.first[g + 1] - groups.first[g];
    first_place_.push_back(first_place_.back() + n * (n + 1) / 2);
  }
  places_.resize(static_cast<std::size_t>(first_place_.back()));
  start_.assign(1, 0);
  std::vector<std::int32_t> first(vertices + 1);
  const std::vector<Member> members = members_by_vertex(groups, first);
  std::vector<std::int32_t> place(vertices, -1);  // of the row's column, if from the row's start on
  for (std::size_t row = 0; row < vertices; ++row) {
    add_row(groups,
            std::span(members).subspan(static_cast<std::size_t>(first[row]),
                                       static_cast<std::size_t>(first[row + 1] - first[row])),
            place);
  }
  values_.resize(9 * column_.size());
  set_zero();
}

/// @param members  the row's vertex in its groups
void BlockMatrix::add_row(const CoupledGroups& groups, std::span<const Member> members,
                          std::vector<std::int32_t>& place) {
  const std::int32_t row_begin = start_.back();
  for (const auto& [group, local] : members) {
    const auto g = static_cast<std::size_t>(group);
    for (auto i = groups.first[g] + local; i < groups.first[g + 1]; ++i) {
      const std::int32_t v = groups.vertices[static_cast<std::size_t>(i)];
      std::int32_t& at = place[static_cast<std::size_t>(v)];
      if (at < row_begin) {
        at = static_cast<std::int32_t>(column_.size());
        column_.push_back(v);
      }
    }
  }
  std::sort(column_.begin() + row_begin, column_.end());
  for (auto i = static_cast<std::size_t>(row_begin); i < column_.size(); ++i) {
    place[static_cast<std::size_t>(column_[i])] = static_cast<std::int32_t>(i);
  }
  start_.push_back(static_cast<std::int32_t>(column_.size()));
  for (const auto& [group, local] : members) {
    const auto g = static_cast<std::size_t>(group);
    const std::int32_t n = groups.first[g + 1] - groups.first[g];
    std::int32_t* to = places_.data() + first_place_[g] + local * n - local * (local - 1) / 2;
    for (auto i = groups.first[g] + local; i < groups.first[g + 1]; ++i) {
      const auto v = static_cast<std::size_t>(groups.vertices[static_cast<std::size_t>(i)]);
      *to++ = place[v];
    }
  }
}

BlockMatrix::BlockMatrix(std::vector<std::int32_t> start, std::vector<std::int32_t> column)
    : start_(std::move(start)), column_(std::move(column)), first_place_(1, 0) {
  values_.resize(9 * column_.size());
  set_zero();
}

std::span<const std::int32_t> BlockMatrix::places(std::size_t group) const {
  return std::span(places_).subspan(
      static_cast<std::size_t>(first_place_[group]),
      static_cast<std::size_t>(first_place_[group + 1] - first_place_[group]));
}

void BlockMatrix::set_zero() { std::fill(values_.begin(), values_.end(), 0.0); }

void BlockMatrix::scale_and_add(double scale, std::span<const double> diagonal) {
  if (scale != 1) {
    for (double& value : values_) {
      value *= scale;
    }
  }
  for (std::size_t row = 0; row < rows(); ++row) {
    double* values = block(start_[row]);
    for (int axis = 0; axis < 3; ++axis) {
      values[4 * axis] += diagonal[row];
    }
  }
}

void BlockMatrix::add(double scale, const BlockMatrix& other) {
  for (std::size_t i = 0; i < values_.size(); ++i) {
    values_[i] += scale * other.values_[i];
  }
}

void BlockMatrix::multiply(const Vectors& x, Vectors& y) const {
  std::fill(y.begin(), y.end(), Eigen::Vector3d::Zero());
  const double* in = x.front().data();
  double* out = y.front().data();
  const double* a = values_.data();
  for (std::size_t row = 0; row < rows(); ++row) {
    const double x0 = in[3 * row], x1 = in[3 * row + 1], x2 = in[3 * row + 2];
    double y0 = a[0] * x0 + a[3] * x1 + a[6] * x2;
    double y1 = a[1] * x0 + a[4] * x1 + a[7] * x2;
    double y2 = a[2] * x0 + a[5] * x1 + a[8] * x2;
    a += 9;
    for (std::int32_t i = start_[row] + 1; i < start_[row + 1]; ++i, a += 9) {
      const auto at = 3 * static_cast<std::size_t>(column_[static_cast<std::size_t>(i)]);
      const double* v = in + at;
      double* w = out + at;
      y0 += a[0] * v[0] + a[3] * v[1] + a[6] * v[2];
      y1 += a[1] * v[0] + a[4] * v[1] + a[7] * v[2];
      y2 += a[2] * v[0] + a[5] * v[1] + a[8] * v[2];
      w[0] += a[0] * x0 + a[1] * x1 + a[2] * x2;
      w[1] += a[3] * x0 + a[4] * x1 + a[5] * x2;
      w[2] += a[6] * x0 + a[7] * x1 + a[8] * x2;
    }
    out[3 * row] += y0;
    out[3 * row + 1] += y1;
    out[3 * row + 2] += y2;
  }
}

}  // namespace haptrial::deformable
