// Safe forces and speeds that are learned from experts, against planted values and a count of one's
// own.

#include "analysis/bone_drilling/feedback/safe_values.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "analysis/bone_drilling/feedback/findings.h"
#include "tests/analysis/bone_drilling/hand_made.h"

namespace haptrial::analysis::drilling::safe_values_test {
namespace {

NearestRemoval removal(int structure, double distance, double force, double speed = 0.01) {
  return {structure,
          {static_cast<float>(distance), static_cast<float>(force), static_cast<float>(speed)}};
}

TEST(SafeValuesTest, TheQuantilesOfPlantedForcesAreFoundInTheirInterval) {
  // 1.00 N down to 0.01 N at 3 mm, ten times as fast: every value once.
  std::vector<NearestRemoval> removals;
  for (int n = 100; n > 0; --n) {
    removals.push_back(removal(0, 3e-3, 0.01 * n, 0.1 * n));
  }
  const std::vector<std::string> names{"nerve", "sinus"};
  const std::vector<SafeCase> experts{{"S01", removals}};
  const auto profiles = learn_safe_values(experts, names);
  ASSERT_EQ(profiles.size(), 2u);
  EXPECT_EQ(profiles[0].bins.size(), 15u);  // 2 mm within 30 mm
  const SafeBin& bin = profiles[0].bins[1];
  EXPECT_EQ(bin.removals, 100u);
  ASSERT_TRUE(bin.force && bin.speed);
  EXPECT_FLOAT_EQ(static_cast<float>(bin.force->low), 0.05F);
  EXPECT_FLOAT_EQ(static_cast<float>(bin.force->median), 0.50F);
  EXPECT_FLOAT_EQ(static_cast<float>(bin.force->high), 0.95F);
  EXPECT_FLOAT_EQ(static_cast<float>(bin.speed->high), 9.5F);
  EXPECT_EQ(profiles[0].at(2.5e-3), &bin);
  EXPECT_EQ(profiles[0].at(31e-3), nullptr);
  EXPECT_FALSE(profiles[0].bins[0].force);
  for (const SafeBin& other : profiles[1].bins) {
    EXPECT_EQ(other.removals, 0u);
  }
}

TEST(SafeValuesTest, AnExpertWithManyRemovalsWeighsAsMuchAsOneWithFew) {
  // Nine hundred removals with 1 N and a hundred with 2 N: of the participants half each.
  const std::vector<NearestRemoval> many(900, removal(0, 1e-3, 1.0));
  const std::vector<NearestRemoval> few(100, removal(0, 1e-3, 2.0));
  const std::vector<std::string> names{"nerve"};
  const std::vector<SafeCase> experts{{"S01", many}, {"S02", few}};
  SafeOptions options;
  options.low = 0.45;
  options.high = 0.55;
  const auto bin = learn_safe_values(experts, names, options)[0].bins[0];
  EXPECT_EQ(bin.participants, 2u);
  EXPECT_DOUBLE_EQ(bin.force->low, 1.0);
  EXPECT_DOUBLE_EQ(bin.force->median, 1.0);  // up to 1 N lies half of all
  EXPECT_DOUBLE_EQ(bin.force->high, 2.0);
  // Two procedures of one participant are those of one participant.
  const std::vector<SafeCase> one{{"S01", many}, {"S01", few}};
  EXPECT_DOUBLE_EQ(learn_safe_values(one, names, options)[0].bins[0].force->high, 1.0);
}

TEST(SafeValuesTest, AnIntervalWithTooFewRemovalsSaysNothing) {
  const std::vector<NearestRemoval> removals(19, removal(0, 5e-3, 1.0));
  const std::vector<std::string> names{"nerve"};
  const std::vector<SafeCase> experts{{"S01", removals}};
  const auto bin = learn_safe_values(experts, names)[0].bins[2];
  EXPECT_EQ(bin.removals, 19u);
  EXPECT_FALSE(bin.force || bin.speed);
  SafeOptions wrong;
  wrong.low = 0.95;
  wrong.high = 0.05;
  EXPECT_THROW(learn_safe_values(experts, names, wrong), std::invalid_argument);
}

/// A block with two vital rods, along x at the bottom and along y at the far side.
bone::BoneModel block_with_rods() {
  bone::BoneModel model = test::block(20, 20, 20);
  model.structures.push_back({"nerve", {1.0, 1.0, 0.0}, 1.0, true});
  model.structures.push_back({"sinus", {0.2, 0.3, 0.9}, 1.0, true});
  model.structures.push_back({"canal", {0.5, 0.5, 0.5}, 1.0, false});
  for (int i = 0; i < 20; ++i) {
    test::mark(model, {i, 2, 1}, 2);
    test::mark(model, {17, i, 6}, 3);
    test::mark(model, {3, i, 12}, 4);
  }
  return model;
}

Procedure random_drilling(std::uint64_t seed, const std::string& participant) {
  Procedure p = test::procedure_on(block_with_rods());
  p.participant = participant;
  RandomStream random(seed, "drilling");
  std::vector<bool> gone(8000, false);
  for (int n = 0; n < 1500; ++n) {
    const bone::Voxel v = test::any_voxel(random, p.bone->grid);
    const std::size_t at = p.bone->grid.index(v);
    if (!gone[at]) {
      gone[at] = true;
      test::remove_in_turn(p, {v}, random.uniform(0.1, 2.0), random.uniform(0.001, 0.05));
    }
  }
  p.views.push_back({0, {0.01, 0.01, 0.3}, {0.01, 0.01, 0.0}});
  return p;
}

/// The nearest rod by all of its voxels.
std::pair<int, double> nearest_rod(const bone::Voxel& v) {
  double nerve = 1e9, sinus = 1e9;
  for (int i = 0; i < 20; ++i) {
    nerve = std::min(nerve, (v - bone::Voxel(i, 2, 1)).cast<double>().norm());
    // At crossings of the rods nothing is marked twice: they lie 5 voxels apart.
    sinus = std::min(sinus, (v - bone::Voxel(17, i, 6)).cast<double>().norm());
  }
  return nerve <= sinus ? std::pair(0, 1e-3 * nerve) : std::pair(1, 1e-3 * sinus);
}

TEST(SafeValuesTest, FaultsOfADrillingAreThoseOfACountByHand) {
  const std::vector<Procedure> experts{random_drilling(1, "S01"), random_drilling(2, "S02"),
                                       random_drilling(3, "P07")};
  const Procedure trainee = random_drilling(4, "P07");
  StudyBones bones;
  std::vector<ExpertProcedure> summaries;
  for (const Procedure& p : experts) {
    summaries.push_back(expert_procedure(p, {}, bones));
  }
  const Experts learned = experts_of(summaries, "P07");
  EXPECT_EQ(learned.participants, (std::vector<std::string>{"S01", "S02"}));
  const Findings f = findings_of(trainee, learned, bones);
  EXPECT_EQ(f.structures, (std::vector<std::string>{"nerve", "sinus"}));

  // The expected values by hand: all forces of both experts by rod and interval, each weighed by
  // its expert's number.
  const auto interval = [](double d) { return std::floor(static_cast<float>(d) / 2e-3); };
  std::map<std::pair<int, double>, std::array<std::vector<double>, 2>> pressed;
  for (std::size_t e = 0; e < 2; ++e) {
    for (const Removal& removal : experts[e].removals) {
      const auto [rod, away] = nearest_rod(removal.voxel);
      pressed[{rod, interval(away)}][e].push_back(static_cast<float>(removal.force));
    }
  }
  std::size_t judged = 0, hard = 0, vital = 0;
  for (std::size_t n = 0; n < trainee.removals.size(); ++n) {
    const auto [rod, distance] = nearest_rod(trainee.removals[n].voxel);
    EXPECT_NEAR(f.nearest[n].at.distance, distance, 1e-8);
    std::vector<std::pair<double, double>> forces;
    for (const std::vector<double>& own : pressed[{rod, interval(distance)}]) {
      for (const double force : own) {
        forces.emplace_back(force, 0.5 / static_cast<double>(own.size()));
      }
    }
    vital += trainee.removals[n].label == 2 || trainee.removals[n].label == 3 ? 1 : 0;
    if (forces.size() < 20) {
      EXPECT_EQ(f.judged[n], 0);
      continue;
    }
    ++judged;
    double below = 0.0;  // the share of the experts that pressed less
    double all = 0.0;
    for (const auto& [force, weight] : forces) {
      all += weight;
      below += force < static_cast<float>(trainee.removals[n].force) ? weight : 0.0;
    }
    const bool too_hard = below >= 0.95 * all - 1e-6;
    EXPECT_EQ((f.faults[n] & kForceFault) != 0, too_hard) << n;
    hard += too_hard ? 1 : 0;
  }
  EXPECT_GT(judged, 1000u);
  EXPECT_GT(hard, 10u);
  EXPECT_EQ(f.count(kForceFault), hard);
  EXPECT_EQ(f.count(kVitalFault), vital);
  EXPECT_EQ(f.count(kHiddenFault), f.faults.size() - f.summary.visibility.count);
}

TEST(SafeValuesTest, WithoutVitalStructuresNothingIsJudged) {
  Procedure p = test::procedure_on(test::block(6, 6, 6));
  test::remove_in_turn(p, {{1, 1, 1}, {2, 1, 1}}, 5.0, 0.5);
  StudyBones bones;
  const std::vector<ExpertProcedure> summaries{
      expert_procedure(random_drilling(1, "S01"), {}, bones)};
  const Findings f = findings_of(p, experts_of(summaries, "P01"), bones);
  EXPECT_TRUE(f.structures.empty());
  EXPECT_EQ(f.count(kForceFault | kSpeedFault | kVitalFault), 0u);
  EXPECT_EQ(f.nearest[0].structure, -1);
  EXPECT_EQ(f.labels_left[p.bone->grid.index(1, 1, 1)], 0);
  EXPECT_EQ(f.labels_left[p.bone->grid.index(3, 1, 1)], 1);
}

}  // namespace
}  // namespace haptrial::analysis::drilling::safe_values_test
