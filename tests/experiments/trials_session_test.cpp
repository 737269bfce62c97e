// Experiments that a definition states whole, through the same sessions as every other: what was
// presented is what is recorded, a kill loses nothing, a person answers by keys.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <thread>

#include "core/base/error.h"
#include "core/psychometric/procedure/procedure.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/answer_rows.h"
#include "core/record/rows/trial_rows.h"
#include "experiments/control/live_status.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"
#include "experiments/study/study_files.h"
#include "protocols/psychophysics/definition/trials_definition.h"
#include "protocols/psychophysics/trials_protocol.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"

namespace haptrial::experiments::trials_session_test {
namespace {

namespace fs = std::filesystem;

fs::path shipped(const std::string& name) {
  return fs::path(HAPTRIAL_SOURCE_DIR "/experiments") / (name + ".toml");
}

SessionRequest request_for(const Experiment& experiment, const fs::path& file, int trials = 0) {
  SessionRequest request = test::session_request(experiment, file, 7);
  request.max_trials = trials;
  return request;
}

/// Each pass's value of a variable in an interval; 0: the whole trial.
std::map<std::pair<int, int>, double> values_of(const record::SessionReader& file,
                                                const std::string& name) {
  std::map<std::pair<int, int>, double> values;
  for (const record::VariableRow& row : file.rows<record::VariableRow>()) {
    if (row.name == name) {
      values[{row.pass, row.interval}] = row.value;
    }
  }
  return values;
}

class ShippedTrialsTest : public testing::TestWithParam<const char*> {};

TEST_P(ShippedTrialsTest, RunsAndIsWhole) {
  const test::TemporaryFolder folder;
  const Experiment experiment = load_experiment(shipped(GetParam()));
  const SessionSummary summary = run_session(request_for(experiment, folder / "S01.h5", 6));
  EXPECT_EQ(summary.aborted_passes, 0) << "the participant does what is asked";
  const record::SessionReader file(folder / "S01.h5");
  EXPECT_TRUE(record::check_session(file, known_tables()).ok);
  const std::vector<record::PassRow> passes = file.passes();
  EXPECT_GE(passes.size(), 6u);
  for (const record::StageRow& stage : file.rows<record::StageRow>()) {
    const record::PassRow& pass = passes.at(static_cast<std::size_t>(stage.pass));
    EXPECT_GE(stage.first_sample, pass.first_sample);
    EXPECT_LE(stage.last_sample, pass.last_sample);
    EXPECT_LE(stage.first_sample, stage.last_sample);
  }
}

TEST_P(ShippedTrialsTest, StagesFollowEachOtherWithoutAGap) {
  const test::TemporaryFolder folder;
  const Experiment experiment = load_experiment(shipped(GetParam()));
  run_session(request_for(experiment, folder / "S01.h5", 3));
  const record::SessionReader file(folder / "S01.h5");
  const auto stages = file.rows<record::StageRow>();
  ASSERT_FALSE(stages.empty());
  for (std::size_t i = 1; i < stages.size(); ++i) {
    if (stages[i].pass == stages[i - 1].pass) {
      EXPECT_EQ(stages[i].first_sample, stages[i - 1].last_sample + 1) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedTrialsTest,
                         testing::Values("stiffness_discrimination", "force_discrimination",
                                         "wall_detection", "grating_discrimination",
                                         "viscosity_magnitude", "shape_recognition", "curl_field",
                                         "size_by_eye_and_hand", "lump_search"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(TrialsSessionTest, TheConsoleShowsTheForceOfAStaircase) {
  const test::TemporaryFolder folder;
  const Experiment experiment = load_experiment(shipped("stiffness_discrimination"));
  run_session(request_for(experiment, folder / "S01.h5", 2));
  const record::SessionReader file(folder / "S01.h5");
  const std::vector<record::Sample> samples = file.samples(0, file.sample_count());
  LiveStatus live;
  double greatest = 0.0;
  double pressed = 0.0;
  for (const record::Sample& sample : samples) {
    live.follow(std::span(&sample, 1), 1e6);
    SessionStatus status;
    live.fill(status);
    ASSERT_NEAR(status.force_on_hand,
                std::hypot(sample.force.x(), sample.force.y(), sample.force.z()), 1e-9);
    greatest = std::max(greatest, status.force_on_hand);
    pressed = std::max(pressed, status.applied_force);
  }
  EXPECT_GT(greatest, 0.4) << "a finger presses a wall of 300 N/m";
  EXPECT_GT(pressed, 0.4) << "and the wall pushes back as much";
}

TEST(TrialsSessionTest, WhatWasPresentedIsWhatIsRecorded) {
  const test::TemporaryFolder folder;
  const Experiment experiment = load_experiment(shipped("stiffness_discrimination"));
  run_session(request_for(experiment, folder / "S01.h5", 8));
  const record::SessionReader file(folder / "S01.h5");
  const auto stiffness = values_of(file, "stiffness");
  const auto level = values_of(file, "level");
  int compared = 0;
  for (const record::LevelRow& row : file.rows<record::LevelRow>()) {
    EXPECT_EQ(level.at({row.pass, 0}), row.applied);
  }
  for (const record::StageRow& stage : file.rows<record::StageRow>()) {
    if (stage.stage != "press") {
      continue;
    }
    // Hooke's law of the stiffness that the file states, on every tick deep in the wall.
    const double k = stiffness.at({stage.pass, stage.interval});
    constexpr std::uint64_t kFadedIn = 500;  // the field, and the guide away [ticks]
    for (std::uint64_t at = stage.first_sample + kFadedIn; at <= stage.last_sample; at += 100) {
      const record::Sample sample = file.samples(at, 1).front();
      if (sample.position.y() < -0.001) {
        EXPECT_NEAR(sample.force.y() / (-k * sample.position.y()), 1.0, 1e-3);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 100);
}

/// The staircase that the definition states, fed with the outcomes of the file.
TEST(TrialsSessionTest, EveryLevelFollowsFromTheAnswersBefore) {
  const test::TemporaryFolder folder;
  const Experiment experiment = load_experiment(shipped("stiffness_discrimination"));
  run_session(request_for(experiment, folder / "S01.h5", 40));
  const record::SessionReader file(folder / "S01.h5");
  const auto& d = dynamic_cast<const protocols::TrialsDefinition&>(*experiment.definition);
  std::map<std::string, std::unique_ptr<psychometric::Procedure>> tracks;
  for (const protocols::Track& track : d.tracks) {
    tracks[track.name] = track.begin(1, track.name);
  }
  std::map<std::int32_t, std::int32_t> correct;
  for (const record::ResponseRow& row : file.responses()) {
    correct[row.pass] = row.correct;
  }
  std::size_t rows = 0;
  for (const record::LevelRow& row : file.rows<record::LevelRow>()) {
    psychometric::Procedure& track = *tracks.at(row.track);
    EXPECT_EQ(track.next().front(), row.asked);
    EXPECT_EQ(row.outcome, correct.at(row.pass));
    track.report(row.outcome, {row.applied});
    ++rows;
  }
  EXPECT_EQ(rows, 40u);
}

/// Short trials on the real clock, where a kill loses a moment and not the session.
class KilledTrialsTest : public testing::Test {
 protected:
  KilledTrialsTest() {
    std::string text = test::read_text(shipped("stiffness_discrimination"));
    const auto put = [&](const std::string& what, const std::string& instead) {
      const std::size_t at = text.find(what);
      ASSERT_NE(at, std::string::npos) << what;
      text.replace(at, what.size(), instead);
    };
    put("until = { time = 2.5 }", "until = { time = 0.6 }");
    put("until = { inside = \"start\", for = 0.3 }", "until = { inside = \"start\", for = 0.02 }");
    put("until = { time = 0.5 }", "until = { time = 0.02 }");
    put("trials = 4\nlevel", "trials = 1\nlevel");
    put("rise = 0.5", "rise = 0.1");
    put("decides = \"largest\"", "decides = \"largest\"\nreaction = 0.05");
    test::write_text(folder_ / "short.toml", text);
    short_ = load_experiment(folder_ / "short.toml");
  }
  SessionRequest short_request(const std::string& name, realtime::ClockKind clock) const {
    SessionRequest request = request_for(short_, folder_ / name, 8);
    request.clock = clock;
    return request;
  }
  struct Done {
    std::vector<double> asked, outcomes, answers;
    bool operator==(const Done&) const = default;
  };
  /// Counts of completed passes.
  static Done done_of(const record::SessionReader& file) {
    Done done;
    const auto passes = file.passes();
    const auto complete = [&](std::int32_t pass) {
      return passes.at(static_cast<std::size_t>(pass)).status == record::PassStatus::kCompleted;
    };
    for (const record::LevelRow& row : file.rows<record::LevelRow>()) {
      if (complete(row.pass)) {
        done.asked.push_back(row.asked);
        done.outcomes.push_back(row.outcome);
      }
    }
    for (const record::ResponseRow& row : file.responses()) {
      if (complete(row.pass)) {
        done.answers.push_back(row.value);
      }
    }
    return done;
  }
  test::TemporaryFolder folder_;
  Experiment short_;
};

TEST_F(KilledTrialsTest, TheStaircaseGoesOnAsItWouldHave) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "a thread sanitizer does not follow a fork of threads";
  }
  run_session(short_request("whole.h5", realtime::ClockKind::kSimulated));
  const Done whole = done_of(record::SessionReader(folder_ / "whole.h5"));
  ASSERT_EQ(whole.asked.size(), 8u);
  for (const std::uint64_t at : {6000u, 9500u}) {
    const std::string name = "killed" + std::to_string(at) + ".h5";
    test::run_and_kill(short_request(name, realtime::ClockKind::kReal), at);
    SessionRequest request = short_request(name, realtime::ClockKind::kReal);
    request.resume = true;
    run_session(request);
    const record::SessionReader resumed(folder_ / name);
    EXPECT_TRUE(record::check_session(resumed, known_tables()).ok);
    EXPECT_EQ(done_of(resumed), whole);
  }
}

TEST(TrialsReplayTest, DrawsWhatWasShownAndRefusesWhatIsNotThere) {
  const test::TemporaryFolder folder;
  const Experiment experiment = load_experiment(shipped("stiffness_discrimination"));
  run_session(request_for(experiment, folder / "S01.h5", 3));
  protocols::ReplayRequest request;
  request.file = folder / "S01.h5";
  request.trial = 3;
  request.fps = 10;
  request.pictures = true;
  std::vector<render::Image> pictures;
  request.picture = [&](const render::Image& image) { pictures.push_back(image); };
  request.progress = [](double, double, const std::string&, double) {};
  request.tell = [](const std::string&) {};
  const protocols::Protocol& protocol = experiment.study->protocol();
  protocol.replay(request);
  const record::SessionReader file(folder / "S01.h5");
  const auto passes = file.passes();
  const record::PassRow& pass = passes.back();
  const double seconds = 1e-3 * static_cast<double>(pass.last_sample - pass.first_sample);
  EXPECT_EQ(pictures.size(), static_cast<std::size_t>(std::floor(seconds * 10.0 + 1e-9)) + 1);
  // The first picture shows the hand and the start, the last the question; the press is between.
  const auto ink = [](const render::Image& image) {
    return std::count_if(image.rgb.begin(), image.rgb.end(),
                         [](std::uint8_t value) { return value < 200; });
  };
  EXPECT_GT(ink(pictures.front()), 1000);
  EXPECT_GT(ink(pictures.back()), 2 * ink(pictures.front()));
  request.trial = 99;
  EXPECT_THAT([&] { protocol.replay(request); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("allowed: 1 to 3")));
}

/// Somebody at a shipped definition's window: what is pressed, and what comes of it.
struct AtTheWindow {
  const char* name;
  std::vector<unsigned long> keys;  // again and again; space begins
  const char* text;                 // of each answer; null: a number, or nothing is asked
  double value;                     // of each answer; NaN: nothing is asked
  bool always{false};               // else only when every window is asked for
};

void PrintTo(const AtTheWindow& at, std::ostream* out) { *out << at.name; }

constexpr double kNotAsked = std::numeric_limits<double>::quiet_NaN();

/// The shipped definition for a virtual hand and a person's keys, in a small window.
std::string rehearsed(const std::string& name) {
  std::string text = test::read_text(shipped(name));
  const auto put = [&](const std::string& what, const std::string& instead) {
    if (const std::size_t at = text.find(what); at != std::string::npos) {
      text.replace(at, what.size(), instead);
    }
  };
  put("[observer]", "[observer]\nreaction = 60.0");  // it waits: keys answer
  put("trials = 4\nlevel = 550.0", "trials = 1\nlevel = 550.0");
  put("practice = true\ntrials = 8", "practice = true\ntrials = 1");
  const std::string display = "width = 600\nheight = 440\n";
  if (text.find("[display]") == std::string::npos) {
    text += "\n[display]\n";
  }
  put("[display]", "[display]\n" + display);
  return text + "\n[screen]\nfull_screen = false\n";
}

class LiveTrialsTest : public testing::TestWithParam<AtTheWindow> {
 protected:
  void SetUp() override {
    if (!GetParam().always && std::getenv("HAPTRIAL_EVERY_WINDOW") == nullptr) {
      GTEST_SKIP() << "takes half a minute; set HAPTRIAL_EVERY_WINDOW=1 to run it";
    }
  }
};

/// A participant who goes back in pages, and who reports a wrong key, with an experimenter at the
/// console who sees each step.
TEST(LiveMistakesTest, AParticipantGoesBackInPagesAndReportsAWrongKey) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "study.toml",
                   rehearsed("wall_detection") + "mistake_key = \"backspace\"\n" + R"(
[pages]
before = ["you"]
[pages.you]
kind = "questions"
[[pages.you.items]]
name = "glasses"
question = "Do you wear glasses?"
choices = [{ value = "yes" }, { value = "no" }]
[[pages.you.items]]
name = "tired"
question = "How tired are you?"
scale = [1, 7]
)");
  test::VirtualDisplay display(640, 480);
  test::LiveCommand session("run '" + (folder / "study.toml").string() + "' --subject S01 --out '" +
                            (folder / "out").string() + "' --window --console");
  test::ConsolePerson experimenter(session.line_after("console: "));
  int asked = 0;
  const auto is_asked = [&](const char* kind, const char* given) {
    ++asked;
    return session.reaches([&] {
      const auto now = experimenter.status();
      return !now.is_null() && !now["asked"].is_null() && now["asked"]["number"] == asked &&
             now["asked"]["kind"] == kind && now["asked"]["given"] == given;
    });
  };
  const auto press = [&](std::initializer_list<unsigned long> keys) {
    for (const unsigned long key : keys) {
      display.press_key("haptrial", key);
    }
  };
  constexpr unsigned long kBack = 0xff08;
  ASSERT_TRUE(is_asked("choice", "")) << session.errors();
  press({'2', test::VirtualDisplay::kEnter});
  ASSERT_TRUE(is_asked("scale", "")) << session.errors();
  press({kBack});
  ASSERT_TRUE(is_asked("choice", "2")) << session.errors();
  press({'1', test::VirtualDisplay::kEnter});
  ASSERT_TRUE(is_asked("scale", "")) << session.errors();
  press({'6', test::VirtualDisplay::kEnter});
  ASSERT_TRUE(is_asked("read", "")) << session.errors();
  press({test::VirtualDisplay::kEnter});
  ASSERT_TRUE(experimenter.sees("instructions")) << session.errors();
  ASSERT_TRUE(experimenter.ask("start"));
  ASSERT_TRUE(session.reaches([&] {
    press({'2', kBack});
    const auto now = experimenter.status();
    return !now.is_null() && now["notices"].dump().find("is a mistake") != std::string::npos;
  })) << session.errors();
  ASSERT_TRUE(experimenter.ask("end"));
  ASSERT_EQ(session.wait().status, 0);
  const record::SessionReader file(folder / "out/S01.h5");
  EXPECT_TRUE(record::check_session(file, known_tables()).ok);
  std::vector<std::string> texts;
  for (const record::AnswerRow& row : file.rows<record::AnswerRow>()) {
    texts.push_back(row.text.empty() ? std::to_string(std::lround(row.value)) : row.text);
    EXPECT_EQ(row.source, record::AnsweredAt::kWindow);
  }
  EXPECT_THAT(texts, testing::ElementsAre("no", "yes", "6"));
  std::set<std::string> answered;
  for (const record::ResponseRow& row : file.responses()) {
    const record::PassRow pass = file.passes().at(static_cast<std::size_t>(row.pass));
    answered.insert((pass.practice ? "practice trial " : "trial ") + std::to_string(pass.trial));
  }
  std::size_t reported = 0;
  for (const record::EventRow& event : file.events()) {
    if (event.kind == "participant_error") {
      ++reported;
      EXPECT_TRUE(answered.contains(event.text)) << event.text;
    }
  }
  EXPECT_GE(reported, 1u);
  const ProtocolOf protocol = [&](const record::SessionInfo&) -> const protocols::Protocol& {
    return protocols::trials_protocol();
  };
  EXPECT_THAT(study_files(folder / "out", Pilots::kLeftOut, protocol).remarks,
              testing::Contains(testing::HasSubstr("Answered by mistake as participants said")));
}

TEST_P(LiveTrialsTest, APersonAnswersByKeysOfTheWindow) {
  const AtTheWindow& person_at = GetParam();
  const test::TemporaryFolder folder;
  test::write_text(folder / "study.toml", rehearsed(person_at.name));
  test::VirtualDisplay display(640, 480);
  test::LiveCommand session("run '" + (folder / "study.toml").string() +
                            "' --subject S01 --trials 2 --out '" + (folder / "out").string() +
                            "' --window");
  std::atomic<bool> over{false};
  std::thread person([&] {
    while (!over) {
      for (const unsigned long key : person_at.keys) {
        try {
          display.press_key("haptrial", key);
        } catch (const std::runtime_error&) {  // not open yet, or closed
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(150));
      }
    }
  });
  const test::CommandResult ended = session.wait();
  over = true;
  person.join();
  EXPECT_EQ(ended.status, 0) << ended.output;
  const record::SessionReader file(folder / "out/S01.h5");
  EXPECT_TRUE(record::check_session(file, known_tables()).ok);
  int completed = 0;
  for (const record::PassRow& pass : file.passes()) {
    completed += pass.status == record::PassStatus::kCompleted && !pass.practice ? 1 : 0;
  }
  EXPECT_EQ(completed, 2) << ended.output;
  if (std::isnan(person_at.value)) {
    return;
  }
  const auto responses = file.responses();
  ASSERT_GE(responses.size(), 2u);
  for (const record::ResponseRow& row : responses) {
    EXPECT_EQ(row.source, record::ResponseSource::kKey);
    EXPECT_EQ(row.value, person_at.value);
    if (person_at.text != nullptr && &row == &responses.front()) {
      EXPECT_EQ(row.text, person_at.text);
    }
    EXPECT_GT(row.reaction_time, 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shipped, LiveTrialsTest,
    testing::Values(
        AtTheWindow{"stiffness_discrimination", {' ', '2'}, "second", 2.0},
        AtTheWindow{"force_discrimination", {' ', '2'}, "second", 2.0},
        AtTheWindow{"wall_detection", {' ', '2'}, "no", 2.0, true},
        AtTheWindow{"grating_discrimination", {' ', '2'}, "second", 2.0},
        AtTheWindow{
            "viscosity_magnitude", {' ', '7', test::VirtualDisplay::kEnter}, nullptr, 7.0, true},
        AtTheWindow{"shape_recognition", {' ', '2'}, nullptr, 2.0},
        AtTheWindow{"lump_search", {' ', '2'}, nullptr, 2.0},
        AtTheWindow{"curl_field", {' '}, nullptr, kNotAsked},
        AtTheWindow{"size_by_eye_and_hand", {' ', '2'}, "second", 2.0, true}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace haptrial::experiments::trials_session_test
