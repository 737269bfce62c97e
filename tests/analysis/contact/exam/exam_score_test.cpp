#include "analysis/contact/exam/exam_score.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "analysis/contact/exam/exam_bodies.h"
#include "analysis/contact/exam/exam_tools.h"
#include "analysis/contact/exam/own_candidate.h"
#include "analysis/contact/truth/true_contact.h"
#include "core/base/error.h"
#include "core/contact/felt_body.h"
#include "core/contact/signed_distance.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::evaluation::exam_score_test {
namespace {

using Eigen::Vector3d;
using Answers = std::vector<Answer>;

ExamCase sphere_case(double friction) {
  const ExamBody& sphere = exam_bodies()[1];
  ExamCase one{"sphere", {.friction = friction}, {}, {}};
  const std::vector<Vector3d> places = there_and_back(sphere);
  for (const TrueContact& c : true_contacts(sphere.body, places, one.task.stiffness, friction)) {
    one.truth.push_back({c.force, Vector3d::Zero()});
  }
  for (const Vector3d& place : places) {
    one.tool.emplace_back(Eigen::Translation3d(place));
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
  Answers force = one.truth;
  const auto felt =
      std::ranges::find_if(force, [](const Answer& a) { return a.force.norm() > 1.0; });
  for (const double share : {0.0, -1.0}) {
    force = one.truth;
    force[static_cast<std::size_t>(felt - force.begin())].force *= share;
    const CaseScore score = score_case(one, force);
    EXPECT_EQ(score.lost, 1u);
    EXPECT_EQ(score.verdict, ExamVerdict::kPopsThrough);
  }
}

TEST(ExamScoreTest, AForceInTheAirSticks) {
  const ExamCase one = sphere_case(0.0);
  Answers force = one.truth;
  force.front().force = {0.0, 0.3, 0.0};
  EXPECT_EQ(score_case(one, force).verdict, ExamVerdict::kSticks);
}

/// A force along the movement puts energy into the hand: that of a damper of the other sign, whose
/// energy on the path is its sum of b v^2 dt.
TEST(ExamScoreTest, ANegativeDamperGivesEnergy) {
  constexpr double kDamping = 1.0;  // [N·s/m]
  const ExamCase one = sphere_case(0.0);
  Answers force = one.truth;
  double energy = 0.0;
  for (std::size_t i = 0; i + 1 < force.size(); ++i) {
    if (one.truth[i].force.isZero(0.0)) {
      continue;
    }
    const Vector3d v = (one.tool[i + 1].translation() - one.tool[i].translation()) * one.task.rate;
    force[i].force += kDamping * v;
    energy += kDamping * v.squaredNorm() / one.task.rate;
  }
  const CaseScore score = score_case(one, force);
  EXPECT_NEAR(score.energy, energy, 0.02 * energy);
  EXPECT_EQ(score.verdict, ExamVerdict::kGivesEnergy);
}

TEST(ExamScoreTest, AForceThatIsATenthTooLargeIsNoticeable) {
  const ExamCase one = sphere_case(0.0);
  Answers force = one.truth;
  for (Answer& answer : force) {
    answer.force *= 1.1;
  }
  const CaseScore score = score_case(one, force);
  EXPECT_EQ(score.noticeable.beyond_low, 1.0);
  EXPECT_EQ(score.verdict, ExamVerdict::kNoticeable);
}

TEST(ExamTest, EveryToolAndItsBodyHaveAnInside) {
  for (const ExamTool& one : exam_tools()) {
    for (const geometry::Mesh& mesh : {one.tool, one.body}) {
      const contact::FeltBody felt(mesh);
      EXPECT_TRUE(felt.closed) << one.name;
      EXPECT_EQ(felt.facing, geometry::Facing::kOutwards) << one.name;
    }
  }
}

/// The half-spaces are the body's faces: where they leave space the mesh is not, and the other way.
TEST(ExamTest, TheFreeSpaceOfAToolIsThatOfItsBody) {
  for (const ExamTool& one : exam_tools()) {
    const contact::FeltBody felt(one.body);
    const contact::SignedDistance distance(felt.mesh, felt.surface);
    for (int i = 0; i < 1000; ++i) {
      const Vector3d p = 0.03 * Vector3d(std::sin(1.1 * i), std::sin(1.7 * i), std::sin(2.3 * i));
      double spare = 1.0;
      for (const HalfSpace& half : one.free) {
        spare = std::min(spare, half.normal.dot(p) - half.offset);
      }
      if (std::abs(spare) > 1e-9) {
        EXPECT_EQ(spare > 0.0, distance(p, -1).distance > 0.0) << one.name << " " << p.transpose();
      }
    }
  }
}

TEST(ExamTest, TheRigidToolPasses) {
  const test::TemporaryFolder folder;
  write_rigid_exam(folder / "exam");
  const auto exam = read_exam(folder / "exam");
  ASSERT_EQ(exam.size(), exam_tools().size());
  const auto candidate = own_candidate("rigid-tool", ExamKind::kRigid);
  const ExamAnswers answers = sit_exam(*candidate, "rigid-tool", exam);
  for (std::size_t i = 0; i < exam.size(); ++i) {
    const CaseScore score = score_case(exam[i], answers.cases[i].answer);
    EXPECT_EQ(score.verdict, ExamVerdict::kRight) << exam[i].name;
    EXPECT_LT(score.bands.fast, 0.005) << exam[i].name << " is thrown from side to side";
    EXPECT_GT(score.torque.mean_force, 0.01) << exam[i].name << " turns against what it touches";
    EXPECT_LT(score.torque.root_mean_square, 0.1 * score.torque.mean_force) << exam[i].name;
  }
  EXPECT_THAT(test::message_of<InputError>([&] { own_candidate("proxy", exam[0].task.kind()); }),
              testing::HasSubstr("proxy renders a point"));
}

/// A wall that is sampled and held is stable under a mass with a damper b if b > K T / 2, and not
/// below (for a spring whose vibration is slow beside the rate).
TEST(ExamTest, TheProxyIsStableWhereAWallIsPassive) {
  const auto candidate = own_candidate("proxy", ExamKind::kPoint);
  const auto cells = stability_of(*candidate);
  ASSERT_EQ(cells.size(), 36u);
  EXPECT_EQ(std::ranges::count_if(cells, &StabilityCell::passive), 18);
  for (const StabilityCell& cell : cells) {
    EXPECT_EQ(cell.stable(), cell.passive()) << cell.stiffness << " N/m, friction " << cell.friction
                                             << ", " << cell.rate << " Hz: " << cell.span;
  }
}

/// A force that comes a tick late needs three times the damping.
class LateWall final : public Candidate {
 public:
  void begin(const ContactTask& task) override { stiffness_ = task.stiffness; }
  void start(const Eigen::Isometry3d&) override { late_ = 0.0; }
  Answer tick(double, const Eigen::Isometry3d& tool) override {
    const double force = late_;
    late_ = stiffness_ * std::max(0.0, -tool.translation().y());
    return {{0.0, force, 0.0}, Vector3d::Zero(), {}};
  }

 private:
  double stiffness_{0.0}, late_{0.0};
};

TEST(ExamTest, AWallThatIsATickLateIsStableForAThirdOfTheStiffness) {
  LateWall wall;
  for (const StabilityCell& cell : stability_of(wall)) {
    EXPECT_EQ(cell.stable(), 1.0 > 1.5 * cell.stiffness / cell.rate)
        << cell.stiffness << " N/m, " << cell.rate << " Hz: " << cell.span;
  }
}

TEST(ExamTest, EveryBodyHasAnInside) {
  for (const ExamBody& body : exam_bodies()) {
    const contact::FeltBody felt(mesh_of(body.body, 2));
    EXPECT_TRUE(felt.closed) << body.name;
    EXPECT_EQ(felt.facing, geometry::Facing::kOutwards) << body.name;
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
    const auto candidate = own_candidate(renderer, ExamKind::kPoint);
    const ExamAnswers answers = sit_exam(*candidate, renderer, exam);
    ExamScore score{answers, {}, {}};
    for (std::size_t i = 0; i < exam.size(); ++i) {
      score.cases.push_back(score_case(exam[i], answers.cases[i].answer));
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
  ExamAnswers answers{"mine", {{exam[0].truth, 0.5, 1e-6, 2e-6}}, stability_cells()};
  answers.stability[7].span = 2e-5;
  write_answers(answers, FailureMap{"mine", 0.0, 0.0, failure_cells()}, exam, path("answers"));
  const ExamAnswers again = read_answers(path("answers"), exam);
  EXPECT_EQ(again.renderer, "mine");
  EXPECT_EQ(again.cases[0].worst_tick, 2e-6);
  ASSERT_EQ(again.stability.size(), 36u);
  EXPECT_EQ(again.stability[7].span, 2e-5);
  EXPECT_EQ(read_failures(path("answers/failures.csv")).cells.size(), 17u * 9u);
  EXPECT_LT(score_case(exam[0], again.cases[0].answer).force.worst, 1e-6);  // the files' grain
  ExamScore score = score_answers(path("answers"), exam);
  std::vector<ExamScore> scores{score, score};
  scores[0].answers.renderer = "mi-ne";
  scores[1].answers.renderer = "mi ne";
  EXPECT_THAT(test::message_of<InputError>([&] { write_scores(scores, exam, path("scores")); }),
              testing::HasSubstr("'mi-ne' and 'mi ne' would both be written as mi-ne"));
  EXPECT_FALSE(std::filesystem::exists(path("scores")));
  exam[0].tool.pop_back();
  EXPECT_THAT(test::message_of<InputError>([&] { read_answers(path("answers"), exam); }),
              testing::HasSubstr("4001 forces; allowed: 4000, one for each row of the path"));
}

/// Leaving out a cell at which a renderer fails would make it stable in all of them.
TEST(ExamTablesTest, StabilityHasEveryCellOnce) {
  const test::TemporaryFolder folder;
  const auto refusal = [&](const std::vector<StabilityCell>& cells) {
    std::ofstream(folder / "stability.csv") << stability_csv(cells);
    return test::message_of<InputError>([&] { read_stability(folder / "stability.csv"); });
  };
  std::vector<StabilityCell> cells = stability_cells();
  std::ranges::reverse(cells);
  cells[4].span = -5.0;
  EXPECT_THAT(refusal(cells), testing::HasSubstr("stability.csv:6: span_m is '-5.0000000'"));
  cells[4].span = 0.0;
  cells[5].rate = 1500.0;
  EXPECT_THAT(refusal(cells), testing::HasSubstr("stability.csv:7: stiffness_N_per_m is '6000'"));
  cells[5] = cells[4];
  EXPECT_THAT(refusal(cells), testing::HasSubstr("each once"));
  cells = stability_cells();
  cells.pop_back();
  EXPECT_THAT(refusal(cells), testing::HasSubstr("has no row for 6000 N/m, friction 0.6, 2000 Hz; "
                                                 "allowed: a row for each of 36 cells"));
}

TEST(ExamTablesTest, AMapOfFailuresOfAnyNameComesBack) {
  const test::TemporaryFolder folder;
  for (const std::string name : {"mine", "mine, second", "the \"best\""}) {
    std::ofstream(folder / "failures.csv") << failure_csv({{name, 0.0, 0.0, failure_cells()}});
    const FailureMap again = read_failures(folder / "failures.csv");
    EXPECT_EQ(again.renderer, name);
    EXPECT_EQ(again.cells.size(), failure_cells().size());
  }
}

TEST(ExamTablesTest, AMapOfFailuresHasEveryRidgeOnce) {
  const test::TemporaryFolder folder;
  const auto refusal = [&](const std::vector<FailureMap::Cell>& cells) {
    std::ofstream(folder / "failures.csv") << failure_csv({{"mine", 0.0, 0.0, cells}});
    return test::message_of<InputError>([&] { read_failures(folder / "failures.csv"); });
  };
  std::vector<FailureMap::Cell> cells = failure_cells();
  cells[3] = cells[2];
  EXPECT_THAT(refusal(cells), testing::HasSubstr("failures.csv:5: flank_deg is '5'"));
  cells = failure_cells();
  cells.pop_back();
  EXPECT_THAT(refusal(cells), testing::HasSubstr("has no row for 85 degrees and 8 mm; allowed: a "
                                                 "row for each of 153 ridges"));
}

}  // namespace
}  // namespace haptrial::evaluation::exam_score_test
