// Roster of a study, read from the session files alone: past sessions, and the next one.

#include "experiments/study/roster.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "analysis/files/csv.h"
#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "experiments/control/session_control.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "experiments/study/session_name.h"
#include "protocols/psychophysics/definition/trials_definition.h"
#include "tests/experiments/command.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const char* const kGroups = R"([experiment]
protocol = "trials"
name = "groups"
[design]
participants = 6
sessions = 2
blocks = "latin"
[groups]
left = 2
right = 4
[[blocks]]
name = "slow"
trials = 1
[[blocks]]
name = "fast"
trials = 1
[[stages]]
name = "wait"
until = { time = 0.05 }
)";

class RosterTest : public testing::Test {
 protected:
  RosterTest() {
    test::write_text(definition_, kGroups);
    experiment_ = load_experiment(definition_);
    fs::create_directory(sessions_);
  }

  /// @param number  of the participant; 0: that of the identifier
  void record(const std::string& subject, int session, bool pilot = false, std::uint64_t seed = 1,
              int number = 0) const {
    SessionRequest request = test::session_request(
        experiment_, sessions_ / session_file_name(subject, session, 2), seed, subject);
    request.participant = (number > 0 ? number : number_of_subject(subject)) - 1;
    request.session = session;
    request.pilot = pilot;
    run_session(request);
  }
  /// A session whose participant answers every question with its second choice.
  void decline(const std::string& subject) const {
    SessionControl control;
    SessionRequest request = test::session_request(
        experiment_, sessions_ / session_file_name(subject, 1, 2), 1, subject);
    request.participant = number_of_subject(subject) - 1;
    request.session = 1;
    request.control = &control;
    request.clock = realtime::ClockKind::kReal;
    request.device = {"virtual", "", 0};
    std::atomic<bool> done{false};
    std::thread person([&] {
      for (int answered = 0; !done; std::this_thread::sleep_for(std::chrono::milliseconds(2))) {
        const SessionStatus status = control.status();
        if (status.asked.number > answered) {
          answered = status.asked.number;
          control.answer(answered, "2");
        }
      }
    });
    run_session(request);
    done = true;
    person.join();
  }
  Roster roster() const {
    return make_roster({&experiment_.study->protocol(),
                        experiment_.definition.get(),
                        definition_.string(),
                        sessions_,
                        {}});
  }
  static std::vector<std::string> nexts(const Roster& roster) {
    std::vector<std::string> all;
    for (const RosterNext& next : roster.next) {
      all.push_back(next.subject + " " + std::to_string(next.session));
    }
    return all;
  }
  test::CommandResult haptrial(const std::string& arguments) const {
    return test::run_command("haptrial " + arguments);
  }
  std::string quoted(const fs::path& path) const { return "'" + path.string() + "'"; }

  test::TemporaryFolder folder_;
  fs::path definition_{folder_ / "groups.toml"};
  fs::path sessions_{folder_ / "sessions"};
  Experiment experiment_;
};

TEST_F(RosterTest, NobodyYet) {
  const Roster empty = roster();
  EXPECT_THAT(empty.persons, IsEmpty());
  // Participants 1 and 2 are of the first group, 3 to 6 of the second.
  EXPECT_THAT(nexts(empty), ElementsAre("P01 1", "P03 1"));
  EXPECT_EQ(empty.next[0].group, "left");
  EXPECT_EQ(empty.next[1].group, "right");
}

TEST_F(RosterTest, TheEmptiestGroupIsFilledFirst) {
  // Shares after each: 1/2 and 0/4, 1/2 and 1/4, 1/2 and 2/4, 2/2 and 2/4, ...
  std::vector<std::string> came;
  while (came.size() < 6) {
    const Roster now = roster();
    const RosterNext& next = now.next.front();
    ASSERT_TRUE(next.fresh);
    came.push_back(next.subject);
    record(next.subject, 1);
  }
  EXPECT_THAT(came, ElementsAre("P01", "P03", "P04", "P02", "P05", "P06"));
  const Roster full = roster();
  EXPECT_FALSE(full.next.front().fresh);
  EXPECT_THAT(nexts(full), ElementsAre("P01 2", "P02 2", "P03 2", "P04 2", "P05 2", "P06 2"));
}

