// Two sessions in two processes, joined over a bad network: through a whole study, and through what
// can happen to either.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/partner_rows.h"
#include "core/tutoring/sockets.h"
#include "tests/experiments/command.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/network_relay.h"
#include "tests/experiments/shipped.h"
#include "tests/support/free_port.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace haptrial::experiments {
namespace {

using record::LinkRow;
using test::LiveCommand;
using testing::HasSubstr;

class LinkTest : public testing::Test {
 protected:
  LinkTest() {
    test::run_command("haptrial secret " + secret());
    test::write_text(definition(), test::brisk_text() + "\n[tutoring]\npatience = 20\n");
  }

  /// Passes of ten seconds, in which something is done, and the head of a table to go on with.
  static std::string slow() {
    return test::brisk_text({{"speed", "speed = 0.006"}}) + "\n[tutoring]\n";
  }
  std::string secret() const { return (folder_ / "tutoring.secret").string(); }
  std::string definition() const { return (folder_ / "linked.toml").string(); }
  std::string out(const std::string& side) const { return (folder_ / side).string(); }
  std::string file(const std::string& side) const { return out(side) + "/P01.h5"; }
  std::string partial(const std::string& side) const { return file(side) + ".partial"; }

  std::string line(const std::string& side, int trials, const std::string& more) const {
    return "run " + definition() + " --subject P01 --trials " + std::to_string(trials) +
           " --secret " + secret() + " --out " + out(side) + " " + more;
  }
  void start(int trials, const test::RelayConditions& network, const std::string& more = "") {
    port_ = test::free_port();
    teaches_ = std::make_unique<LiveCommand>(
        line("teaching", trials, "--teach " + std::to_string(port_) + " " + more));
    ASSERT_NE(teaches_->line_after("waiting at port"), "");
    relay_ = std::make_unique<test::NetworkRelay>(port_, network);
    learns_ = std::make_unique<LiveCommand>(
        line("learning", trials,
             "--learn-from 127.0.0.1:" + std::to_string(relay_->port()) + " " + more));
  }
  std::string said() { return teaches_->errors() + learns_->errors() + learns_->output(); }

  std::vector<LinkRow> rows(const std::string& path) const {
    try {
      return record::SessionReader(path).rows<LinkRow>();
    } catch (const std::exception&) {
      return {};
    }
  }
  /// Waits until both hands of the session in the file are coupled. @returns false if it ended
  /// before.
  bool coupled(const std::string& path) {
    return learns_->reaches([&] {
      const auto all = rows(path);
      return !all.empty() && (all.back().state & record::kLinkEngaged) != 0;
    });
  }

