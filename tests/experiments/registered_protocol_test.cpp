// A protocol that no file of the product knows (docs/worked/protocol): a staircase with answers, a
// table, a display, live figures, a page beside the console and a stream of its own, through the
// same session, command and recovery.

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <thread>

#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/recovery/recover.h"
#include "core/render/gl/image.h"
#include "core/render/gl/offscreen.h"
#include "docs/worked/protocol/depth_log.h"
#include "docs/worked/protocol/spring_pass.h"
#include "docs/worked/protocol/springs.h"
#include "experiments/console/console.h"
#include "experiments/runner/session.h"
#include "experiments/runner/sinks.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"
#include "tests/experiments/console_client.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/support/sanitizer.h"
#include "tests/support/stand_in_lsl.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::registered_protocol_test {
namespace {

constexpr const char* kDefinition = HAPTRIAL_SOURCE_DIR "/docs/worked/protocol/springs.toml";
constexpr int kTrials = 40;

const Experiment& experiment() {
  static const Experiment loaded = [] {
    add_study(springs());
    return load_experiment(kDefinition);
  }();
  return loaded;
}

SessionRequest request_for(const std::filesystem::path& file) {
  SessionRequest request = test::session_request(experiment(), file, 7);
  request.live = [](const std::filesystem::path& resumed) {
    return experiment().study->live_figures(*experiment().definition, resumed);
  };
  return request;
}

/// Levels of the staircase after answers, written once more: two right down, one wrong up.
std::vector<double> staircase(const std::vector<record::ResponseRow>& answers) {
  std::vector<double> differences{150.0};
  int right = 0;
  for (const record::ResponseRow& answer : answers) {
    double next = differences.back();
    if (answer.correct != 1) {
      next *= 1.25;
      right = 0;
    } else if (++right == 2) {
      next /= 1.25;
      right = 0;
    }
    differences.push_back(next);
  }
  differences.pop_back();
  return differences;
}

std::vector<double> differences_of(const record::SessionReader& file) {
  std::vector<double> found;
  for (const SpringRow& row : file.rows<SpringRow>()) {
    found.push_back(row.difference);
  }
  return found;
}

void expect_follows_its_answers(const record::SessionReader& file) {
  const auto found = differences_of(file);
  const auto wanted = staircase(file.responses());
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i], wanted[i], 1e-9 * wanted[i]) << i;
  }
}

TEST(RegisteredProtocolTest, EveryTrialFollowsFromTheAnswersBefore) {
  const test::TemporaryFolder folder;
  run_session(request_for(folder / "S01.h5"));
  const record::SessionReader file(folder / "S01.h5");
  EXPECT_TRUE(record::check_session(file, known_tables()).ok);
  ASSERT_EQ(file.passes().size(), static_cast<std::size_t>(kTrials));
  ASSERT_EQ(file.responses().size(), static_cast<std::size_t>(kTrials));
  expect_follows_its_answers(file);
  int right = 0;
  for (const record::ResponseRow& answer : file.responses()) {
    EXPECT_EQ(answer.question, "stiffer");
    EXPECT_EQ(answer.source, record::ResponseSource::kButton);
    EXPECT_EQ(answer.pass, answer.trial - 1);
    EXPECT_GT(answer.reaction_time, 0.0);
    right += answer.correct;
  }
  EXPECT_GT(right, kTrials / 2);
  EXPECT_LT(right, kTrials) << "it comes to where one is wrong now and then";
}

/// A staircase of this kind comes to where 71 % are right: at 0.545 standard deviations of the
/// judgement (Levitt 1971), which is 8 % of 300 N/m in either interval.
TEST(RegisteredProtocolTest, TheStaircaseFindsTheThresholdOfItsParticipants) {
  const test::TemporaryFolder folder;
  double sum = 0.0;
  int count = 0;
  constexpr int kParticipants = 12;
  for (int p = 0; p < kParticipants; ++p) {
    SessionRequest request = request_for(folder / ("S" + std::to_string(p) + ".h5"));
    request.participant = p;
    request.subject = "S" + std::to_string(p);
    run_session(request);
    const auto differences = differences_of(record::SessionReader(request.file));
    for (std::size_t i = kTrials / 2; i < differences.size(); ++i) {
      sum += std::log(differences[i]);
      ++count;
    }
  }
  const double expected = 0.545 * 0.08 * 300.0 * std::sqrt(2.0);
  EXPECT_NEAR(std::exp(sum / count) / expected, 1.0, 0.35);
}

