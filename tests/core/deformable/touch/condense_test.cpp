#include "core/deformable/touch/condense.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <numeric>

#include "core/base/random.h"

namespace haptrial::deformable::condense_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;

MatrixXd dense_stiffness(const BlockMatrix& matrix) {
  const auto size = 3 * static_cast<Index>(matrix.rows());
  MatrixXd all(size, size);
  for (Index column = 0; column < size; ++column) {
    Vectors unit(matrix.rows(), Vector3d::Zero());
    Vectors product(matrix.rows(), Vector3d::Zero());
    unit[static_cast<std::size_t>(column / 3)][column % 3] = 1.0;
    matrix.multiply(unit, product);
    for (std::size_t row = 0; row < matrix.rows(); ++row) {
      all.block<3, 1>(3 * static_cast<Index>(row), column) = product[row];
    }
  }
  return all;
}

/// Two lobes that are joined by the kept vertices alone, against the dense Schur complement.
TEST(CondenseTest, NothingLiesBetweenTwoLobes) {
  constexpr std::int32_t kKept = 20, kLobe = 30;
  std::vector<std::int32_t> kept(kKept), members;
  std::iota(kept.begin(), kept.end(), 0);
  for (const std::int32_t first : {kKept, kKept + kLobe}) {
    members.insert(members.end(), kept.begin(), kept.end());
    for (std::int32_t v = first; v < first + kLobe; ++v) {
      members.push_back(v);
    }
  }
  const std::vector<std::int32_t> group_starts{0, kKept + kLobe, 2 * (kKept + kLobe)};
  constexpr std::size_t kVertices = kKept + 2 * kLobe;
  BlockMatrix stiffness({group_starts, members}, kVertices);
  RandomStream random(1, "stiffness");
  for (std::size_t row = 0; row < kVertices; ++row) {
    for (auto at = stiffness.row_start(row); at < stiffness.row_start(row + 1); ++at) {
      Eigen::Map<Eigen::Matrix3d> block(stiffness.block(at));
      for (Index i = 0; i < 9; ++i) {
        block.data()[i] = random.normal();
      }
      if (at == stiffness.row_start(row)) {
        block =
            200.0 * Eigen::Matrix3d::Identity();  // above the norm of the rest: positive definite
      }
    }
  }
  std::vector<Vector3d> at(kVertices, Vector3d::Zero());
  for (std::size_t v = kKept; v < kVertices; ++v) {
    at[v].x() = (v < kKept + kLobe ? -1.0 : 1.0) * (1.0 + 0.01 * static_cast<double>(v));
  }
  const std::vector<std::uint8_t> held(kVertices, 0);
  const MatrixXd found = condensed(stiffness, at, held, kept);

  const MatrixXd all = dense_stiffness(stiffness);
  constexpr Index kOuter = 3 * kKept, kInner = 6 * kLobe;
  const MatrixXd across = all.bottomLeftCorner(kInner, kOuter);
  const MatrixXd exact =
      all.topLeftCorner(kOuter, kOuter) -
      across.transpose() * all.bottomRightCorner(kInner, kInner).llt().solve(across);
  const MatrixXd error = MatrixXd(found.triangularView<Eigen::Lower>()) -
                         MatrixXd(exact.triangularView<Eigen::Lower>());
  EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-9 * exact.cwiseAbs().maxCoeff());
}

}  // namespace
}  // namespace haptrial::deformable::condense_test
