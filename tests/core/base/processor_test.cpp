#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/base/instruction_set.h"
#include "core/base/one_processor.h"

namespace haptrial {
namespace {

/// Processors on which the calling thread may run.
cpu_set_t allowed() {
  cpu_set_t set;
  CPU_ZERO(&set);
  EXPECT_EQ(sched_getaffinity(0, sizeof set, &set), 0);
  return set;
}

TEST(OneProcessorTest, AThreadAndThoseItStartsStayOnOneUntilItEnds) {
  const cpu_set_t before = allowed();
  {
    const OneProcessor beside;
    const cpu_set_t own = allowed();
    EXPECT_EQ(CPU_COUNT(&own), 1);
    cpu_set_t started{};
    std::thread([&started] { started = allowed(); }).join();
    EXPECT_TRUE(CPU_EQUAL(&own, &started));
  }
  const cpu_set_t after = allowed();
  EXPECT_TRUE(CPU_EQUAL(&before, &after));
}

int baseline() { return 0; }
int avx2() { return 1; }
int avx512() { return 2; }

TEST(InstructionSetTest, ChoosesTheFunctionOfTheSetOrRefusesIt) {
  const auto available = available_instruction_sets();
  const std::vector<InstructionSet> all{InstructionSet::kBaseline, InstructionSet::kAvx2,
                                        InstructionSet::kAvx512};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool there = std::find(available.begin(), available.end(), all[i]) != available.end();
    if (there) {
      EXPECT_EQ(choose(all[i], baseline, avx2, avx512)(), static_cast<int>(i));
      EXPECT_EQ(choose(all[i], baseline, avx2)(), std::min(static_cast<int>(i), 1));
      EXPECT_NO_THROW(require_instruction_set(all[i]));
    } else {
      EXPECT_THROW(choose(all[i], baseline, avx2, avx512), std::invalid_argument);
    }
  }
}

Eigen::MatrixXd long_rows() {
  Eigen::MatrixXd rows(20000, 6);
  for (Eigen::Index i = 0; i < rows.size(); ++i) {
    rows(i) = 1.0 / static_cast<double>(i + 3);
  }
  return rows;
}

Eigen::MatrixXd product(const Eigen::MatrixXd& rows) { return rows.transpose() * rows; }

// A product of matrices has the same bits on every processor: Eigen is told the sizes of the
// caches.
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