TEST_F(RosterTest, TheNextSessionIsTheOneThatIsLeft) {
  record("P01", 1);
  record("P01", 2);
  record("P03", 1);
  const Roster now = roster();
  EXPECT_THAT(nexts(now), ElementsAre("P04 1", "P02 1", "P03 2"));
  ASSERT_EQ(now.groups.size(), 2u);
  EXPECT_EQ(now.groups[0].begun, 1);
  EXPECT_EQ(now.groups[0].finished, 1);
  EXPECT_EQ(now.groups[1].begun, 1);
  EXPECT_EQ(now.groups[1].finished, 0);
  EXPECT_EQ(now.persons.at(0).next, 0);
  EXPECT_EQ(now.persons.at(1).next, 2);
  EXPECT_EQ(now.persons.at(1).sessions.at(0).trials, 2);
}

TEST_F(RosterTest, ItSaysTheBlocksThatTheSessionThenHas) {
  const Roster now = roster();
  record("P01", 1);
  const record::SessionReader file(sessions_ / "P01-session-1.h5");
  std::vector<std::string> blocks;
  for (const record::PassRow& pass : file.passes()) {
    blocks.push_back(pass.condition);
  }
  EXPECT_EQ(now.next.front().blocks, blocks);
}

TEST_F(RosterTest, PilotsHaveNoPlace) {
  record("P01", 1, true);
  const Roster now = roster();
  ASSERT_EQ(now.persons.size(), 1u);
  EXPECT_TRUE(now.persons[0].pilot);
  EXPECT_EQ(now.groups[0].begun, 0);
  EXPECT_EQ(now.next.front().number, 1);
}

TEST_F(RosterTest, PilotsAndExcludedParticipantsMayHaveOtherKeys) {
  record("T01", 1, true);
  record("P02", 1);
  fs::create_directory(sessions_ / "excluded");
  fs::rename(sessions_ / "P02-session-1.h5", sessions_ / "excluded/P02-session-1.h5");
  test::write_text(definition_, std::string(kGroups) + "onset = { speed_above = 0.1 }\n");
  experiment_ = load_experiment(definition_);
  const Roster changed = roster();
  EXPECT_EQ(changed.persons.size(), 2u);
  EXPECT_THAT(nexts(changed), ElementsAre("P01 1", "P03 1"));
  const auto second =
      haptrial("run " + quoted(definition_) +
               " --subject T02 --session 1 --pilot --device virtual --out " + quoted(sessions_));
  EXPECT_EQ(second.status, 0) << second.errors;
  const auto next = haptrial("next " + quoted(definition_) + " " + quoted(sessions_));
  EXPECT_EQ(next.status, 0) << next.errors;
}

TEST_F(RosterTest, TheNumberOfAnExcludedParticipantIsFreeAgain) {
  record("P01", 1);
  fs::create_directory(sessions_ / "excluded");
  fs::rename(sessions_ / "P01-session-1.h5", sessions_ / "excluded/P01-session-1.h5");
  const Roster now = roster();
  ASSERT_EQ(now.persons.size(), 1u);
  EXPECT_TRUE(now.persons[0].excluded);
  EXPECT_EQ(now.persons[0].next, 0);
  EXPECT_EQ(now.next.front().subject, "Pb01");
  EXPECT_EQ(now.next.front().number, 1);
}

TEST_F(RosterTest, WhoDeclinesTakesNoPlace) {
  test::write_text(definition_, std::string(kGroups) + R"([pages]
before = ["agree"]
[pages.agree]
kind = "consent"
text = "Do you take part?"
)");
  experiment_ = load_experiment(definition_);
  decline("P01");
  const Roster now = roster();
  ASSERT_EQ(now.persons.size(), 1u);
  EXPECT_STREQ(name_of(now.persons[0].sessions.at(0).state), "declined");
  EXPECT_EQ(now.persons[0].next, 0);
  EXPECT_EQ(now.groups[0].begun, 0);
  EXPECT_EQ(now.groups[0].finished, 0);
  EXPECT_EQ(now.next.front().number, 1) << "the number is free again";
  EXPECT_EQ(now.next.front().subject, "Pb01") << "the identifier is not";
  const auto shown = haptrial("roster " + quoted(definition_) + " " + quoted(sessions_));
  EXPECT_THAT(shown.output, testing::ContainsRegex("P01 .*declined"));
}

