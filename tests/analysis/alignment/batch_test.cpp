#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "analysis/alignment/alignment.h"
#include "tests/analysis/alignment/cases.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::analysis {
namespace {

using test::Curve;
using test::smooth_curve;

struct Cases {
  std::vector<Curve> curves;
  std::vector<AlignmentPair> pairs;

  /// @param spread  sizes lie between rows and rows + spread, likewise columns.
  Cases(std::string_view name, std::size_t count, std::size_t rows, std::size_t columns,
        std::size_t spread) {
    RandomStream random(11, name);
    for (std::size_t k = 0; k < count; ++k) {
      curves.push_back(smooth_curve(random, rows + random.below(spread + 1)));
      curves.push_back(smooth_curve(random, columns + random.below(spread + 1)));
    }
    for (std::size_t k = 0; k < count; ++k) {
      pairs.push_back({curves[2 * k].view(), curves[2 * k + 1].view()});
    }
  }
};

/// Every test of this suite runs on every instruction set of the machine.
class AlignmentSetTest : public testing::TestWithParam<InstructionSet> {};

void expect_same(const Alignment& a, const Alignment& b, const std::string& where) {
  EXPECT_EQ(a.cost, b.cost) << where;  // bit for bit
  EXPECT_EQ(a.path, b.path) << where;
}

TEST_P(AlignmentSetTest, BatchEqualsSinglePairs) {
  Aligner aligner(GetParam());
  for (std::size_t count : {1u, 3u, 4u, 8u, 15u, 16u, 17u, 37u}) {
    for (auto [rows, columns] : {std::pair{1u, 1u},
                                 {1u, 23u},
                                 {23u, 1u},
                                 {5u, 7u},
                                 {64u, 64u},
                                 {65u, 127u},
                                 {130u, 99u}}) {
      for (double power : {1.0, 2.0}) {
        const Cases cases("batch", count, rows, columns, 0);
        const AlignmentOptions parameters{.penalty = 0.05, .power = power};
        std::vector<Alignment> batch(count);
        aligner.align_batch(cases.pairs, parameters, batch);
        for (std::size_t k = 0; k < count; ++k) {
          Alignment single;
          aligner.align(cases.pairs[k].target, cases.pairs[k].applied, parameters, single);
          expect_same(batch[k], single, std::to_string(rows) + "x" + std::to_string(columns));
        }
      }
    }
  }
}

TEST_P(AlignmentSetTest, BatchTakesPairsOfDifferentSizes) {
  Aligner aligner(GetParam());
  const AlignmentOptions parameters{};
  for (std::size_t spread : {3u, 150u}) {  // side by side, and too different for it
    const Cases cases("sizes", 48, 200, 211, spread);
    std::vector<Alignment> batch(cases.pairs.size());
    aligner.align_batch(cases.pairs, parameters, batch);
    for (std::size_t k = 0; k < batch.size(); ++k) {
      Alignment single;
      aligner.align(cases.pairs[k].target, cases.pairs[k].applied, parameters, single);
      expect_same(batch[k], single, std::to_string(k));
    }
  }
}

TEST_P(AlignmentSetTest, EveryInstructionSetGivesTheSameBits) {
  const Cases cases("sets", 32, 400, 380, 10);
  for (double power : {1.0, 2.0}) {
    const AlignmentOptions parameters{.slope_weight = 0.3, .penalty = 0.07, .power = power};
    std::vector<Alignment> here(cases.pairs.size()), baseline(cases.pairs.size());
    Aligner(GetParam()).align_batch(cases.pairs, parameters, here);
    Aligner(InstructionSet::kBaseline).align_batch(cases.pairs, parameters, baseline);
    for (std::size_t k = 0; k < here.size(); ++k) {
      expect_same(here[k], baseline[k], std::to_string(k));
      EXPECT_EQ(here[k].path, test::textbook_path<float>(cases.curves[2 * k],
                                                         cases.curves[2 * k + 1], parameters));
    }
  }
}

TEST_P(AlignmentSetTest, EveryInstructionSetGivesTheSameBitsByRowsToo) {
  const Cases cases("rows", 6, 150, 160, 10);
  for (double power : {1.5, 1.7}) {
    const AlignmentOptions options{.power = power, .pattern = StepPattern::kAsymmetric};
    for (const AlignmentPair& pair : cases.pairs) {
      Alignment here, baseline;
      Aligner(GetParam()).align(pair.target, pair.applied, options, here);
      Aligner(InstructionSet::kBaseline).align(pair.target, pair.applied, options, baseline);
      expect_same(here, baseline, std::to_string(power));
    }
  }
}

TEST_P(AlignmentSetTest, NothingIsAllocatedAfterTheFirstUse) {
  const Cases cases("allocation", 35, 150, 150, 0);
  const AlignmentOptions parameters{};
  Aligner aligner(GetParam());
  Alignment single;
  std::vector<Alignment> batch(cases.pairs.size());
  aligner.align(cases.pairs[0].target, cases.pairs[0].applied, parameters, single);
  aligner.align_batch(cases.pairs, parameters, batch);
  const haptrial::test::AllocationGuard guard;
  aligner.align(cases.pairs[1].target, cases.pairs[1].applied, parameters, single);
  aligner.align_batch(cases.pairs, parameters, batch);
  EXPECT_EQ(guard.count(), 0u);
}

TEST_P(AlignmentSetTest, AWorkspaceForgetsItsLastPair) {
  const Cases large("large", 16, 300, 300, 0), small("small", 16, 20, 31, 0);
  const AlignmentOptions parameters{};
  Aligner used(GetParam());
  std::vector<Alignment> first(16), again(16), fresh(16);
  used.align_batch(large.pairs, parameters, first);
  used.align_batch(small.pairs, parameters, again);
  Aligner(GetParam()).align_batch(small.pairs, parameters, fresh);
  for (std::size_t k = 0; k < 16; ++k) {
    expect_same(again[k], fresh[k], std::to_string(k));
  }
}

TEST(AlignmentBatchTest, BadBatchesAreRefused) {
  const Cases cases("refused", 16, 10, 10, 0);
  std::vector<Alignment> too_few(15), enough(16);
  Aligner aligner;
  EXPECT_THROW(aligner.align_batch(cases.pairs, {}, too_few), std::invalid_argument);
  auto pairs = cases.pairs;
  const std::vector<double> bad(10, std::nan(""));
  pairs[15].applied = {bad, bad};
  EXPECT_THROW(aligner.align_batch(pairs, {}, enough), std::invalid_argument);
  EXPECT_TRUE(align_batch({}, {}).empty());
}

TEST(AlignmentBatchTest, TheBaselineIsAlwaysThere) {
  const auto sets = available_instruction_sets();
  EXPECT_EQ(sets.front(), InstructionSet::kBaseline);
  EXPECT_EQ(sets.back(), best_instruction_set());
}

INSTANTIATE_TEST_SUITE_P(Sets, AlignmentSetTest, testing::ValuesIn(available_instruction_sets()),
                         [](const auto& test) {
                           std::string name(name_of(test.param));
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace haptrial::analysis
