// Haptic playback: what a recorded run does to another hand, held against the two recordings.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/record/read/session_reader.h"
#include "core/record/rows/partner_rows.h"
#include "core/tutoring/deadband.h"
#include "tests/experiments/command.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

using test::run_command;
using testing::HasSubstr;
using testing::Not;

const std::string kExperiments = std::string(HAPTRIAL_SOURCE_DIR) + "/experiments";
const std::string kDefinition = kExperiments + "/force_training.toml";

std::vector<record::Sample> run_of_first_pass(const record::SessionReader& reader) {
  const record::PassRow pass = reader.passes().front();
  std::vector<record::Sample> run;
  for (const record::Sample& s :
       reader.samples(pass.first_sample, pass.last_sample - pass.first_sample + 1)) {
    if (s.stage == record::Stage::kRun) {
      run.push_back(s);
    }
  }
  return run;
}

TEST(TutoringTest, ARecordedRunLeadsAnotherHandByTheLaw) {
  const test::TemporaryFolder folder;
  const std::string tutor = (folder / "tutor").string();
  const std::string led = (folder / "led").string();
  ASSERT_EQ(
      run_command("haptrial dry-run " + kDefinition + " --subjects 1 --trials 1 --out " + tutor)
          .status,
      0);
  ASSERT_EQ(run_command("haptrial dry-run " + kDefinition + " --subjects 1 --trials 1 --seed 7 " +
                        "--tutor " + tutor + "/S01.h5:1 --out " + led)
                .status,
            0);
  const record::SessionReader model(tutor + "/S01.h5");
  const record::SessionReader session(led + "/S01.h5");
  const std::vector<record::Sample> run = run_of_first_pass(model);
  const auto rows = session.rows<record::TutoringRow>();
  ASSERT_GT(rows.size(), 5000u);
  std::size_t whole = 0;
  for (const record::TutoringRow& row : rows) {
    if (row.lead < 1.0) {
      continue;
    }
    ++whole;
    const auto i = static_cast<std::size_t>(std::lround(row.time * 1000.0));
    ASSERT_LT(i, run.size());
    const record::Sample own = session.samples(row.sequence, 1).front();
    ASSERT_EQ(row.tutor_force, run[i].force);
    // K = 80 N/m and D = 2 N·s/m where the definition says nothing; records are rounded.
    const Eigen::Vector3d law = run[i].force + 80.0 * (run[i].position - own.position) +
                                2.0 * (run[i].velocity - own.velocity);
    ASSERT_LT((law - row.played_force).norm(), 2e-4) << "tick " << row.sequence;
    ASSERT_LT((own.force - row.played_force).norm(), 2e-4) << "tick " << row.sequence;
  }
  EXPECT_GT(whole, run.size() / 2);
  EXPECT_THAT(session.events(),
              testing::Contains(testing::Field(&record::EventRow::kind, "tutor")));
}

/// Messages of a link for a recorded session, on the ticks that belong to passes; the partner's
/// error stays within its bounds at each of them.
struct Sent {
  double messages{0.0};
  double ticks{0.0};
};

Sent sent_of(const record::SessionReader& session) {
  constexpr std::uint64_t kPiece = 65536;
  const tutoring::DeadbandParameters p;
  tutoring::Deadband deadband(p);
  for (std::uint64_t at = 0; at < session.sample_count(); at += kPiece) {
    const std::uint64_t count = std::min(kPiece, session.sample_count() - at);
    for (const record::Sample& s : session.samples(at, count)) {
      if (s.pass < 0) {
        continue;
      }
      deadband.due({{s.position, s.velocity}, s.force}, 1e-3);
      const tutoring::Partner held = deadband.held();
      EXPECT_LE((held.force - s.force).norm(),
                std::max(p.force_fraction * s.force.norm(), p.least_force));
      EXPECT_LE((held.tool.position - s.position).norm(), p.place);
    }
  }
  return {static_cast<double>(deadband.messages()), static_cast<double>(deadband.ticks())};
}

/// Whole sessions of every kind of protocol; a drilling's ticks go over the link anyway.
TEST(TutoringTest, ADeadbandSavesMostMessagesOfRecordedSessions) {
  const test::TemporaryFolder folder;
  Sent all;
  for (const char* name :
       {"force_training", "force_training_curve", "tutoring_study", "grating_discrimination",
        "stiffness_discrimination", "shape_recognition", "viscosity_magnitude", "wall_detection",
        "curl_field"}) {
    const std::string out = (folder / name).string();
    const std::string definition =
        std::string(HAPTRIAL_SOURCE_DIR) + "/experiments/" + name + ".toml";
    ASSERT_EQ(run_command("haptrial dry-run " + definition + " --subjects 1 --out " + out).status,
              0);
    const Sent sent = sent_of(record::SessionReader(out + "/S01.h5"));
    all.messages += sent.messages;
    all.ticks += sent.ticks;
    RecordProperty(name, std::to_string(sent.messages / sent.ticks));
    printf("%s: %.2f %% sent\n", name, 100.0 * sent.messages / sent.ticks);
    EXPECT_LE(sent.messages, 0.155 * sent.ticks) << name;
  }
  printf("all: %.2f %% sent\n", 100.0 * all.messages / all.ticks);
  EXPECT_LE(all.messages, 0.15 * all.ticks);
}