TEST(RegisteredProtocolTest, LiveFiguresGoAlong) {
  const test::TemporaryFolder folder;
  SessionControl control;
  SessionRequest request = request_for(folder / "S01.h5");
  request.control = &control;
  std::atomic<bool> over{false};
  std::thread experimenter([&] {  // says "go on" whenever a text waits for it
    while (!over) {
      if (!control.status().screen.empty()) {
        control.ask(Request::kStart);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  });
  const SessionSummary summary = run_session(request);
  over = true;
  experimenter.join();
  ASSERT_EQ(summary.figures.size(), static_cast<std::size_t>(kTrials));
  EXPECT_EQ(summary.figures.front().line, "Trial 1: Difference 150 N/m");
}

/// Short comparisons on the real clock, where a kill loses a moment and not the session.
class KilledTest : public testing::Test {
 protected:
  KilledTest() {
    std::string text = test::read_text(kDefinition);
    const auto put = [&](const std::string& key, const std::string& value) {
      const std::size_t at = text.find("\n" + key + " = ") + 1;
      text.replace(at, text.find('\n', at) - at, key + " = " + value);
    };
    put("trials", "14");
    put("interval", "0.2");
    put("ramp_out", "0.05");
    test::write_text(folder_ / "short.toml", text);
    static_cast<void>(experiment());  // the study is known
    short_ = load_experiment(folder_ / "short.toml");
  }
  SessionRequest short_request(const std::string& name, realtime::ClockKind clock) const {
    SessionRequest request = request_for(folder_ / name);
    request.definition = short_.definition.get();
    request.live = nullptr;
    request.clock = clock;
    return request;
  }
  test::TemporaryFolder folder_;
  Experiment short_;
};

TEST_F(KilledTest, ResumedItGoesOnAsItWouldHave) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "a thread sanitizer does not follow a fork of threads";
  }
  run_session(short_request("whole.h5", realtime::ClockKind::kSimulated));
  const record::SessionReader whole(folder_ / "whole.h5");
  ASSERT_EQ(whole.responses().size(), 14u);
  for (const std::uint64_t at : {2500u, 4321u}) {
    const std::string name = "killed" + std::to_string(at) + ".h5";
    test::run_and_kill(short_request(name, realtime::ClockKind::kReal), at);
    const std::size_t kept =
        record::SessionReader((folder_ / name).string() + ".partial").responses().size();
    EXPECT_GE(kept, 2u);
    EXPECT_LT(kept, 14u);
    SessionRequest request = short_request(name, realtime::ClockKind::kReal);
    request.resume = true;
    run_session(request);
    const record::SessionReader resumed(folder_ / name);
    EXPECT_TRUE(record::check_session(resumed, known_tables()).ok);
    // The trial in which it was killed comes again; what it had answered stays in the file.
    std::vector<record::ResponseRow> answers;
    for (const record::ResponseRow& answer : resumed.responses()) {
      const auto pass = resumed.passes().at(static_cast<std::size_t>(answer.pass));
      if (pass.status == record::PassStatus::kCompleted) {
        answers.push_back(answer);
      }
    }
    const auto wanted = whole.responses();
    ASSERT_EQ(answers.size(), wanted.size());
    for (std::size_t i = 0; i < answers.size(); ++i) {
      EXPECT_EQ(answers[i].trial, wanted[i].trial);
      EXPECT_EQ(answers[i].value, wanted[i].value) << i;
      EXPECT_EQ(answers[i].correct, wanted[i].correct) << i;
    }
    std::vector<double> differences;
    for (const SpringRow& row : resumed.rows<SpringRow>()) {
      const auto pass = resumed.passes().at(static_cast<std::size_t>(row.pass));
      if (pass.status == record::PassStatus::kCompleted) {
        differences.push_back(row.difference);
      }
    }
    EXPECT_EQ(differences, differences_of(whole)) << "the staircase went on where it stood";
  }
}

TEST(RegisteredProtocolTest, RecoveryKnowsItsTable) {
  const test::TemporaryFolder folder;
  SessionRequest request = request_for(folder / "S01.h5");
  request.max_trials = 6;
  run_session(request);
  record::recover_session(folder / "S01.h5", folder / "saved.h5", known_tables());
  const record::SessionReader saved(folder / "saved.h5");
  EXPECT_EQ(differences_of(saved), differences_of(record::SessionReader(folder / "S01.h5")));
  EXPECT_EQ(saved.responses().size(), 6u);
}

TEST(RegisteredProtocolTest, TheScreenDrawsItsView) {
  const test::TemporaryFolder folder;
  const SessionRequest request = request_for(folder / "S01.h5");
  protocols::SessionPlace place;
  const auto trials = request.protocol->trials(*request.definition, place);
  render::OffscreenContext context(640, 360);
  const auto drawing = trials->drawing()(context.gl(), 640, 360);
  const auto ink = [&](const SpringView& view) {
    drawing->draw(stimulus::Shown(view));
    const render::Image image = context.read();
    return std::count_if(image.rgb.begin(), image.rgb.end(),
                         [](std::uint8_t value) { return value > 128; });
  };
  const auto none = ink({1, 0, false});
  EXPECT_GT(ink({1, 1, false}), none);
  EXPECT_GT(ink({1, 0, true}), ink({1, 1, false})) << "a question has more letters";
}

/// GET or POST of a console's page. @returns the answer; of one without an end, as far as `until`
std::string answer_of(const Console& console, const std::string& method, const std::string& path,
                      const std::string& body = "", const std::string& until = "") {
  test::RawClient client(console.port());
  client.send(method + " " + path + "?token=" + console.token() + " HTTP/1.1\r\nHost: 127.0.0.1:" +
              std::to_string(console.port()) + "\r\nX-Haptrial-Token: " + console.token() +
              (method == "GET" ? ""
                               : "\r\nContent-Type: application/json\r\nContent-Length: " +
                                     std::to_string(body.size())) +
              "\r\nConnection: close\r\n\r\n" + body);
  return client.receive(test::RawClient::kForever, until);
}

