// Hints on a bone whose distances and sight lines are known by hand.

#include "core/bone/hint/hint_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "core/bone/hint/hints_beside.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/message_of.h"

namespace haptrial::hint {
namespace {

using What = HintVoxel::What;
constexpr double kRate = 1000.0;

/// A block of 20^3 voxels of 1 mm; its layer i = 0 is a nerve, i = 19 a sinus without limits.
std::shared_ptr<const bone::BoneModel> block() {
  auto model = std::make_shared<bone::BoneModel>();
  model->grid = {{20, 20, 20}, Eigen::Vector3d::Zero(), 1e-3};
  model->labels.assign(model->grid.count(), 1);
  for (int k = 0; k < 20; ++k) {
    for (int j = 0; j < 20; ++j) {
      model->labels[model->grid.index(0, j, k)] = 2;
      model->labels[model->grid.index(19, j, k)] = 3;
    }
  }
  model->structures = {{}, {"bone"}, {"nerve"}, {"sinus"}};
  model->structures[2].vital = model->structures[3].vital = true;
  return model;
}

HintSetup setup() {
  HintSetup s;
  s.kinds.fill(true);
  s.reach = 5e-3;
  s.fewest = 3;
  s.within = 0.1;
  s.holds = 0.5;
  s.limits.structures = {{"nerve", {{0.0, 2.5e-3, 1.0, 0.01}, {2.5e-3, 4.5e-3, 2.0, 0.02}}}};
  return s;
}

// Limits of another body would give no hint at all, without a word.
TEST(HintMapTest, LimitsWithoutAStructureOfTheBoneAreRefused) {
  EXPECT_THAT(HintMap(setup(), *block()).judged(), testing::ElementsAre("nerve"));
  HintSetup heart = setup();
  heart.file = "heart.toml";
  heart.limits.structures.front().name = "left ventricle";
  EXPECT_THAT(test::message_of([&] { HintMap(heart, *block()); }),
              testing::AllOf(testing::HasSubstr("heart.toml has safe values near left ventricle"),
                             testing::HasSubstr("structures: nerve, sinus")));
  heart.kinds = {};
  heart.kinds[static_cast<std::size_t>(HintKind::kHidden)] = true;
  EXPECT_NO_THROW(HintMap(heart, *block())) << "hidden bone needs no limits";
}

class HintWatchTest : public testing::Test {
 protected:
  /// A tick with a burr so small that it hides nothing, seen from above (k grows).
  void tick(std::vector<HintVoxel> voxels = {}) {
    ++now_;
    for (HintVoxel& voxel : voxels) {
      voxel.sequence = now_;
    }
    const Eigen::Vector3d eye(0.01, 0.01, 1.0);
    watch_.tick({now_, {}, eye}, voxels, shown_);
  }
  void rest(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      tick();
    }
  }
  /// A voxel of the top layer, i mm from the nerve, so that it is seen.
  static HintVoxel top(int i, int j, double force, double speed) {
    return {0, What::kRemoved, {i, j, 19}, force, speed};
  }