TEST_F(RosterTest, WhoIsExcludedIsReplacedByTheNextOne) {
  record("P01", 1);
  record("P01", 2);
  record("P03", 1);
  const std::string command = "roster " + quoted(definition_) + " " + quoted(sessions_);
  const auto unknown = haptrial(command + " --exclude P02 --because 'no time'");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.errors, HasSubstr("--exclude is P02, who has no session of the study"));
  EXPECT_NE(haptrial(command + " --exclude P01").status, 0) << "there has to be a reason";
  const auto done = haptrial(command + " --exclude P01 --because 'left early, ill'");
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_THAT(done.output, HasSubstr("next: Pb01 (group left), session 1 of 2"));
  EXPECT_FALSE(fs::exists(sessions_ / "P01-session-1.h5"));
  EXPECT_TRUE(fs::exists(sessions_ / "excluded/P01-session-2.h5"));
  EXPECT_EQ(test::read_text(sessions_ / "excluded/reasons.csv"),
            "participant,reason\nP01,\"left early, ill\"\n");
  const Roster now = roster();
  EXPECT_EQ(now.groups[0].begun, 0);
  EXPECT_EQ(now.groups[1].begun, 1);
  EXPECT_EQ(haptrial(command + " --exclude P01 --because again").status, 2);
  for (const char* name : {"P01", "p01"}) {
    const auto same = haptrial("run " + quoted(definition_) + " --out " + quoted(sessions_) +
                               " --session 1 --subject " + name);
    EXPECT_EQ(same.status, 2) << name;
    EXPECT_THAT(same.errors, HasSubstr("is of an excluded participant with that identifier; choose "
                                       "another one, such as "));
  }
  record("Pb01", 1);
  ASSERT_EQ(haptrial(command + " --exclude Pb01 --because 'too old'").status, 0);
  EXPECT_THAT(test::read_text(sessions_ / "excluded/reasons.csv"), HasSubstr("\nPb01,too old\n"));
  EXPECT_EQ(roster().next.front().subject, "Pc01");
}

TEST_F(RosterTest, WhatIsWrongIsSaid) {
  record("P01", 1);
  record("Q01", 1);
  EXPECT_THAT(roster().remarks, ElementsAre(HasSubstr("P01 and Q01 have the same number")));
  record("P02", 1, false, 2);
  EXPECT_THAT(test::message_of<InputError>([&] { roster(); }),
              HasSubstr("was recorded with seed 2, not with 1"));
  const auto excluded = haptrial("roster " + quoted(definition_) + " " + quoted(sessions_) +
                                 " --exclude P02 --because 'another seed'");
  EXPECT_EQ(excluded.status, 0) << excluded.errors;
  EXPECT_TRUE(fs::exists(sessions_ / "excluded/P02-session-1.h5"));
  EXPECT_EQ(roster().seed, 1u) << "excluded sessions may have any seed";
  test::write_text(definition_, std::string(kGroups) + "onset = { speed_above = 0.1 }\n");
  const Experiment changed = load_experiment(definition_);
  EXPECT_THAT(test::message_of<InputError>([&] {
                make_roster({&changed.study->protocol(),
                             changed.definition.get(),
                             definition_.string(),
                             sessions_,
                             {}});
              }),
              HasSubstr("was recorded with another definition"));
}

TEST_F(RosterTest, AStudyWithGroupsTakesFurtherParticipants) {
  record("P01", 1);
  std::string more = kGroups;
  more.replace(more.find("participants = 6"), 16, "participants = 8");
  test::write_text(definition_, more);
  experiment_ = load_experiment(definition_);
  const Roster now = roster();
  EXPECT_EQ(now.groups[0].planned, 3);
  EXPECT_EQ(now.groups[1].planned, 5);
  const std::string run = "run " + quoted(definition_) + " --out " + quoted(sessions_);
  const auto further = haptrial(run + " --subject P07 --session 1");
  ASSERT_EQ(further.status, 0) << further.errors;
  EXPECT_EQ(roster().persons.back().group, "left") << "left to right are 1 to 2";
  EXPECT_EQ(haptrial(run + " --subject P09 --session 1").status, 2);
  const auto valid = haptrial("validate " + quoted(definition_));
  EXPECT_THAT(valid.output, HasSubstr("participants from number 7 on belong to the groups in turn "
                                      "(1 of left, 1 of right)"));
  const auto analysed = haptrial("analyze " + quoted(sessions_));
  EXPECT_EQ(analysed.status, 0) << analysed.errors;
  EXPECT_THAT(analysed.output, HasSubstr("2 of 8 planned participants have a session"));
}