TEST(TutoringTest, TheSameAgainIsTheSameToTheByte) {
  const test::TemporaryFolder folder;
  const std::string tutor = (folder / "tutor").string();
  ASSERT_EQ(
      run_command("haptrial dry-run " + kDefinition + " --subjects 1 --trials 1 --out " + tutor)
          .status,
      0);
  std::vector<std::vector<record::TutoringRow>> all;
  for (const char* name : {"a", "b"}) {
    const std::string out = (folder / name).string();
    ASSERT_EQ(run_command("haptrial dry-run " + kDefinition + " --subjects 1 --trials 1 --tutor " +
                          tutor + "/S01.h5 --out " + out)
                  .status,
              0);
    all.push_back(record::SessionReader(out + "/S01.h5").rows<record::TutoringRow>());
  }
  ASSERT_EQ(all[0].size(), all[1].size());
  for (std::size_t i = 0; i < all[0].size(); ++i) {
    ASSERT_EQ(all[0][i].played_force, all[1][i].played_force);
  }
}

TEST(TutoringTest, ASessionGoesOnWithTheSameTutorOnly) {
  const test::TemporaryFolder folder;
  const std::string tutor = (folder / "tutor").string();
  const std::string out = (folder / "out").string();
  ASSERT_EQ(
      run_command("haptrial dry-run " + kDefinition + " --subjects 1 --trials 2 --out " + tutor)
          .status,
      0);
  const std::string run = " run " + kDefinition + " --subject P01 --trials 1 --out " + out;
  run_command("timeout -s INT 4 \"$HAPTRIAL\"" + run + " --tutor " + tutor + "/S01.h5:1");
  ASSERT_TRUE(std::filesystem::exists(out + "/P01.h5.partial"));
  for (const std::string& other : {std::string(), " --tutor " + tutor + "/S01.h5:2"}) {
    const test::CommandResult r = run_command("haptrial" + run + " --resume" + other);
    EXPECT_EQ(r.status, 2) << other;
    EXPECT_THAT(r.errors, HasSubstr("was recorded with the tutor S01.h5 trial 1 from 0 s"));
  }
}

TEST(TutoringTest, WhatCannotLeadIsSaidBeforeAFolderIsMade) {
  const test::TemporaryFolder folder;
  const std::string out = (folder / "out").string();
  const auto refused = [&](const std::string& tutor) {
    const test::CommandResult r =
        run_command("haptrial dry-run " + kDefinition + " --tutor '" + tutor + "' --out " + out);
    EXPECT_EQ(r.status, 2) << tutor;
    EXPECT_FALSE(std::filesystem::exists(out));
    return r.errors;
  };
  EXPECT_THAT(refused("x.h5:0"), HasSubstr("allowed: FILE, FILE:TRIAL or FILE:TRIAL@SECONDS"));
  EXPECT_THAT(refused((folder / "none.h5").string()), HasSubstr("none.h5"));
  const std::string tutor = (folder / "tutor").string();
  ASSERT_EQ(
      run_command("haptrial dry-run " + kDefinition + " --subjects 1 --trials 1 --out " + tutor)
          .status,
      0);
  EXPECT_THAT(refused(tutor + "/S01.h5:5"), HasSubstr("trial 5; allowed: 1"));
  EXPECT_THAT(refused(tutor + "/S01.h5:1@1000"), HasSubstr("1000 s is not in it"));
  const std::string other = (folder / "other").string();
  ASSERT_EQ(run_command("haptrial dry-run " + kExperiments +
                        "/stiffness_discrimination.toml --subjects 1 --trials 1 --out " + other)
                .status,
            0);
  EXPECT_THAT(refused(other + "/S01.h5:1"),
              HasSubstr("is a session of protocol 'trials'; allowed: one of 'force_training'"));
}

TEST(TutoringTest, ARecordingByAnotherDefinitionIsSaid) {
  const test::TemporaryFolder folder;
  const std::string tutor = (folder / "tutor").string();
  const std::string one = kDefinition + " --subjects 1 --trials 1 --out ";
  ASSERT_EQ(run_command("haptrial dry-run " + one + tutor).status, 0);
  const auto notices = [&](const std::string& name, const std::string& options) {
    const std::string out = (folder / name).string();
    const std::string led = " --tutor " + tutor + "/S01.h5:1" + options;
    EXPECT_EQ(run_command("haptrial dry-run " + one + out + led).status, 0);
    return run_command("haptrial info " + out + "/S01.h5").output;
  };
  const std::string own = notices("own", "");
  EXPECT_THAT(own, HasSubstr("led by trial 1 of S01 (S01.h5)"));
  EXPECT_THAT(own, Not(HasSubstr("another definition")));
  EXPECT_THAT(notices("other", " --set tutoring.stiffness=60"),
              HasSubstr("recorded by another definition, force_training.toml"));
}

}  // namespace
}  // namespace haptrial::experiments
