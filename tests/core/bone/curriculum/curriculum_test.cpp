// Which case of a curriculum comes next, by procedures whose figures are written down here.

#include "core/bone/curriculum/curriculum.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/base/definition/table.h"
#include "tests/support/message_of.h"

namespace haptrial::bone {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const char* const kCases = R"([[curriculum.cases]]
name = "plain"
pass = ["removed >= 80", "injured <= 0"]
in_a_row = 2
[[curriculum.cases]]
name = "hard"
bone = "second"
pass = ["removed >= 80"]
repeat = "plain"
after = 2
)";

Curriculum read(const std::string& text) {
  Table root = Table::parse(text, "class.toml");
  Table table = root.table("curriculum");
  Curriculum curriculum = read_curriculum(table, {"first", "second"});
  root.finish();
  return curriculum;
}

CaseAttempt plain(double removed, double injured) {
  return {"plain", "2026-03-02", {{"removed", removed}, {"injured", injured}}};
}
CaseAttempt hard(double removed) { return {"hard", "2026-03-09", {{"removed", removed}}}; }

/// The name of the case that comes next; "-": all are done.
std::string next_after(const std::vector<CaseAttempt>& attempts) {
  const Curriculum curriculum = read(kCases);
  const CurriculumStanding found = standing(curriculum, attempts);
  return found.next ? curriculum.cases[*found.next].name : "-";
}

TEST(CurriculumTest, IsReadWithItsDefaults) {
  const Curriculum curriculum = read(kCases);
  ASSERT_EQ(curriculum.cases.size(), 2u);
  EXPECT_EQ(curriculum.cases[0].bone, "first");
  EXPECT_EQ(curriculum.cases[1].bone, "second");
  ASSERT_EQ(curriculum.cases[0].pass.size(), 2u);
  EXPECT_TRUE(curriculum.cases[0].pass[0].least);
  EXPECT_FALSE(curriculum.cases[0].pass[1].least);
  EXPECT_EQ(curriculum.cases[0].pass[0].value, 80.0);
  EXPECT_EQ(curriculum.case_of("hard, hints on"), &curriculum.cases[1]);
  EXPECT_EQ(curriculum.case_of("plain"), &curriculum.cases[0]);
  EXPECT_EQ(curriculum.case_of("plain hints on"), nullptr);
}

TEST(CurriculumTest, AMistakeGetsASentence) {
  const auto refusal = [](const std::string& more) {
    return test::message_of([&] { read("[[curriculum.cases]]\nname = \"a\"\n" + more); });
  };
  EXPECT_THAT(refusal("pass = [\"removed > 80\"]"),
              AllOf(HasSubstr("removed > 80"), HasSubstr(">= 80")));
  EXPECT_THAT(refusal("pass = [\"removed >= many\"]"), HasSubstr("removed >= many"));
  EXPECT_THAT(refusal("pass = [\"removed >= inf\"]"), HasSubstr("removed >= inf"));
  EXPECT_THAT(refusal("pass = [\"removed >= 1\"]\nbone = \"third\""),
              HasSubstr("allowed: one of bone.bones: first"));
  EXPECT_THAT(refusal("pass = [\"removed >= 1\"]\nrepeat = \"b\""),
              HasSubstr("the first case has none before it"));
  EXPECT_THAT(refusal("pass = [\"removed >= 1\"]\n[[curriculum.cases]]\nname = \"a\"\npass = "
                      "[\"removed >= 1\"]"),
              HasSubstr("a name of its own"));
}

TEST(CurriculumTest, ACaseIsDoneAfterSoManyPassesInARow) {
  EXPECT_EQ(next_after({}), "plain");
  EXPECT_EQ(next_after({plain(90.0, 0.0)}), "plain");
  EXPECT_EQ(next_after({plain(90.0, 0.0), plain(79.9, 0.0), plain(90.0, 0.0)}), "plain");
  EXPECT_EQ(next_after({plain(90.0, 0.0), plain(80.0, 0.0)}), "hard") << "80 is enough";
  EXPECT_EQ(next_after({plain(90.0, 0.0), plain(90.0, 1.0)}), "plain") << "every criterion counts";
  EXPECT_EQ(next_after({plain(90.0, 0.0), plain(90.0, 0.0), hard(85.0)}), "-");
}

TEST(CurriculumTest, AQuantityThatAProcedureLacksIsMissed) {
  EXPECT_EQ(next_after({{"plain", "", {{"removed", 90.0}}}, plain(90.0, 0.0)}), "plain");
}

// More than is measured is at least whatever was asked for, and never at most so much.
TEST(CurriculumTest, WhatLiesBeyondTheMeasureIsAtLeastAnything) {
  const CaseAttempt far = plain(std::numeric_limits<double>::infinity(), 0.0);
  EXPECT_EQ(next_after({far, far}), "hard");
  const Curriculum curriculum = read(kCases);
  const CaseAttempt other = plain(90.0, std::numeric_limits<double>::infinity());
  EXPECT_EQ(why_next(curriculum, standing(curriculum, std::vector{other})),
            "missed last: injured beyond what is measured (at most 0)");
}

TEST(CurriculumTest, AnEarlierCaseComesAgainAfterTooManyFailures) {
  const std::vector<CaseAttempt> good{plain(90.0, 0.0), plain(90.0, 0.0)};
  auto all = good;
  all.push_back(hard(50.0));
  EXPECT_EQ(next_after(all), "hard");
  all.push_back(hard(50.0));
  EXPECT_EQ(next_after(all), "plain") << "after the second failure";
  const Curriculum curriculum = read(kCases);
  EXPECT_EQ(why_next(curriculum, standing(curriculum, all)),
            "again, since a later case was missed too often");
  all.push_back(plain(90.0, 0.0));
  EXPECT_EQ(next_after(all), "plain") << "two in a row, anew";
  all.push_back(plain(90.0, 0.0));
  EXPECT_EQ(next_after(all), "hard");
  all.push_back(hard(50.0));
  EXPECT_EQ(next_after(all), "hard") << "failures count anew";
}

TEST(CurriculumTest, OtherCasesMoveNothingOn) {
  const Curriculum curriculum = read(kCases);
  const CurriculumStanding found =
      standing(curriculum, std::vector{hard(90.0), CaseAttempt{"gone", "", {}}});
  EXPECT_EQ(found.next, 0u);
  EXPECT_EQ(found.cases[1].attempts, 1u);
  EXPECT_EQ(found.cases[1].passed, 1u);
  EXPECT_FALSE(found.cases[1].done);
}

TEST(CurriculumTest, SaysWhatWasMissed) {
  const Curriculum curriculum = read(kCases);
  const auto why = [&](const std::vector<CaseAttempt>& attempts) {
    return why_next(curriculum, standing(curriculum, attempts));
  };
  EXPECT_EQ(why({}), "");
  EXPECT_EQ(why({plain(90.0, 0.0)}), "passed 1 of 2 in a row");
  EXPECT_EQ(why({plain(72.125, 3.0)}),
            "missed last: removed 72.12 (at least 80); injured 3 (at "
            "most 0)");
}

}  // namespace
}  // namespace haptrial::bone
