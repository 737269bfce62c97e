#include "analysis/exchange/export_bids.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <span>
#include <vector>

#include "analysis/exchange/bids_text.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/channel/channel_row.h"
#include "core/record/hdf5/session_writer.h"
#include "tests/analysis/exchange/small_session.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::exchange::export_bids_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

const fs::path kHere = fs::path(HAPTRIAL_SOURCE_DIR) / "tests/analysis/exchange";

void ignore(std::uint64_t) {}

class ExportBidsTest : public testing::Test {
 protected:
  fs::path write(const std::string& name, const SmallSession& session) {
    write_session(folder_ / name, session);
    files_.push_back(folder_ / name);
    return files_.back();
  }

  BidsSummary run(const DataSetOptions& options = {}) {
    return export_bids(files_, folder_ / "out", options, ignore);
  }

  std::string refusal() {
    try {
      run();
    } catch (const InputError& error) {
      EXPECT_FALSE(fs::exists(folder_ / "out"));
      return error.what();
    }
    return "nothing was refused";
  }

  /// Runs a line of shell. @returns its exit status, its output in `output_`.
  int shell(const std::string& line) {
    const fs::path log = folder_ / "log";
    const int status = std::system(("(" + line + ") >'" + log.string() + "' 2>&1").c_str());
    output_ = file_text(log);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  std::string quoted(const fs::path& path) const { return " '" + path.string() + "'"; }

  void expect_equal_to_the_files() {
    std::string line =
        "/usr/bin/python3" + quoted(kHere / "read_bids.py") + quoted(folder_ / "out");
    for (const auto& file : files_) {
      line += quoted(file);
    }
    EXPECT_EQ(shell(line), 0) << output_;
    EXPECT_EQ(output_, "equal\n");
  }

  test::TemporaryFolder folder_;
  std::vector<fs::path> files_;
  std::string output_;
};

TEST_F(ExportBidsTest, PandasReadsWhatTheSessionFilesHold) {
  write("a.h5", {.subject = "P-01"});
  write("b.h5", {.subject = "P-02", .simulated = true, .rate = 1000.0, .odd_values = true});
  const auto done = run({.jobs = 2});
  EXPECT_EQ(done.subjects, 2u);
  EXPECT_EQ(done.samples, 2u * 6 * (kTicksOfPass + 100));
  EXPECT_EQ(done.missing, 0u);
  EXPECT_TRUE(done.simulated);
  expect_equal_to_the_files();
}

TEST_F(ExportBidsTest, AMissingTickIsARowWithoutValues) {
  // More rows than one piece, a gap at the border of a pass, a start above 0, a clock that wavers.
  write("a.h5", {.simulated = false,
                 .clock = "real",
                 .trials = 20,
                 .first_tick = 12345,
                 .gap_at = 1100,
                 .gap = 40'000});
  const auto done = run();
  EXPECT_EQ(done.missing, 40'000u);
  EXPECT_EQ(done.samples, 20u * 2 * (kTicksOfPass + 100));
  EXPECT_FALSE(done.simulated);
  expect_equal_to_the_files();
}

TEST_F(ExportBidsTest, MotionIsOneTickForEachPeriodOfItsRate) {
  write("a.h5", {.subject = "P-01", .rate = 1000.0, .gap_at = 1100, .gap = 500});
  write("b.h5", {.subject = "P-02", .clock = "real", .first_tick = 100});
  run({.motion = 60.0});  // no divisor of either rate
  expect_equal_to_the_files();
}

TEST_F(ExportBidsTest, MotionHasEveryDevice) {
  write("a.h5",
        {.subject = "P-01", .rate = 1000.0, .gap_at = 1100, .gap = 500, .other_devices = 2});
  run({.motion = 60.0});
  expect_equal_to_the_files();
}

TEST_F(ExportBidsTest, MotionIsNoFasterThanTheLoop) {
  write("a.h5", {.rate = 500.0});
  EXPECT_THROW(run({.motion = 501.0}), InputError);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  run({.motion = 500.0});
  expect_equal_to_the_files();
}

TEST_F(ExportBidsTest, AfterASuspensionEventsStandBesideTheirTicks) {
  // The event is of 1.5 s on the clock; of that the loop was suspended for half a second from 0.8 s
  // on in one session, and for a second from 1 s on in the other.
  const auto onset = [&](std::uint64_t late_at, std::int64_t late_ns) {
    files_.clear();
    const std::string name = std::to_string(late_at);
    write(name + ".h5",
          {.simulated = false, .clock = "real", .late_at = late_at, .late_ns = late_ns});
    export_bids(files_, folder_ / name, {}, ignore);
    const std::string events =
        file_text(folder_ / name / "sub-P01/beh/sub-P01_task-smallstudy_events.tsv");
    const auto notice = events.find("notice");
    return std::stod(events.substr(events.rfind('\n', notice) + 1));
  };
  EXPECT_NEAR(onset(400, 500'000'000), 1.0, 1e-5);
  EXPECT_NEAR(onset(500, 1'000'000'000), 1.0, 1e-5);
}

TEST_F(ExportBidsTest, AfterASuspensionSamplesOfChannelsStandBesideTheEvents) {
  const channel::ChannelTable grip("grip", {{"force", "N"}}, 64);
  record::SessionInfo info;
  info.subject = "P01";
  info.clock = "real";
  info.rate = 500.0;
  info.start_utc = "2026-11-20T09:30:00Z";
  info.definition = "name = \"small\"\n";
  info.definition_name = "small_study.toml";
  record::SessionWriter writer(folder_ / "a.h5", info,
                               {&grip.table(), &record::table_of<channel::IncidentRow>()});
  std::vector<record::Sample> ticks(1000);  // suspended for a second after the first 500
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    ticks[i].sequence = i;
    ticks[i].time_ns = 2'000'000 * static_cast<std::int64_t>(i) + (i < 500 ? 0 : 1'000'000'000);
    ticks[i].pass = -1;
  }
  writer.append(ticks);
  std::vector<channel::ChannelRow> rows(2);
  rows[0].time_ns = 500'000'000;
  rows[1].time_ns = 2'500'000'000;
  rows[1].sample = 1;
  writer.add(record::Rows(grip.table(), rows.data(), rows.size()));
  const std::vector<channel::IncidentRow> incidents{
      {600'000'000, "grip", channel::Incident::kMessage, 0.001, "squeeze"},
      {700'000'000, "grip", channel::Incident::kGap, 3.0, ""}};
  writer.add(std::span<const channel::IncidentRow>(incidents));
  writer.set_timing({}, {1000, 0, 0});
  writer.close();
  files_ = {folder_ / "a.h5"};
  run();
  const fs::path recording =
      folder_ / "out/sub-P01/beh/sub-P01_task-smallstudy_recording-grip_physio.tsv.gz";
  ASSERT_EQ(shell("zcat" + quoted(recording) + " | cut -f 1,3"), 0) << output_;
  EXPECT_EQ(output_, "0.5\t500000000\n1.5\t2500000000\n");
  const std::string events =
      file_text(folder_ / "out/sub-P01/beh/sub-P01_task-smallstudy_events.tsv");
  EXPECT_THAT(events, HasSubstr("\tchannel_message\tgrip: squeeze"));
  EXPECT_THAT(events, Not(HasSubstr("0.001")));
  EXPECT_THAT(events, HasSubstr("\tchannel_gap\tgrip (3)"));
}

TEST_F(ExportBidsTest, TheOfficialValidatorFindsNoErrors) {
  SmallSession first{.subject = "P-01", .note = "a tab\there, a line\nthere, 5 µm"};
  first.person = {"P-01", "right", "18-25", "female", "yes", "said that it tickles"};
  write("a.h5", first);
  write("b.h5", {.subject = "P-01", .start_utc = "2026-11-21T09:30:00Z"});
  write("c.h5", {.subject = "P_2", .gap_at = 100, .gap = 3, .odd_values = true});
  write("d.h5", {.subject = "P_3", .trials = 0, .pilot = true});
  write("f.h5", {.subject = "P_5", .other_devices = 1});
  write("e.h5", {.subject = "P_4", .pilot = true, .practice = 1, .ticks_of_no_pass = 5});
  run({.name = "A study",
       .authors = {"A. Author", "B. Author"},
       .program_version = "0.1.0",
       .motion = 50.0});
  const fs::path package = fs::path(HAPTRIAL_SOURCE_DIR) / "tests/support/npm_package.py";
  const int had = shell("/usr/bin/python3" + quoted(package) +
                        quoted(fs::path(HAPTRIAL_BINARY_DIR)) + " bids-validator");
  if (had == 3) {
    GTEST_SKIP() << "no network, so no validator: " << output_;
  }
  ASSERT_EQ(had, 0) << output_;
  const std::string validator =
      "node '" + output_.substr(0, output_.find('\n')) + "/bin/bids-validator'";
  // It knows axes of motion by letters that BIDS 1.11 has replaced: A, P, S and I for F, B, U and
  // D.
  ASSERT_EQ(shell("find" + quoted(folder_ / "out") +
                  " -name '*_channels.json' -exec sed -i 's/\"RUB\"/\"RSP\"/' {} +"),
            0);
  EXPECT_EQ(shell(validator + quoted(folder_ / "out")), 0) << output_;
  EXPECT_THAT(output_, Not(HasSubstr("[ERR]")));
  EXPECT_THAT(output_, HasSubstr("5 - Subjects"));
  // It does look: without the rate of a recording it finds an error.
  const auto sidecar = folder_ / "out/sub-P2/ses-1/beh/sub-P2_ses-1_task-smallstudy_physio.json";
  std::string text = file_text(sidecar);
  const auto at = text.find("\"SamplingFrequency\"");
  ASSERT_NE(at, std::string::npos);
  text.replace(at, 4, "\"Xxx");
  std::ofstream(sidecar) << text;
  EXPECT_NE(shell(validator + quoted(folder_ / "out")), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("SamplingFrequency"));
}

TEST_F(ExportBidsTest, SeveralSessionsOfASubjectStandInTheOrderOfTheirStart) {
  write("late.h5", {.subject = "P1", .rate = 250.0, .start_utc = "2026-11-22T09:30:00Z"});
  write("early.h5", {.subject = "P1", .start_utc = "2026-11-21T09:30:00Z"});
  write("other.h5", {.subject = "P2"});
  EXPECT_EQ(run().subjects, 2u);
  const fs::path out = folder_ / "out";
  EXPECT_EQ(file_text(out / "sub-P1/sub-P1_sessions.tsv"),
            "session_id\tacq_time\nses-1\t2026-11-21T09:30:00Z\nses-2\t2026-11-22T09:30:00Z\n");
  EXPECT_THAT(file_text(out / "sub-P1/ses-2/beh/sub-P1_ses-2_task-smallstudy_physio.json"),
              HasSubstr("\"SamplingFrequency\": 250.0"));
  EXPECT_TRUE(fs::exists(out / "sub-P2/ses-1/beh/sub-P2_ses-1_task-smallstudy_events.tsv"));
  const std::string people = file_text(out / "participants.tsv");
  EXPECT_EQ(std::count(people.begin(), people.end(), '\n'), 1 + 2);
}

TEST_F(ExportBidsTest, ASimulatedParticipantIsMarkedEverywhere) {
  write("a.h5", {.subject = "P1", .simulated = true});
  write("b.h5", {.subject = "P2", .simulated = false});
  run();
  const fs::path out = folder_ / "out";
  EXPECT_THAT(file_text(out / "dataset_description.json"), HasSubstr("\"SIMULATED: small_study\""));
  EXPECT_THAT(file_text(out / "README"), testing::StartsWith("SIMULATED PARTICIPANTS"));
  EXPECT_THAT(file_text(out / "participants.tsv"),
              HasSubstr("sub-P1\tP1\tn/a\tn/a\tn/a\ttrue\tfalse\n"));
  EXPECT_THAT(file_text(out / "participants.tsv"),
              HasSubstr("sub-P2\tP2\tn/a\tn/a\tn/a\tfalse\tfalse\n"));
  const auto sidecar = [&](const std::string& name) {
    return file_text(out / name / "beh" / (name + "_task-smallstudy_physio.json"));
  };
  EXPECT_THAT(sidecar("sub-P1"), HasSubstr("\"TaskDescription\": \"SIMULATED PARTICIPANTS"));
  EXPECT_THAT(sidecar("sub-P2"), Not(HasSubstr("SIMULATED")));
}

TEST_F(ExportBidsTest, TheTaskIsTheExperimentsName) {
  const std::string definition = "[experiment]\nname = \"Force & recall, part_2\"\n";
  write("a.h5", {.definition = definition});
  run();
  const fs::path out = folder_ / "out";
  EXPECT_TRUE(fs::exists(out / "task-Forcerecallpart2_events.json"));
  EXPECT_TRUE(fs::exists(out / "sub-P01/beh/sub-P01_task-Forcerecallpart2_events.tsv"));
  EXPECT_TRUE(fs::exists(out / "code/Forcerecallpart2.toml"));
  EXPECT_THAT(file_text(out / "sub-P01/beh/sub-P01_task-Forcerecallpart2_physio.json"),
              HasSubstr("\"TaskName\": \"Force & recall, part_2\""));
  EXPECT_THAT(file_text(out / "dataset_description.json"),
              HasSubstr("\"SIMULATED: Force & recall, part_2\""));
}

TEST_F(ExportBidsTest, ANameWithoutALetterOfAsciiGivesWayToThatOfTheFile) {
  write("a.h5", {.definition = "[experiment]\nname = \"力覚\"\n"});
  run();
  EXPECT_TRUE(fs::exists(folder_ / "out/task-smallstudy_events.json"));
  EXPECT_THAT(file_text(folder_ / "out/sub-P01/beh/sub-P01_task-smallstudy_physio.json"),
              HasSubstr("\"TaskName\": \"smallstudy\""));
}

TEST_F(ExportBidsTest, APilotIsMarked) {
  write("a.h5", {.subject = "P1", .pilot = true});
  write("b.h5", {.subject = "P2", .simulated = false});
  write("c.h5",
        {.subject = "P2", .simulated = false, .start_utc = "2026-11-21T09:30:00Z", .pilot = true});
  write("d.h5", {.subject = "P3"});
  run();
  const fs::path out = folder_ / "out";
  const std::string people = file_text(out / "participants.tsv");
  EXPECT_THAT(people, HasSubstr("sub-P1\tP1\tn/a\tn/a\tn/a\ttrue\ttrue\n"));
  EXPECT_THAT(people, HasSubstr("sub-P2\tP2\tn/a\tn/a\tn/a\tfalse\tsome\n"));
  EXPECT_THAT(people, HasSubstr("sub-P3\tP3\tn/a\tn/a\tn/a\ttrue\tfalse\n"));
  const auto sidecar = [&](const std::string& subject, const std::string& session) {
    return file_text(out / subject / session / "beh" /
                     (subject + "_" + session + "_task-smallstudy_physio.json"));
  };
  EXPECT_THAT(sidecar("sub-P1", "ses-1"), HasSubstr("how people behave. PILOT SESSION"));
  EXPECT_THAT(sidecar("sub-P2", "ses-1"), HasSubstr("\"Pilot\": false"));
  EXPECT_THAT(sidecar("sub-P2", "ses-1"), Not(HasSubstr("PILOT")));
  EXPECT_THAT(sidecar("sub-P2", "ses-2"), HasSubstr("\"Pilot\": true"));
  EXPECT_THAT(sidecar("sub-P2", "ses-2"), HasSubstr("\"TaskDescription\": \"PILOT SESSION"));
}

TEST_F(ExportBidsTest, PracticeIsMarked) {
  write("a.h5", {.trials = 2, .practice = 1});
  run();
  expect_equal_to_the_files();
  const std::string events =
      file_text(folder_ / "out/sub-P01/beh/sub-P01_task-smallstudy_events.tsv");
  EXPECT_THAT(events, HasSubstr("\tsub-P01_practice-01.tsv.gz\t0\ttraining\t1\t-1\t1\t1\t1\t"));
  EXPECT_TRUE(fs::exists(folder_ / "out/stimuli/sub-P01_practice-01.tsv.gz"));
  EXPECT_THAT(file_text(folder_ / "out/task-smallstudy_events.json"),
              HasSubstr("\"1\": \"practice, never scored\""));
}

TEST_F(ExportBidsTest, ASessionWithoutPassesIsListed) {
  write("a.h5", {.subject = "P1", .trials = 0});
  write("b.h5", {.subject = "P2", .trials = 0, .ticks_of_no_pass = 30});
  write("c.h5", {.subject = "P3"});
  EXPECT_EQ(run().samples, 30u + 6u * (kTicksOfPass + 100));
  const fs::path out = folder_ / "out";
  EXPECT_THAT(file_text(out / "participants.tsv"), HasSubstr("\nsub-P1\tP1\t"));
  EXPECT_THAT(file_text(out / "sub-P1/beh/sub-P1_task-smallstudy_events.tsv"), HasSubstr("notice"));
  EXPECT_TRUE(fs::exists(out / "sub-P1/beh/sub-P1_task-smallstudy_physio.tsv.gz"));
}

TEST_F(ExportBidsTest, WhatAParticipantSaidStaysOut) {
  SmallSession session;
  session.person = {"P01", "mixed", "18-25", "male", "2026-11-20", "knows the experimenter"};
  write("a.h5", session);
  run();
  const std::string found = "grep -rlE 'knows the|2026-11-20\\b[^T]'" + quoted(folder_ / "out");
  EXPECT_EQ(shell(found), 1) << output_;  // grep finds nothing
  // A hand that BIDS has no word for goes into a column of our own.
  EXPECT_THAT(file_text(folder_ / "out/participants.tsv"),
              HasSubstr("sex\treported_handedness\tage_band"));
}

TEST_F(ExportBidsTest, BothHandsHaveTheWordOfBids) {
  SmallSession session;
  session.person = {"P01", "both", "18-25", "male", "", ""};
  write("a.h5", session);
  session = {.subject = "P02"};
  session.person = {"P02", "left", "18-25", "female", "", ""};
  write("b.h5", session);
  run();
  const std::string people = file_text(folder_ / "out/participants.tsv");
  EXPECT_THAT(people, HasSubstr("sex\thandedness\tage_band"));
  EXPECT_THAT(people, HasSubstr("\tmale\tambidextrous\t18-25"));
  EXPECT_THAT(people, HasSubstr("\tfemale\tleft\t18-25"));
}

TEST_F(ExportBidsTest, BadInputGetsASentenceAndLeavesNothing) {
  EXPECT_EQ(refusal(), "there is no session file to export");
  const fs::path first = write("a.h5", {.subject = "P-01"});
  files_.push_back(first);
  EXPECT_THAT(refusal(), HasSubstr("is given twice"));
  files_.pop_back();
  write("b.h5", {.subject = "P_01"});
  EXPECT_THAT(refusal(), HasSubstr("subject P_01 would be sub-P01, like P-01"));
  files_.pop_back();
  write("c.h5", {.subject = "P02", .definition = "name = \"other\"\n"});
  EXPECT_THAT(refusal(), HasSubstr("another definition"));
  files_.back() = folder_ / "absent.h5";
  EXPECT_THAT(refusal(), HasSubstr("no such file"));
}

TEST_F(ExportBidsTest, WhatTheWatchThrowsEndsItAndLeavesNothing) {
  write("a.h5", {.trials = 40});
  write("b.h5", {.subject = "P02", .trials = 40});
  const auto stop = [](std::uint64_t) { throw RunError("enough"); };
  EXPECT_THROW(export_bids(files_, folder_ / "out", {.jobs = 2}, stop), RunError);
  std::size_t left = 0;
  for (const auto& entry : fs::directory_iterator(folder_.path())) {
    left += entry.path().extension() != ".h5";
  }
  EXPECT_EQ(left, 0u);
}

TEST(BidsLabelTest, KeepsLettersAndDigits) {
  EXPECT_EQ(bids_label("P-01_a"), "P01a");
  EXPECT_EQ(bids_label("Jörg 2"), "Jrg2");
  EXPECT_EQ(bids_label("../.."), "");
}

}  // namespace
}  // namespace haptrial::exchange::export_bids_test