  test::TemporaryFolder folder_;
  std::uint16_t port_{0};
  std::unique_ptr<LiveCommand> teaches_;
  std::unique_ptr<test::NetworkRelay> relay_;
  std::unique_ptr<LiveCommand> learns_;
};
using LiveLinkTest = LinkTest;
using TimedLinkTest = LinkTest;

/// Energy that came out of nothing on either side at most [J], and the greatest force [N].
struct Figures {
  double least_energy{0.0};
  double given{0.0};
  double most_force{0.0};
  double most_coupling{0.0};
  double delay{0.0};
  double loss{0.0};
  std::uint64_t dropped{0};
};

Figures figures_of(const std::string& path) {
  const record::SessionReader reader(path);
  const auto rows = reader.rows<LinkRow>();
  Figures f;
  std::vector<double> delays;
  for (const LinkRow& row : rows) {
    f.least_energy = std::min(f.least_energy, row.energy);
    f.most_coupling = std::max(f.most_coupling, row.coupling.norm());
    if (row.heard > 0) {
      delays.push_back(row.delay);
    }
  }
  for (const record::Sample& s : reader.samples(0, reader.sample_count())) {
    f.most_force = std::max(f.most_force, s.force.norm());
  }
  std::ranges::nth_element(delays, delays.begin() + static_cast<long>(delays.size() / 2));
  f.delay = delays.empty() ? 0.0 : delays[delays.size() / 2];
  f.given = rows.back().energy_given;
  f.loss = rows.back().lost / std::max(1.0, static_cast<double>(rows.back().heard));
  f.dropped = record::check_session(reader).dropped;
  return f;
}

std::string bytes_of(const std::string& path) { return test::read_text(path); }

TEST_F(LiveLinkTest, TwoProcessesGoThroughAStudyInStep) {
  start(2, {.delay = 0.01, .jitter = 0.005, .loss = 0.05, .duplication = 0.02, .reordering = 0.05});
  const test::CommandResult a = learns_->wait();
  const test::CommandResult b = teaches_->wait();
  ASSERT_EQ(a.status, 0) << a.errors << a.output;
  ASSERT_EQ(b.status, 0) << b.errors << b.output;
  for (const char* side : {"learning", "teaching"}) {
    const record::SessionReader reader(file(side));
    const record::Integrity integrity = record::check_session(reader);
    EXPECT_TRUE(integrity.ok) << testing::PrintToString(integrity.problems);
    EXPECT_EQ(integrity.dropped, 0u);
    ASSERT_EQ(reader.passes().size(), 4u);
    for (const record::PassRow& pass : reader.passes()) {
      EXPECT_EQ(pass.status, record::PassStatus::kCompleted);
    }
    EXPECT_EQ(rows(file(side)).size(), reader.sample_count());
    EXPECT_GT(figures_of(file(side)).most_coupling, 0.05);
    EXPECT_GT(figures_of(file(side)).least_energy, -0.01);
    // The secret that both know and nobody else stands in no file.
    std::string known = test::read_text(secret());
    known.pop_back();
    EXPECT_EQ(bytes_of(file(side)).find(known), std::string::npos);
  }
}

TEST_F(LiveLinkTest, AStrangerIsCountedAndChangesNothing) {
  test::write_text(definition(), slow() + "patience = 20\n");
  start(1, {});
  ASSERT_TRUE(coupled(partial("learning"))) << said();
  const tutoring::Socket socket = tutoring::datagram_socket(0);
  const tutoring::Address to = tutoring::address_of("127.0.0.1:" + std::to_string(port_));
  const std::string noise(200, 'x');
  for (int i = 0; i < 500; ++i) {
    ::sendto(socket.get(), noise.data(), noise.size(), 0,
             reinterpret_cast<const sockaddr*>(&to.storage), to.size);
  }
  ASSERT_EQ(learns_->wait().status, 0) << said();
  ASSERT_EQ(teaches_->wait().status, 0) << said();
  long counted = 0;
  for (const record::EventRow& event : record::SessionReader(file("teaching")).events()) {
    const std::size_t at = event.text.find(" foreign");
    if (event.kind == "link" && at != std::string::npos) {
      counted = std::stol(event.text.substr(event.text.rfind(' ', at - 1)));
    }
  }
  EXPECT_GT(counted, 100) << "on a busy machine the system's queue loses some";
  EXPECT_LE(counted, 500);
}

TEST_F(LiveLinkTest, WhoDoesNotKnowTheSecretOrHasAnotherStudyIsTurnedAway) {
  const std::string other = (folder_ / "other.secret").string();
  ASSERT_EQ(test::run_command("haptrial secret " + other).status, 0);
  EXPECT_EQ(test::run_command("haptrial secret " + other).status, 2) << "it exists";
  port_ = test::free_port();
  teaches_ = std::make_unique<LiveCommand>(line("teaching", 1, "--teach " + std::to_string(port_)));
  ASSERT_NE(teaches_->line_after("waiting at port"), "");
  const std::string come = " --learn-from 127.0.0.1:" + std::to_string(port_);
  const test::CommandResult stranger =
      test::run_command("haptrial run " + definition() + " --subject P01 --trials 1 --secret " +
                        other + " --out " + out("learning") + come);
  EXPECT_EQ(stranger.status, 1);
  EXPECT_THAT(stranger.errors, HasSubstr("secrets differ"));
  EXPECT_FALSE(std::filesystem::exists(out("learning")));
  const char* told = "a guest without the secret was turned away";
  test::wait_until(
      [&] { return (teaches_->output() + teaches_->errors()).find(told) != std::string::npos; });
  const test::CommandResult differs = test::run_command("haptrial " + line("learning", 2, come));
  EXPECT_EQ(differs.status, 2);
  EXPECT_THAT(differs.errors, HasSubstr("both must have the same ones"));
  EXPECT_EQ(teaches_->wait().status, 2);
}

/// The force of the link is gone 50 ms after the deadline.
void expect_no_force_after_silence(const std::string& path) {
  const record::SessionReader reader(path);
  const auto rows = reader.rows<LinkRow>();
  const auto samples = reader.samples(0, reader.sample_count());
  std::size_t silent = 0;
  std::size_t faded = 0;
  double silence = 0.0;
  for (const LinkRow& row : rows) {
    const std::size_t i = row.sequence - samples.front().sequence;
    const double dt =
        i > 0 ? 1e-9 * static_cast<double>(samples[i].time_ns - samples[i - 1].time_ns) : 0.0;
    silence = row.arrived > 0 ? 0.0 : silence + dt;
    faded = silence > 0.101 ? faded + 1 : 0;  // the deadline, and the tick that finds it out
    if (faded > 52) {                         // ticks of the fade, and two more
      ++silent;
      ASSERT_EQ(row.coupling.norm(), 0.0) << "tick " << row.sequence << " after " << silence;
    }
  }
  EXPECT_GT(silent, 500u);
}

TEST_F(LiveLinkTest, TheKilledSideLeavesTheOtherWholeAndBothGoOn) {
  if (test::kThreadSanitizer) {
    GTEST_SKIP() << "a thread sanitizer is too slow for real time";
  }
  test::write_text(definition(), slow() + "patience = 10\n");
  for (const char* killed : {"learning", "teaching"}) {
    const std::string left = std::string(killed) == "learning" ? "teaching" : "learning";
    for (const char* side : {"learning", "teaching"}) {
      std::filesystem::remove_all(out(side));
    }
    start(1, {.delay = 0.005});
    ASSERT_TRUE(coupled(partial(left))) << said();
    (std::string(killed) == "learning" ? learns_ : teaches_)->signal(SIGKILL);
    LiveCommand& survivor = left == "learning" ? *learns_ : *teaches_;
    const test::CommandResult r = survivor.wait();
    EXPECT_EQ(r.status, 1);
    EXPECT_THAT(r.errors, HasSubstr("continue with --resume on both sides"));
    const record::Integrity whole = record::check_session(record::SessionReader(partial(left)));
    EXPECT_TRUE(whole.ok) << testing::PrintToString(whole.problems);
    expect_no_force_after_silence(partial(left));
    if (left == "learning") {
      continue;  // once is enough
    }
    start(1, {.delay = 0.005}, "--resume");
    EXPECT_EQ(learns_->wait().status, 0) << said();
    EXPECT_EQ(teaches_->wait().status, 0) << said();
    for (const char* side : {"learning", "teaching"}) {
      const record::SessionReader reader(file(side));
      EXPECT_TRUE(record::check_session(reader).ok);
      EXPECT_EQ(reader.passes().back().status, record::PassStatus::kCompleted);
    }
  }
}

TEST_F(LiveLinkTest, ACutNetworkTakesTheForceAwayAndGivesItBackByARamp) {
  test::write_text(definition(), slow() + "patience = 120\nramp = 0.4\n");
  start(1, {.delay = 0.005});
  ASSERT_TRUE(coupled(partial("learning"))) << said();
  relay_->cut(true);
  ASSERT_TRUE(learns_->reaches([&] {
    const auto all = rows(partial("learning"));
    return !all.empty() && (all.back().state & record::kLinked) == 0;
  })) << said();
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  relay_->cut(false);
  ASSERT_EQ(learns_->wait().status, 0) << said();
  ASSERT_EQ(teaches_->wait().status, 0) << said();
  expect_no_force_after_silence(file("learning"));
  const auto all = rows(file("learning"));
  bool lost = false;
  bool back = false;
  for (std::size_t i = 1; i < all.size(); ++i) {
    const bool was = (all[i - 1].state & record::kLinked) != 0;
    const bool is = (all[i].state & record::kLinked) != 0;
    lost = lost || (was && !is && all[i].heard > 0);
    if (lost && !was && is) {
      back = true;
      EXPECT_LT(all[i].coupling.norm(), 0.05) << "it begins with nothing";
    }
  }
  EXPECT_TRUE(lost);
  EXPECT_TRUE(back);
}

TEST_F(LiveLinkTest, AStopOnOneSideStopsBoth) {
  if (!LiveCommand::has_terminals()) {
    GTEST_SKIP() << "no pseudo-terminals here: /dev/pts is not mounted";
  }
  test::write_text(definition(), slow() + "patience = 20\n");
  port_ = test::free_port();
  teaches_ = std::make_unique<LiveCommand>(
      line("teaching", 1, "--keyboard --console --teach " + std::to_string(port_)), "",
      LiveCommand::Where::kTerminal);
  ASSERT_NE(teaches_->line_after("waiting at port"), "");
  relay_ = std::make_unique<test::NetworkRelay>(port_, test::RelayConditions{.delay = 0.02});
  learns_ = std::make_unique<LiveCommand>(
      line("learning", 1, "--learn-from 127.0.0.1:" + std::to_string(relay_->port())));
  ASSERT_NE(learns_->line_after("linked"), "");
  test::ConsolePerson person(teaches_->line_after("console: "));  // to see, not to ask
  ASSERT_TRUE(person.sees("instructions")) << said();
  teaches_->press(" ");
  ASSERT_TRUE(coupled(partial("learning"))) << said();
  teaches_->press("\x1b");
  ASSERT_TRUE(person.sees("stopped")) << said();
  teaches_->press("c");  // who stopped clears, for both, and begins again
  ASSERT_TRUE(person.sees("paused")) << said();
  teaches_->press(" ");
  ASSERT_EQ(learns_->wait().status, 0) << said();
  ASSERT_EQ(teaches_->wait().status, 0) << said();
  const record::SessionReader reader(file("learning"));
  EXPECT_EQ(reader.passes().front().status, record::PassStatus::kAborted);
  EXPECT_EQ(reader.passes().back().status, record::PassStatus::kCompleted);
  const auto samples = reader.samples(0, reader.sample_count());
  const auto all = rows(file("learning"));
  const auto stop = std::ranges::find_if(
      all, [](const LinkRow& row) { return (row.state & record::kPartnerStops) != 0; });
  ASSERT_NE(stop, all.end());
  EXPECT_EQ(samples[stop->sequence].force.norm(), 0.0) << "in the tick in which it was heard";
  EXPECT_GT(samples[stop->sequence - 1].force.norm(), 0.0);
  // The other side's own force was gone when it said so.
  const record::SessionReader own(file("teaching"));
  const auto there = rows(file("teaching"));
  const auto message = std::ranges::find(there, stop->heard, &LinkRow::sent);
  ASSERT_NE(message, there.end());
  EXPECT_EQ(own.samples(message->sequence, 1).front().force.norm(), 0.0);
}

/// Ten minutes each over the networks of the table in docs/algorithms/tutoring.md, where asked for;
/// else a trial over one of them. Each hand has half of its own world: with none of it, a hand that
/// presses has nothing but the spring of the law to rest on.
TEST_F(TimedLinkTest, EveryNetworkLeavesTheHandsPassive) {
  test::write_text(definition(),
                   test::brisk_text() + "\n[tutoring]\npatience = 20\nauthority = 0.5\n");
  const bool all = std::getenv("HAPTRIAL_EVERY_NETWORK") != nullptr;
  for (const double delay : all ? std::vector{0.0, 0.05, 0.2} : std::vector{0.05}) {
    for (const char* side : {"learning", "teaching"}) {
      std::filesystem::remove_all(out(side));
    }
    const int trials = all ? 72 : 1;
    start(trials,
          {.delay = delay, .jitter = 0.02, .loss = 0.05, .duplication = 0.02, .reordering = 0.05});
    ASSERT_EQ(learns_->wait().status, 0) << said();
    ASSERT_EQ(teaches_->wait().status, 0) << said();
    double given = 0.0;
    for (const char* side : {"learning", "teaching"}) {
      const Figures f = figures_of(file(side));
      const record::SessionReader reader(file(side));
      given += f.given;
      EXPECT_TRUE(record::check_session(reader).ok);
      EXPECT_EQ(f.dropped, 0u);
      EXPECT_LE(f.most_force, 12.0 + 1e-3) << "of the envelope";
      EXPECT_GT(f.least_energy, -0.01);
      EXPECT_NEAR(f.loss, 0.05, all ? 0.01 : 0.04);
      printf(
          "%s, %g ms: %.0f s, delay %.1f ms, lost %.2f %%, greatest force %.2f N, of the link "
          "%.2f N, least energy %.2f mJ, given %.4f J\n",
          side, 1e3 * delay, 1e-3 * static_cast<double>(reader.sample_count()), 1e3 * f.delay,
          1e2 * f.loss, f.most_force, f.most_coupling, 1e3 * f.least_energy, f.given);
    }
    EXPECT_LT(given, 0.02);
  }
}

}  // namespace
}  // namespace haptrial::experiments
