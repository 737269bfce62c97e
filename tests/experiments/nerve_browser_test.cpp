// The page of the nerve monitor's technician in a real browser, and what its server refuses.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "core/base/error.h"
#include "core/bone/nerve/nerve_beside.h"
#include "experiments/console/console.h"
#include "protocols/bone_drilling/nerve_page.h"
#include "tests/experiments/browser.h"
#include "tests/experiments/console_client.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::nerve_browser_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

nerve::NerveSetup setup() {
  nerve::NerveSetup s;
  s.nerves = {{"facial nerve", {}, 0.0, {"oculi", "oris"}}, {"drawn", {}, 0.0, {"drawn <b>"}}};
  return s;
}

/// A servo loop that drills beside nerves in real time; when the technician has set the current, it
/// holds a probe on the first of them instead.
class Drilling {
 public:
  explicit Drilling(std::shared_ptr<nerve::MonitorBuffer> buffer)
      : beside_(
            [this](std::uint64_t) {
              return std::make_unique<nerve::NerveSimulation>(setup(), 1000.0, 1, pulse_);
            },
            1000.0, {std::move(buffer), nullptr}),
        thread_([this] { run(); }) {}
  ~Drilling() {
    ended_ = true;
    thread_.join();
  }

 private:
  void run() {
    RandomStream random(3, "plan");
    nerve::NerveTick tick;
    auto due = std::chrono::steady_clock::now();
    for (; !ended_; ++tick.sequence) {
      const float current = pulse_->load();
      const bool probes = current != kAtFirst;
      tick.drilling = !probes && (tick.sequence / 4000) % 2 == 0;
      tick.current = probes && tick.sequence % 250 == 0 ? current : 0.0f;
      tick.nerves[0].distance = 0.0f;
      for (std::size_t n = 0; n < 2; ++n) {
        tick.nerves[n].burst = !probes && tick.sequence % 1500 == 400 + 600 * n;
        tick.nerves[n].train = !probes && tick.sequence % 6000 == 2500 + 2000 * n;
        tick.nerves[n].severity = static_cast<float>(random.uniform(0.5, 1.0));
      }
      beside_.after_tick(tick);
      due += std::chrono::milliseconds(1);
      std::this_thread::sleep_until(due);
    }
  }

  static constexpr float kAtFirst = 0.5e-3f;  // [A]
  nerve::PulseCurrent pulse_{std::make_shared<std::atomic<float>>(kAtFirst)};
  nerve::ThreadedNerves beside_;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

TEST(NerveBrowserTest, ATechnicianWatchesMutesAndSetsAThreshold) {
  const test::TemporaryFolder folder;
  SessionControl control;
  ConsoleOptions options;
  const auto page = std::make_shared<protocols::NervePage>();
  options.sides = {page};
  const Drilling drilling(page->buffer());
  auto console = std::make_unique<Console>(control, options);
  const int status =
      test::run_browser("nerve_browser.py", {console->side_url("nerves"), folder.path().string()},
                        [&](const std::string& line) {
                          ASSERT_EQ(line, "CLOSE\n");
                          console.reset();
                        });
  EXPECT_EQ(status, 0);
  if (const char* kept = std::getenv("HAPTRIAL_KEEP_PICTURES")) {
    for (const char* picture : {"nerve-monitor.png", "nerve-monitor-narrow.png"}) {
      fs::copy_file(folder / picture, fs::path(kept) / picture,
                    fs::copy_options::overwrite_existing);
    }
  }
}

std::string refusal(const std::string& json) {
  try {
    protocols::parse_nerve_order(json);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(NervePageTest, OrdersAreReadStrictly) {
  EXPECT_EQ(refusal(R"({"channel": 0, "muted": true})"), "");
  const nerve::MonitorOrder order =
      protocols::parse_nerve_order(R"({"channel": 2, "threshold": 150e-6})");
  EXPECT_EQ(order.channel, 2u);
  using What = nerve::MonitorOrder::What;
  EXPECT_EQ(order.what, What::kThreshold);
  EXPECT_DOUBLE_EQ(order.threshold, 150e-6);
  EXPECT_EQ(protocols::parse_nerve_order(R"({"channel": 1, "search": true})").what, What::kSearch);
  const nerve::MonitorOrder probe = protocols::parse_nerve_order(R"({"stimulus": 0.003})");
  EXPECT_EQ(probe.what, What::kStimulus);
  EXPECT_DOUBLE_EQ(probe.current, 0.003);
  for (const char* wrong :
       {"", "[]", "{}", R"({"channel": 0})", R"({"muted": true})",
        R"({"channel": -1, "muted": true})", R"({"channel": 9, "muted": true})",
        R"({"channel": 0, "muted": 1})", R"({"channel": 0, "threshold": 1})",
        R"({"channel": 0, "threshold": 0})", R"({"stimulus": 0.01})",
        R"({"stimulus": 1e-3, "channel": 0})", R"({"channel": 0, "search": false})",
        R"({"channel": 0, "threshold": 1e-4, "muted": true})"}) {
    EXPECT_THAT(refusal(wrong), HasSubstr("one of \"muted\"")) << wrong;
  }
}

std::string got(const Console& console, const std::string& target) {
  test::RawClient client(console.port());
  client.send("GET " + target + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(console.port()) +
              "\r\n\r\n");
  return client.receive(test::RawClient::kForever);
}

TEST(NervePageTest, OnlyAConsoleWithAMonitorServesIt) {
  SessionControl control;
  const Console plain(control);
  EXPECT_EQ(test::status_of(got(plain, "/nerves?token=" + plain.token())), 404);
  ConsoleOptions options;
  options.sides = {std::make_shared<protocols::NervePage>()};
  const Console watched(control, options);
  EXPECT_THAT(got(watched, "/nerves?token=" + watched.token()), HasSubstr("Nerve monitor"));
  EXPECT_THAT(got(watched, "/nerves"), HasSubstr("the token is missing"));
}

}  // namespace
}  // namespace haptrial::experiments::nerve_browser_test