  std::shared_ptr<const bone::BoneModel> bone_ = block();
  HintSetup setup_ = setup();
  HintWatch watch_{setup_, std::make_shared<const HintMap>(setup_, *bone_), bone_,
                   Eigen::Isometry3d::Identity(), kRate};
  bool shown_{true};
  std::uint64_t now_{0};
};

TEST_F(HintWatchTest, TheThirdFaultyRemovalWithinAMomentBeginsAHintOfForce) {
  tick({top(2, 0, 1.5, 0.005)});
  tick({top(2, 1, 1.6, 0.005)});
  EXPECT_EQ(watch_.on(), 0);
  tick({top(2, 2, 1.2, 0.005)});
  EXPECT_EQ(watch_.on(), bit(HintKind::kForce));
  EXPECT_EQ(watch_.structure(), 0);
  tick({top(2, 3, 1.9, 0.004), top(3, 3, 1.9, 0.004)});  // the second is allowed 2 N
  EXPECT_TRUE(watch_.rows().empty()) << "it goes on";
  rest(499);
  EXPECT_NE(watch_.on(), 0);
  rest(1);
  EXPECT_EQ(watch_.on(), 0) << "half a second after the last one";
  ASSERT_EQ(watch_.rows().size(), 1u);
  const record::HintRow& row = watch_.rows().front();
  EXPECT_EQ(row.kind, HintKind::kForce);
  EXPECT_EQ(row.begin, 3u);
  EXPECT_EQ(row.sequence, 504u);
  EXPECT_EQ(row.removals, 4);
  EXPECT_TRUE(row.shown);
  EXPECT_EQ(row.structure, "nerve");
  EXPECT_FLOAT_EQ(static_cast<float>(row.distance), 2e-3F);
  EXPECT_EQ(row.force, 1.9) << "of the worst one since it began";
  EXPECT_EQ(row.speed, 0.004);
  EXPECT_EQ(row.limit_force, 1.0);
  EXPECT_EQ(row.limit_speed, 0.01);
}

TEST_F(HintWatchTest, TooFewOrTooSlowlyAreNoHint) {
  for (int j = 0; j < 10; ++j) {
    tick({top(2, j, 5.0, 0.0)});
    rest(60);  // three within 0.12 s
  }
  EXPECT_EQ(watch_.on(), 0);
  watch_.end();
  EXPECT_TRUE(watch_.rows().empty());
}

TEST_F(HintWatchTest, WhereNothingIsKnownNobodyIsTooStrong) {
  for (int j = 0; j < 6; ++j) {
    tick({top(10, j, 50.0, 5.0)});  // beyond the reach of both
    tick({top(17, j, 50.0, 5.0)});  // beside the sinus, of which experts said nothing
    tick({top(5, j, 50.0, 5.0)});   // within reach of the nerve, beyond what is known
  }
  EXPECT_EQ(watch_.on(), 0);
}

TEST_F(HintWatchTest, SpeedHasALimitOfItsOwn) {
  for (int j = 0; j < 3; ++j) {
    tick({top(4, j, 1.9, 0.025)});
  }
  EXPECT_EQ(watch_.on(), bit(HintKind::kSpeed));
  watch_.end();
  ASSERT_EQ(watch_.rows().size(), 1u);
  EXPECT_EQ(watch_.rows().front().kind, HintKind::kSpeed);
  EXPECT_EQ(watch_.rows().front().limit_speed, 0.02);
  EXPECT_EQ(watch_.rows().front().sequence, now_) << "the pass has ended";
}

TEST_F(HintWatchTest, WhatIsUnderAnotherVoxelIsHiddenUntilThatIsGone) {
  for (int j = 0; j < 3; ++j) {
    tick({{0, What::kRemoved, {10, j, 15}, 0.1, 0.001}});
  }
  EXPECT_EQ(watch_.on(), bit(HintKind::kHidden));
  EXPECT_EQ(watch_.structure(), -1) << "it is about no structure";
  rest(600);
  for (int k = 19; k > 15; --k) {
    for (int j = 3; j < 6; ++j) {
      watch_.gone({10, j, k});
    }
  }
  // The eye is above the middle of the block: a column is seen along itself, nearly.
  const Eigen::Vector3d eye(0.01, 0.004, 1000.0);
  for (int j = 3; j < 6; ++j) {
    ++now_;
    const std::vector<HintVoxel> voxels{{now_, What::kRemoved, {10, j, 15}, 0.1, 0.001}};
    watch_.tick({now_, {}, eye}, voxels, shown_);
  }
  EXPECT_EQ(watch_.on(), 0);
}

TEST_F(HintWatchTest, CutsAndCrumbsAreNobodysFault) {
  for (int j = 0; j < 5; ++j) {
    tick({{0, What::kCut, {1, j, 10}, 9.0, 9.0}});
  }
  EXPECT_EQ(watch_.on(), 0);
}

TEST_F(HintWatchTest, ThreadsRecordTheSameAsSteps) {
  const auto watch = [this] {
    return std::make_unique<HintWatch>(setup_, std::make_shared<const HintMap>(setup_, *bone_),
                                       bone_, Eigen::Isometry3d::Identity(), kRate);
  };
  SteppedHints stepped(nullptr);
  ThreadedHints threaded(nullptr);
  stepped.begin(watch());
  threaded.begin(watch());
  stepped.let_show(false);
  threaded.let_show(false);
  const auto drill = [](HintsBeside& hints) {
    for (std::uint64_t tick = 1; tick <= 8000; ++tick) {
      const int at = static_cast<int>(tick / 20);
      if (tick % 20 == 0 && tick % 3000 < 1500) {
        hints.voxel({tick, What::kRemoved, {1 + at % 2, at % 20, 19 - at / 120}, 1.5, 0.015});
      }
      hints.after_tick({tick, {Eigen::Vector3d::Zero(), 1e-3}, {0.01, 0.01, 1.0}});
      if (tick % 500 == 0) {
        hints.settle();
      }
    }
    hints.settle();
    hints.end_pass();
    return hints.take();
  };
  const auto a = drill(stepped);
  const auto b = drill(threaded);
  EXPECT_EQ(threaded.dropped(), 0u);
  ASSERT_GE(a.size(), 4u);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].begin, b[i].begin);
    EXPECT_EQ(a[i].sequence, b[i].sequence);
    EXPECT_EQ(a[i].kind, b[i].kind);
    EXPECT_EQ(a[i].removals, b[i].removals);
    EXPECT_EQ(a[i].force, b[i].force);
    EXPECT_FALSE(b[i].shown);
  }
  EXPECT_EQ(threaded.now().kinds, 0) << "not shown";
}

TEST_F(HintWatchTest, TheServoThreadOnlyPushes) {
  ThreadedHints hints(nullptr);
  hints.begin(std::make_unique<HintWatch>(setup_, std::make_shared<const HintMap>(setup_, *bone_),
                                          bone_, Eigen::Isometry3d::Identity(), kRate));
  std::size_t count = 0;
  {
    const test::AllocationGuard guard;  // of this thread
    for (std::uint64_t tick = 1; tick <= 500; ++tick) {
      hints.voxel({tick, What::kRemoved, {2, static_cast<int>(tick % 20), 19}, 5.0, 0.5});
      hints.after_tick({tick, {Eigen::Vector3d::Zero(), 1e-3}, Eigen::Vector3d::UnitZ()});
      static_cast<void>(hints.now());
    }
    count = guard.count();
  }
  EXPECT_EQ(count, 0u);
  hints.settle();
  EXPECT_NE(hints.now().kinds & bit(HintKind::kForce), 0);
}

}  // namespace
}  // namespace haptrial::hint