TEST(RegisteredProtocolTest, AnAssistantsPageStandsBesideTheConsole) {
  const test::TemporaryFolder folder;
  SessionControl control;
  SessionRequest request = request_for(folder / "S01.h5");
  request.auxiliary_pages = request.protocol->auxiliary_pages(*request.definition);
  ConsoleOptions options;
  options.sides = request.auxiliary_pages;
  const Console console(control, options);
  EXPECT_THAT(console.side_url("springs"), testing::HasSubstr("/springs?token=" + console.token()));
  const std::string page = answer_of(console, "GET", "/springs");
  EXPECT_THAT(page, testing::HasSubstr("<title>Springs</title>"));
  EXPECT_THAT(page, testing::Not(testing::HasSubstr("NONCE"))) << "its nonce is in place";
  const std::string wrong = answer_of(console, "POST", "/springs/ask", R"({"interval": 0})");
  EXPECT_EQ(test::status_of(wrong), 400);
  EXPECT_THAT(wrong, testing::HasSubstr("0.2 to 10"));
  EXPECT_EQ(test::status_of(answer_of(console, "POST", "/springs/ask", R"({"interval": 0.3})")),
            200);
  EXPECT_EQ(test::status_of(answer_of(console, "GET", "/springs/ask")), 405);
  EXPECT_THAT(answer_of(console, "GET", "/nowhere"), testing::HasSubstr("/springs/events"));
  request.max_trials = 3;
  run_session(request);
  const record::SessionReader file(folder / "S01.h5");
  for (const record::PassRow& pass : file.passes()) {
    EXPECT_LT(pass.last_sample - pass.first_sample, 1000u) << "0.3 s each in place of 1 s";
  }
  const std::string events = answer_of(console, "GET", "/springs/events", "", "\n\n");
  EXPECT_THAT(events, testing::HasSubstr("\"trial\":3"));
}

class ReservedPage final : public protocols::AuxiliaryPage {
 public:
  explicit ReservedPage(std::string name) : name_(std::move(name)) {}
  std::string_view name() const override { return name_; }
  std::string_view title() const override { return "page"; }
  std::string_view html() const override { return ""; }
  Events events() override {
    return [] { return "{}"; };
  }
  void ask(const std::string&) override {}

 private:
  std::string name_;
};

TEST(RegisteredProtocolTest, APageNeedsAnAddressOfItsOwn) {
  SessionControl control;
  for (const char* name : {"", "events", "note", "Page", "a/b", "page?"}) {
    ConsoleOptions options;
    options.sides = {std::make_shared<ReservedPage>(name)};
    EXPECT_THROW(const Console console(control, options), std::invalid_argument) << name;
  }
  ConsoleOptions twice;
  twice.sides = {std::make_shared<ReservedPage>("one"), std::make_shared<ReservedPage>("one")};
  EXPECT_THROW(const Console console(control, twice), std::invalid_argument);
}

TEST(RegisteredProtocolTest, DepthsAreStreamedBesideTheSamples) {
  const test::TemporaryFolder folder;
  run_session(request_for(folder / "S01.h5"));
  const record::SessionReader file(folder / "S01.h5");
  const auto depths = file.rows<DepthRow>();
  const auto samples = file.samples(0, file.sample_count());
  ASSERT_GT(depths.size(), 1000u);

  void* const library = dlopen(HAPTRIAL_BINARY_DIR "/libstand_in_lsl.so", RTLD_NOW);
  ASSERT_NE(library, nullptr);
  test::LslRecord& heard =
      *reinterpret_cast<test::LslRecord* (*)()>(dlsym(library, "stand_in_lsl"))();
  heard = {};
  {
    stream::LslOptions options;
    options.library = HAPTRIAL_BINARY_DIR "/libstand_in_lsl.so";
    options.sides = experiment().definition->side_streams();
    stream::LslOutlet outlet(options, [] { return std::int64_t{0}; });
    StreamSink sink(&outlet, options.sides);  // as the session has it
    sink.rows(record::Rows(std::span<const DepthRow>(depths)));
    sink.samples(samples);
  }
  ASSERT_EQ(heard.streams.size(), 3u);
  const test::LslStream& stream = heard.streams[2];
  EXPECT_EQ(stream.type, "Position");
  EXPECT_EQ(stream.rate, 100.0);
  ASSERT_EQ(stream.values.size(), depths.size());
  const double first = stream.timestamps.front();
  for (std::size_t i = 0; i < depths.size(); ++i) {
    EXPECT_EQ(stream.values[i], depths[i].depth);
    EXPECT_NEAR(stream.timestamps[i] - first, 0.01 * static_cast<double>(i), 1e-9);
  }
  dlclose(library);
}

}  // namespace
}  // namespace haptrial::experiments::registered_protocol_test
