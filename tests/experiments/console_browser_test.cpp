// The console's page in a real browser: console_browser.py clicks, this test is the session.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "experiments/console/console.h"
#include "experiments/console/console_messages.h"
#include "experiments/studies/drilling/live_drilling.h"
#include "tests/experiments/browser.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

using ::testing::ElementsAre;
namespace fs = std::filesystem;

/// Plays a session as the runner would: follows what it is asked, publishes 50 times a second.
class ScriptedSession {
 public:
  explicit ScriptedSession(SessionControl& control) : control_(control) {
    status_.subject = "S01";
    status_.state = "instructions";
    status_.screen = "Hold the handle lightly.\nFollow the line; press as the bar shows.";
    status_.trial = 1;
    status_.trials = 72;
    status_.block = 1;
    status_.blocks = 24;
    status_.condition = "visuohaptic";
    status_.phase = "training";
    status_.stage = "idle";
    status_.device = "virtual";
    status_.simulated = true;
    status_.rate = 1000.0;
    status_.lateness_median_us = 3.1;
    status_.lateness_99_us = 11.8;
    status_.lateness_worst_us = 64.0;
    thread_ = std::thread([this] { run(); });
  }
  ~ScriptedSession() {
    ended_ = true;
    thread_.join();
  }

  const std::vector<std::string>& stop_and_tell() {
    ended_ = true;
    if (thread_.joinable()) {
      thread_.join();
    }
    thread_ = std::thread([] {});
    return heard_;
  }

