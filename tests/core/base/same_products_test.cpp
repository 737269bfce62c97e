// A product of matrices has the same bits on every processor: Eigen is told the sizes of the
// caches.

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace haptrial {
namespace {

Eigen::MatrixXd long_rows() {
  Eigen::MatrixXd rows(20000, 6);
  for (Eigen::Index i = 0; i < rows.size(); ++i) {
    rows(i) = 1.0 / static_cast<double>(i + 3);
  }
  return rows;
}

Eigen::MatrixXd product(const Eigen::MatrixXd& rows) { return rows.transpose() * rows; }

TEST(SameProductsTest, TheCachesOfTheProcessorAreNotAsked) {
  EXPECT_EQ(Eigen::l1CacheSize(), 32 << 10);
  EXPECT_EQ(Eigen::l2CacheSize(), 1 << 20);
  EXPECT_EQ(Eigen::l3CacheSize(), 32 << 20);
}

TEST(SameProductsTest, TheirSizesWouldChangeTheSums) {
  const Eigen::MatrixXd rows = long_rows(), before = product(rows);
  Eigen::setCpuCacheSizes(48 << 10, 2 << 20, 32 << 20);
  const Eigen::MatrixXd other = product(rows);
  Eigen::setCpuCacheSizes(32 << 10, 1 << 20, 32 << 20);
  EXPECT_TRUE(other.isApprox(before, 1e-14));
  EXPECT_NE(other, before);
  EXPECT_EQ(product(rows), before);
}

}  // namespace
}  // namespace haptrial