TEST_F(RosterTest, RunWithoutASubjectTakesTheNextOne) {
  const std::string run = "run " + quoted(definition_) + " --out " + quoted(sessions_);
  const auto first = haptrial(run);
  ASSERT_EQ(first.status, 0) << first.errors;
  EXPECT_THAT(first.output, HasSubstr("next: P01 (group left), session 1 of 2: "));
  const auto second = haptrial(run);
  ASSERT_EQ(second.status, 0) << second.errors;
  EXPECT_THAT(second.output, HasSubstr("next: P03 (group right), session 1 of 2: "));
  EXPECT_TRUE(fs::exists(sessions_ / "P03-session-1.h5"));
  const auto resumed = haptrial(run + " --resume");
  EXPECT_EQ(resumed.status, 2);
  EXPECT_THAT(resumed.errors, HasSubstr("no session is unfinished"));
  const auto pilot = haptrial(run + " --pilot");
  EXPECT_EQ(pilot.status, 2);
  EXPECT_THAT(pilot.errors, HasSubstr("add --subject"));
}

TEST_F(RosterTest, RunTakesTheSeedOfTheSessionsInTheFolder) {
  record("P01", 1, false, 5);
  const std::string run = "run " + quoted(definition_) + " --out " + quoted(sessions_);
  const auto refused = haptrial(run + " --subject P03 --seed 1");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("P01-session-1.h5: was recorded with seed 5, not with 1"));
  EXPECT_FALSE(fs::exists(sessions_ / "P03-session-1.h5"));
  const auto named = haptrial(run + " --subject P03 --session 1");
  ASSERT_EQ(named.status, 0) << named.errors;
  const auto next = haptrial(run);
  ASSERT_EQ(next.status, 0) << next.errors;
  int sessions = 0;
  for (const auto& each : fs::directory_iterator(sessions_)) {
    if (each.path().extension() == ".h5") {
      EXPECT_EQ(record::SessionReader(each.path()).info().seed, 5u) << each.path();
      ++sessions;
    }
  }
  EXPECT_EQ(sessions, 3);
  const auto pilot = haptrial(run + " --subject T01 --session 1 --pilot --seed 1");
  EXPECT_EQ(pilot.status, 0) << pilot.errors;
  EXPECT_EQ(roster().seed, 5u);
}

TEST_F(RosterTest, AParticipantHasTheNumberOfTheRecording) {
  std::string one_group = kGroups;
  const std::string groups = "[groups]\nleft = 2\nright = 4\n";
  test::write_text(definition_, one_group.erase(one_group.find(groups), groups.size()));
  experiment_ = load_experiment(definition_);
  const std::string run = "run " + quoted(definition_) + " --out " + quoted(sessions_);
  ASSERT_EQ(haptrial(run + " --subject VPx --participant 2 --session 1").status, 0);
  ASSERT_EQ(haptrial(run + " --subject P05 --participant 3 --session 1").status, 0);
  const Roster now = roster();
  EXPECT_THAT(now.remarks, IsEmpty());
  ASSERT_EQ(now.persons.size(), 2u);
  EXPECT_EQ(now.persons[0].number, 3);
  EXPECT_EQ(now.persons[1].number, 2);
  EXPECT_THAT(nexts(now), ElementsAre("P01 1", "P05 2", "VPx 2"));
  EXPECT_THAT(now.next[1].command, HasSubstr(" --subject P05 --session 2 --participant 3 "));
  // A later session keeps the number without being told.
  const auto later = haptrial(run + " --subject P05 --session 2");
  ASSERT_EQ(later.status, 0) << later.errors;
  EXPECT_EQ(record::SessionReader(sessions_ / "P05-session-2.h5").info().participant_number, 3u);
  ASSERT_EQ(haptrial(run + " --subject VPx --session 2 --participant 1").status, 0);
  EXPECT_THAT(roster().remarks,
              ElementsAre("VPx-session-1.h5 was recorded in the order of participant 2, and "
                          "VPx-session-2.h5 in that of 1."));
}

TEST_F(RosterTest, TheCommandsThatItShowsAreGood) {
  record("P01", 1);
  const Roster before = roster();
  for (const RosterNext& next : before.next) {
    const auto done = test::run_command(next.command);
    EXPECT_EQ(done.status, 0) << next.command << "\n" << done.errors;
    const fs::path file = sessions_ / session_file_name(next.subject, next.session, 2);
    EXPECT_TRUE(fs::exists(file)) << next.command;
  }
}

