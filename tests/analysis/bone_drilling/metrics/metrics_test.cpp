#include "analysis/bone_drilling/metrics/metrics.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "analysis/files/csv.h"
#include "tests/analysis/bone_drilling/hand_made.h"

namespace haptrial::analysis::drilling::metrics_test {
namespace {

/// A row of bone with a nerve at its end and a second one, not vital, at its beginning.
bone::BoneModel row() {
  bone::BoneModel model = test::block(30, 1, 1);
  model.structures.push_back({"nerve", {}, 1.0, true});
  model.structures.push_back({"canal", {}, 1.0, false});
  test::mark(model, {29, 0, 0}, 2);
  test::mark(model, {0, 0, 0}, 3);
  return model;
}

/// Drills from voxel 10 on up to `last`; the force is a tenth of the voxel's number.
Procedure drilled(const std::string& participant, const std::string& group, int last,
                  const std::shared_ptr<const bone::BoneModel>& bone) {
  Procedure p = test::procedure_on(row());
  p.bone = bone;
  p.participant = participant;
  p.group = group;
  p.session = participant + ".h5";
  for (int i = 10; i <= last; ++i) {
    test::remove_in_turn(p, {{i, 0, 0}}, 0.1 * i, 0.002 * i);
  }
  return p;
}

class MetricsTest : public ::testing::Test {
 protected:
  ProcedureSummary summary(const std::string& participant, const std::string& group, int last,
                           const MetricOptions& options = {}) {
    return summarize(drilled(participant, group, last, bone_), options, study_);
  }
  StudyBones study_;
  std::shared_ptr<const bone::BoneModel> bone_ = study_.keep(row());
};

TEST_F(MetricsTest, ScalarsHaveTheirUnits) {
  const ProcedureSummary found = summary("A", "x", 28);
  // Voxels 24 to 28 are no farther than 5 mm from the nerve at 29.
  EXPECT_NEAR(*found.value("near_force"), 2.6, 1e-6);
  EXPECT_NEAR(*found.value("near_speed"), 52.0, 1e-5) << "mm/s";
  EXPECT_EQ(*found.value("injured_voxels"), 0.0);
  EXPECT_NEAR(*found.value("time"), 0.019, 1e-12);
  EXPECT_NEAR(*found.value("burr_diameter"), 2.0, 1e-12);
  EXPECT_EQ(*found.value("visible_share"), 0.0) << "nobody looked";
  EXPECT_FALSE(found.value("region_log_ratio"));
  EXPECT_EQ(found.removed.size(), 19u);
  EXPECT_EQ(found.removed.front(), 10u);
  EXPECT_EQ(*summary("A", "x", 29).value("injured_voxels"), 1.0);
  EXPECT_EQ(*summary("A", "x", 29).value("injured_structures"), 1.0);
  EXPECT_THROW((void)found.value("charm"), std::invalid_argument);
}

TEST_F(MetricsTest, ABurrThatAloneDrilledHasItsOwnDiameter) {
  std::set<double> diameters;
  for (int last = 10; last < 28; ++last) {
    Procedure p = drilled("A", "x", last, bone_);
    p.tools.at(0).burr_radius = 0.0029;  // sums of it round differently from time to time
    diameters.insert(*summarize(p, {}, study_).value("burr_diameter"));
  }
  EXPECT_EQ(diameters.size(), 1u);
}

TEST_F(MetricsTest, StructuresCanBeChosen) {
  const ProcedureSummary vital = summary("A", "x", 20);
  ASSERT_EQ(vital.near.size(), 1u);
  EXPECT_EQ(vital.near[0].structure, "nerve");
  EXPECT_FALSE(vital.value("near_force")) << "9 mm away at the nearest";
  MetricOptions options;
  options.structures = {"canal", "unicorn"};
  options.near = 11e-3;
  const ProcedureSummary chosen = summary("A", "x", 20, options);
  ASSERT_EQ(chosen.near.size(), 2u);
  EXPECT_EQ(chosen.near[0].removals.size(), 11u);
  EXPECT_TRUE(chosen.near[1].removals.empty());
  EXPECT_NEAR(*chosen.value("near_force"), 1.05, 1e-6) << "voxels 10 and 11";
}

TEST_F(MetricsTest, RegionScoresComeFromTheOthers) {
  std::vector<ProcedureSummary> all;
  for (int n = 0; n < 3; ++n) {
    all.push_back(summary(fmt::format("E{}", n), "surgeons", 25));
    all.push_back(summary(fmt::format("N{}", n), "novices", 15));
  }
  const std::vector<std::string> experts{"surgeons"};
  const auto scores = add_region_scores(all, experts);
  ASSERT_EQ(scores.size(), 6u);
  // Two procedures each are left: p is 3/4 or 1/4. Ten voxels tell the groups apart.
  EXPECT_NEAR(*all[0].value("region_log_ratio"), 10.0 * std::log(3.0), 1e-9);
  EXPECT_NEAR(*all[1].value("region_log_ratio"), -10.0 * std::log(3.0), 1e-9);
  EXPECT_NEAR(*scores[1].removed_only, 0.0, 1e-9) << "both groups removed what a novice did";
  EXPECT_GT(*scores[0].resubstitution, *scores[0].score);
}

TEST_F(MetricsTest, OtherBonesCannotBeCompared) {
  std::vector<ProcedureSummary> all{summary("A", "surgeons", 20), summary("B", "surgeons", 20),
                                    summary("C", "novices", 20), summary("D", "novices", 20)};
  bone::BoneModel other = row();
  test::mark(other, {5, 0, 0}, 0);
  all[3].bone = study_.keep(other);
  const std::vector<std::string> experts{"surgeons"};
  EXPECT_FALSE(add_region_scores(all, experts)[0].score);
  EXPECT_FALSE(all[0].value("region_log_ratio"));
}

TEST_F(MetricsTest, TheTableReadsBack) {
  const std::vector<ProcedureSummary> all{summary("A,1", "x", 28), summary("B", "y", 12)};
  const CsvTable table = CsvTable::parse(metrics_csv(all), "metrics.csv");
  ASSERT_EQ(table.rows(), 2u);
  ASSERT_EQ(table.columns().size(), 6 + metric_kinds().size() + figures_of(all[0].achieved).size());
  EXPECT_EQ(table.text(0, table.column("participant")), "A,1");
  EXPECT_EQ(table.text(1, table.column("group")), "y");
  EXPECT_EQ(table.numbers(table.column("time_s"))[0], *all[0].value("time"));
  EXPECT_EQ(table.numbers(table.column("removed_mm3"))[1], *all[1].value("removed"));
  EXPECT_EQ(table.text(1, table.column("near_force_N")), "") << "nothing was near";
  EXPECT_TRUE(table.has("near_speed_mm_per_s"));
  EXPECT_TRUE(table.has("stroke_rate_per_s"));
}

TEST_F(MetricsTest, TheTableHasTheCasesOfACurriculum) {
  std::vector<ProcedureSummary> all{summary("A", "x", 28), summary("B", "y", 12)};
  EXPECT_FALSE(CsvTable::parse(metrics_csv(all), "metrics.csv").has("case"));
  all[1].case_name = "low tegmen";
  const CsvTable table = CsvTable::parse(metrics_csv(all), "metrics.csv");
  EXPECT_EQ(table.text(0, table.column("case")), "");
  EXPECT_EQ(table.text(1, table.column("case")), "low tegmen");
  EXPECT_EQ(table.numbers(table.column("time_s"))[0], *all[0].value("time"));
}

TEST_F(MetricsTest, NamesAreUnique) {
  std::set<std::string> names;
  for (const MetricKind& kind : metric_kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_FALSE(kind.title.empty());
  }
}

TEST_F(MetricsTest, FieldsOfABoneAreMadeOnce) {
  EXPECT_EQ(study_.keep(row()), bone_);
  EXPECT_EQ(study_.field(bone_, 2, 5e-3), study_.field(bone_, 2, 5e-3));
  EXPECT_NE(study_.field(bone_, 2, 5e-3), study_.field(bone_, 3, 5e-3));
  EXPECT_TRUE(study_.field(bone_, std::vector<bool>{}, 5e-3)->empty());
  EXPECT_EQ(*study_.field(bone_, std::vector<bool>{false, false, true}, 5e-3)->at({27, 0, 0}),
            2e-3);
}

}  // namespace
}  // namespace haptrial::analysis::drilling::metrics_test