 private:
  void run() {
    while (!ended_) {
      for (const auto& message : control_.take()) {
        heard_.push_back(message.is_note ? "note: " + message.text : name_of(message.request));
        if (!message.is_note) {
          follow(message.request);
        }
      }
      move();
      control_.publish(status_);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

  void follow(Request request) {
    switch (request) {
      case Request::kStart:
        status_.state = "running";
        status_.screen.clear();
        status_.stage = "run";
        break;
      case Request::kPause:
        status_.state = "paused";
        break;
      case Request::kSkipTrial:
        status_.trial = 20;
        status_.block = 7;
        break;
      case Request::kEmergencyStop:
        status_.state = "stopped";
        status_.fault = "an emergency stop";
        break;
      case Request::kClear:
        status_.state = "paused";
        status_.fault.clear();
        break;
      default:
        break;
    }
  }

  void move() {
    status_.ticks += 20;
    const double t = static_cast<double>(status_.ticks) / 1000.0;
    const bool moving = status_.state == "running";
    status_.target_force = moving ? 2.2 + 1.1 * std::sin(1.26 * t) + 0.5 * std::sin(2.9 * t) : 0.0;
    status_.applied_force = moving ? 0.93 * status_.target_force + 0.15 * std::sin(7.0 * t) : 0.0;
    status_.force_on_hand = std::abs(status_.applied_force);
    status_.position = {0.05 * std::sin(0.3 * t), 0.0004 * std::sin(5.0 * t),
                        0.02 * std::cos(0.7 * t)};
  }

  SessionControl& control_;
  SessionStatus status_;
  std::vector<std::string> heard_;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

TEST(ConsoleBrowserTest, ASessionIsClickedThrough) {
  const test::TemporaryFolder folder;
  SessionControl control;
  ScriptedSession session(control);
  auto console = std::make_unique<Console>(control);
  std::vector<std::string> refusals;
  const int status = test::run_browser(
      "console_browser.py", {console->url(), folder.path().string()}, [&](const std::string& line) {
        ASSERT_EQ(line, "CLOSE\n");
        refusals = console->refusals();
        console.reset();
      });
  EXPECT_EQ(status, 0);
  EXPECT_THAT(session.stop_and_tell(),
              ElementsAre("start", "pause", "note: hand slips <b>&amp; \u00e9 r s a c p", "start",
                          "repeat", "skip", "emergency_stop", "clear", "emergency_stop", "clear"));
  EXPECT_GE(refusals.size(), 3u) << "of the page from elsewhere";
  for (const char* picture : {"console-narrow.png", "console-lost.png"}) {
    ASSERT_TRUE(fs::exists(folder / picture)) << picture;
    EXPECT_GT(fs::file_size(folder / picture), 10'000u) << picture;
  }
}

record::LiveState drilled() {
  DrilledProcedure procedure;
  procedure.trial = 2;
  analysis::drilling::LiveFigures& f = procedure.figures;
  f.time = 125.4;
  f.drilling = 48.9;
  f.removed = 1234.5e-9;
  f.voxels = 51973;
  f.visible_share = 0.876;
  f.mean_force = 2.351;
  f.injuries = {{"facial nerve", 2, 12, 0, 30.0, 31.0},
                {"internal carotid artery", 3, 0, 0, {}, {}},
                {"sigmoid sinus and dura <b>", 4, 1000, 4, 50.0, 51.0}};
  return state_of(procedure);
}

TEST(ConsoleBrowserTest, ADrillingHasAPanelOfItsFigures) {
  const test::TemporaryFolder folder;
  SessionControl control;
  std::atomic<bool> ended{false};
  std::thread session([&] {
    SessionStatus status;
    status.subject = "S01";
    status.state = "instructions";
    status.screen = "A mastoidectomy";
    status.condition = status.phase = "drilling";
    status.device = "virtual";
    status.simulated = true;
    status.trial = status.trials = 2;
    status.rate = 1000.0;
    for (; !ended; std::this_thread::sleep_for(std::chrono::milliseconds(20))) {
      for (const auto& message : control.take()) {
        if (message.request == Request::kStart) {
          status.state = "running";
          status.stage = "run";
          status.screen.clear();
          status.rate_measured = 998.3;
          status.figures = drilled();
          status.has_target = false;
          status.force_on_hand = 11.0;
          status.force_limit = 12.0;
        }
      }
      status.ticks += 20;
      control.publish(status);
    }
  });
  int status = 0;
  {
    const Console console(control);
    status = test::run_browser("console_drilling.py", {console.url(), folder.path().string()});
  }
  ended = true;
  session.join();
  EXPECT_EQ(status, 0);
  if (const char* kept = std::getenv("HAPTRIAL_KEEP_PICTURES")) {
    for (const char* picture : {"console-drilling.png", "console-drilling-narrow.png"}) {
      fs::copy_file(folder / picture, fs::path(kept) / picture,
                    fs::copy_options::overwrite_existing);
    }
  }
}

/// A partner's state in a session of two: at first nothing, then a link, then its loss.
record::PartnerState partner_at(int step) {
  record::PartnerState p;
  if (step == 0) {
    return p;
  }
  p.heard = true;
  p.round_trip = 0.10341;
  p.jitter = 0.00832;
  p.loss = 0.0487;
  p.energy = 0.01249;
  p.linked = p.coupled = p.claims = step == 1;
  p.other_claims = step == 2;
  p.lead = step == 1 ? 0.75 : 1.0;
  p.losses = step == 1 ? 0 : 2;
  return p;
}

TEST(ConsoleBrowserTest, ASessionOfTwoHasAPanelOfItsLink) {
  const test::TemporaryFolder folder;
  SessionControl control;
  std::atomic<bool> ended{false};
  std::vector<std::string> asked;
  std::thread session([&] {
    SessionStatus status;
    status.subject = "S01";
    status.state = "running";
    status.stage = "run";
    status.simulated = true;
    status.trial = status.trials = 1;
    status.rate = status.rate_measured = 1000.0;
    int step = 0;
    for (; !ended; std::this_thread::sleep_for(std::chrono::milliseconds(20))) {
      for (const auto& message : control.take()) {
        asked.push_back(name_of(message.request));
        step = message.request == Request::kTakeLead   ? 1
               : message.request == Request::kHandOver ? 2
                                                       : step;
      }
      status.ticks += 20;
      status.partner = partner_at(step);
      control.publish(status);
    }
  });
  int status = 0;
  {
    const Console console(control);
    status = test::run_browser("console_partner.py", {console.url(), folder.path().string()});
  }
  ended = true;
  session.join();
  EXPECT_EQ(status, 0);
  EXPECT_THAT(asked, ElementsAre("take_lead", "hand_over"));
  if (const char* kept = std::getenv("HAPTRIAL_KEEP_PICTURES")) {
    fs::copy_file(folder / "console-partner.png", fs::path(kept) / "console-partner.png",
                  fs::copy_options::overwrite_existing);
  }
}

}  // namespace
}  // namespace haptrial::experiments