TEST_F(RosterTest, AShellReadsTheFoldersOfTheCommandAsTheyAre) {
  sessions_ = folder_ / "aus gabe $HOME `id` it's";
  fs::create_directory(sessions_);
  const std::string command = roster().next.front().command;
  const auto done = test::run_command(command);
  EXPECT_EQ(done.status, 0) << command << "\n" << done.errors;
  EXPECT_TRUE(fs::exists(sessions_ / "P01-session-1.h5")) << command;
}

TEST_F(RosterTest, ANumberOfAnotherGroupIsRefusedWithWhereItIsFrom) {
  record("P05", 1, false, 1, 2);
  const std::string run =
      "run " + quoted(definition_) + " --out " + quoted(sessions_) + " --subject P05 --session 2";
  EXPECT_THAT(haptrial(run).errors,
              HasSubstr("the participant's earlier session has the number 2, a number of left"));
  EXPECT_THAT(haptrial(run + " --participant 1").errors,
              HasSubstr("--participant is 1, a number of left, but P05 is of right"));
}

TEST_F(RosterTest, AReplacementIsNamedWithTheNumberOfTheRecording) {
  std::string one_group = kGroups;
  const std::string groups = "[groups]\nleft = 2\nright = 4\n";
  test::write_text(definition_, one_group.erase(one_group.find(groups), groups.size()));
  const std::string run = "run " + quoted(definition_) + " --out " + quoted(sessions_);
  const std::string command = "roster " + quoted(definition_) + " " + quoted(sessions_);
  const std::map<std::string, std::string> numbered{
      {"VPx --participant 2", "such as VPxb --participant 2, which has the same number"},
      {"P05 --participant 3", "such as Pb05 --participant 3, which has the same number"},
      {"P04", "such as Pb04, which has the same number"}};
  for (const auto& [subject, proposed] : numbered) {
    const std::string again = run + " --session 1 --subject " + subject;
    ASSERT_EQ(haptrial(again).status, 0) << subject;
    const std::string name = subject.substr(0, 3);
    ASSERT_EQ(haptrial(command + " --exclude " + name + " --because ill").status, 0) << subject;
    EXPECT_THAT(haptrial(again).errors, HasSubstr(proposed));
  }
}

/// The number of an imported session is its place in the tables, by which nobody chose orders.
TEST(SessionNumberTest, IsTheRecordedOneButThatOfAnImport) {
  record::SessionInfo info;
  info.subject = "P04";
  EXPECT_EQ(number_of_session(info), 4);
  info.participant_number = 1;
  EXPECT_EQ(number_of_session(info), 1);
  info.device = kNoDevice;
  EXPECT_EQ(number_of_session(info), 4);
}

TEST_F(RosterTest, ACopyIsNotCountedAmongTheTimesOfSessions) {
  record("P01", 1);
  fs::copy_file(sessions_ / "P01-session-1.h5", sessions_ / "P01-session-1.recovered.h5");
  const auto shown = haptrial("roster " + quoted(definition_) + " " + quoted(sessions_));
  EXPECT_THAT(shown.output, HasSubstr(" in 1 session)"));
}

TEST_F(RosterTest, AHandIsLeftRightOrBoth) {
  const std::string run = "run " + quoted(definition_) + " --out " + quoted(sessions_);
  const auto refused = haptrial(run + " --handedness rihgt");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("--handedness is 'rihgt'; did you mean right?"));
  EXPECT_THAT(roster().persons, IsEmpty());
}

TEST_F(RosterTest, TheSameAsATableAndAsNumbers) {
  record("P01", 1);
  record("P03", 1);
  const auto done =
      haptrial("roster " + quoted(definition_) + " " + quoted(sessions_) + " --json " +
               quoted(folder_ / "r.json") + " --csv " + quoted(folder_ / "r.csv"));
  ASSERT_EQ(done.status, 0) << done.errors;
  EXPECT_THAT(done.output, HasSubstr("left: 1 of 2 participants begun, 0 with every session"));
  EXPECT_THAT(done.output, HasSubstr("next: P04 (group right), session 1 of 2: "));
  const auto told = nlohmann::json::parse(test::read_text(folder_ / "r.json"));
  EXPECT_EQ(told.at("next").at(0).at("subject"), "P04");
  EXPECT_EQ(told.at("participants").size(), 2u);
  EXPECT_EQ(told.at("participants").at(0).at("sessions").at(0).at("state"), "done");
  const auto table = analysis::CsvTable::load(folder_ / "r.csv");
  ASSERT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.text(1, table.column("group")), "right");
  EXPECT_EQ(table.text(1, table.column("next_session")), "2");
}

}  // namespace
}  // namespace haptrial::experiments
