#include "analysis/contact/exam/exam_score.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/contact/exam/exam_bodies.h"
#include "analysis/contact/truth/true_contact.h"
#include "core/base/error.h"
#include "core/contact/felt_body.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::evaluation::exam_score_test {
namespace {

using Eigen::Vector3d;
using Forces = std::vector<Vector3d>;

ExamCase sphere_case(double friction) {
  const ExamBody& sphere = exam_bodies()[1];
  ExamCase one{"sphere", {.friction = friction}, there_and_back(sphere), {}};
  for (const TrueContact& c : true_contacts(sphere.body, one.tool, one.task.stiffness, friction)) {
    one.truth.push_back(c.force);
  }
  return one;
}

TEST(ExamScoreTest, TheTruthIsRight) {
  for (const double friction : {0.0, 0.3}) {
    const ExamCase one = sphere_case(friction);
    const CaseScore score = score_case(one, one.truth);
    EXPECT_EQ(score.verdict, ExamVerdict::kRight);
    EXPECT_EQ(score.force.worst, 0.0);
    // A spring that hangs on a fixed surface gives back what it took; friction keeps some of it.
    if (friction > 0.0) {
      EXPECT_LT(score.energy, -1e-3);
    } else {
      EXPECT_NEAR(score.energy, 0.0, 1e-9);
    }
  }
}

TEST(ExamScoreTest, AMissingOrTurnedForceOnASingleTickPopsThrough) {
  const ExamCase one = sphere_case(0.0);
  Forces force = one.truth;
  const auto felt = std::ranges::find_if(force, [](const Vector3d& f) { return f.norm() > 1.0; });
  for (const double share : {0.0, -1.0}) {
    force = one.truth;
    force[static_cast<std::size_t>(felt - force.begin())] *= share;
    const CaseScore score = score_case(one, force);
    EXPECT_EQ(score.lost, 1u);
    EXPECT_EQ(score.verdict, ExamVerdict::kPopsThrough);
  }
}

TEST(ExamScoreTest, AForceInTheAirSticks) {
  const ExamCase one = sphere_case(0.0);
  Forces force = one.truth;
  force.front() = {0.0, 0.3, 0.0};
  EXPECT_EQ(score_case(one, force).verdict, ExamVerdict::kSticks);
}

/// A force along the movement puts energy into the hand: that of a damper of the other sign, whose
/// energy on the path is its sum of b v^2 dt.
TEST(ExamScoreTest, ANegativeDamperGivesEnergy) {
  constexpr double kDamping = 1.0;  // [N·s/m]
  const ExamCase one = sphere_case(0.0);
  Forces force = one.truth;
  double energy = 0.0;
  for (std::size_t i = 0; i + 1 < force.size(); ++i) {
    if (one.truth[i].isZero(0.0)) {
      continue;
    }
    const Vector3d v = (one.tool[i + 1] - one.tool[i]) * one.task.rate;
    force[i] += kDamping * v;
    energy += kDamping * v.squaredNorm() / one.task.rate;
  }
  const CaseScore score = score_case(one, force);
  EXPECT_NEAR(score.energy, energy, 0.02 * energy);
  EXPECT_EQ(score.verdict, ExamVerdict::kGivesEnergy);
}

TEST(ExamScoreTest, AForceThatIsATenthTooLargeIsNoticeable) {
  const ExamCase one = sphere_case(0.0);
  Forces force = one.truth;
  for (Vector3d& f : force) {
    f *= 1.1;
  }
  const CaseScore score = score_case(one, force);
  EXPECT_EQ(score.noticeable.beyond_low, 1.0);
  EXPECT_EQ(score.verdict, ExamVerdict::kNoticeable);
}

TEST(ExamTest, EveryBodyHasAnInside) {
  for (const ExamBody& body : exam_bodies()) {
    const contact::FeltBody felt(mesh_of(body.body, 2));
    EXPECT_TRUE(felt.closed) << body.name;
    EXPECT_TRUE(felt.outwards) << body.name;
  }
}

class WrittenExamTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    write_exam(*folder_ / "exam");
  }
  static void TearDownTestSuite() { folder_.reset(); }

  std::filesystem::path path(const char* name) const { return *folder_ / name; }
  static std::unique_ptr<test::TemporaryFolder> folder_;
};
std::unique_ptr<test::TemporaryFolder> WrittenExamTest::folder_;

TEST_F(WrittenExamTest, TheProxyPassesAndThePenaltyPopsThroughTheThinPlate) {
  const auto exam = read_exam(path("exam"));
  ASSERT_EQ(exam.size(), 16u);
  const auto verdicts = [&](const char* renderer) {
    const auto candidate = own_candidate(renderer);
    const ExamAnswers answers = sit_exam(*candidate, renderer, exam);
    ExamScore score{answers, {}, {}};
    for (std::size_t i = 0; i < exam.size(); ++i) {
      score.cases.push_back(score_case(exam[i], answers.cases[i].force));
    }
    return score;
  };
  EXPECT_EQ(verdicts("proxy").count(ExamVerdict::kRight), exam.size());
  const ExamScore penalty = verdicts("penalty");
  EXPECT_EQ(exam[14].name, "thin-plate");
  EXPECT_EQ(penalty.cases[14].verdict, ExamVerdict::kPopsThrough);
  EXPECT_EQ(penalty.cases[0].verdict, ExamVerdict::kRight);
}

TEST_F(WrittenExamTest, AnswersComeBackAndAMissingRowGetsASentence) {
  auto exam = read_exam(path("exam"));
  exam.resize(1);
  ExamAnswers answers{"mine", {{exam[0].truth, 0.5, 1e-6, 2e-6}}, true};
  write_answers(answers, {"mine", 0.0, 0.0, {}}, exam, path("answers"));
  const ExamAnswers again = read_answers(path("answers"), exam);
  EXPECT_EQ(again.renderer, "mine");
  EXPECT_EQ(again.cases[0].worst_tick, 2e-6);
  EXPECT_LT(score_case(exam[0], again.cases[0].force).force.worst, 1e-6);  // the files' grain
  exam[0].tool.pop_back();
  EXPECT_THAT(test::message_of<InputError>([&] { read_answers(path("answers"), exam); }),
              testing::HasSubstr("4001 forces; allowed: 4000, one for each row of the path"));
}

}  // namespace
}  // namespace haptrial::evaluation::exam_score_test
