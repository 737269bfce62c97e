// A session that leads another one over a simulated network: what both files say of each other.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "analysis/tutoring/led_passes.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/partner_rows.h"
#include "tests/experiments/command.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

using record::LinkRow;
using test::run_command;
using testing::HasSubstr;

class TaughtTest : public testing::Test {
 protected:
  /// @returns the folder with the sessions
  std::string taught(const std::string& tutoring, const std::string& name,
                     const std::string& more = "") {
    const std::string file = (folder_ / "taught.toml").string();
    test::write_text(file, test::brisk_text() + "\n[tutoring]\n" + tutoring);
    const std::string out = (folder_ / name).string();
    const test::CommandResult r = run_command(
        "haptrial dry-run " + file + " --subjects 1 --trials 1 --taught --out " + out + " " + more);
    EXPECT_EQ(r.status, 0) << r.errors;
    return out;
  }

  test::TemporaryFolder folder_;
};

std::map<std::int64_t, const LinkRow*> by_number(const std::vector<LinkRow>& rows) {
  std::map<std::int64_t, const LinkRow*> all;
  for (const LinkRow& row : rows) {
    if (row.sent > 0) {
      all[row.sent] = &row;
    }
  }
  return all;
}

TEST_F(TaughtTest, TheHandIsLedByTheLawAndBothFilesAgree) {
  const std::string out =
      taught("felt_back = 0.0\npassivity = \"none\"\n[tutoring.channel]\ndelay = 0.02\n", "out");
  const record::SessionReader learns(out + "/S01.h5");
  const record::SessionReader teaches(out + "/teaching/S01.h5");
  EXPECT_TRUE(record::check_session(learns).ok);
  EXPECT_TRUE(record::check_session(teaches).ok);
  const auto rows = learns.rows<LinkRow>();
  const auto others = teaches.rows<LinkRow>();
  ASSERT_EQ(rows.size(), learns.sample_count());
  ASSERT_EQ(others.size(), teaches.sample_count());
  const auto sent = by_number(others);
  const auto own = learns.samples(0, learns.sample_count());
  const auto theirs = teaches.samples(0, teaches.sample_count());
  std::size_t led = 0;
  for (const LinkRow& row : rows) {
    if (row.heard == 0 || row.round_trip < 0.0) {
      continue;
    }
    // The message is the row of the other file that has its number, 20 ms before.
    const LinkRow& there = *sent.at(row.heard);
    ASSERT_EQ(row.sequence - there.sequence, 21u) << "the delay, and the tick in which it is read";
    ASSERT_NEAR(row.delay, 0.021, 1e-6);
    ASSERT_LT((row.position - theirs[there.sequence].position).norm(), 1e-6);
    if (row.lead > 1e-9 || (row.state & record::kLinkEngaged) == 0) {
      continue;
    }
    ++led;
    const record::Sample& hand = own[row.sequence];
    const Eigen::Vector3d law =
        row.force + 80.0 * (row.position - hand.position) + 2.0 * (row.velocity - hand.velocity);
    ASSERT_LT((law - row.coupling).norm(), 2e-4) << "tick " << row.sequence;
    ASSERT_LT((hand.force - row.coupling).norm(), 0.1)  // the guard may add its damper
        << "tick " << row.sequence;
  }
  EXPECT_GT(led, 500u);
  // The teacher feels nothing of the coupling.
  EXPECT_TRUE(std::ranges::all_of(others, [](const LinkRow& r) { return r.coupling.norm() == 0; }));
  EXPECT_THAT(learns.events(), testing::Contains(testing::Field(&record::EventRow::kind, "link")));
}

/// Nothing is given to a hand that no hand has given: each side's tank, and what goes over.
void expect_passive(const std::vector<LinkRow>& a, const std::vector<LinkRow>& b) {
  constexpr double kTick = 2e-3;  // what one tick on a spring may take too much [J]
  for (const auto* rows : {&a, &b}) {
    const auto least = std::ranges::min_element(*rows, {}, &LinkRow::energy);
    EXPECT_GE(least->energy, -kTick) << "tick " << least->sequence;
  }
  EXPECT_LE(a.back().energy_received, b.back().energy_sent + 1e-12);
  EXPECT_LE(b.back().energy_received, a.back().energy_sent + 1e-12);
  EXPECT_LE(a.back().energy_given + b.back().energy_given, 2.0 * kTick);
}

TEST_F(TaughtTest, OverABadNetworkNoHandGetsMoreEnergyThanHandsGave) {
  for (const char* delay : {"0.01", "0.05", "0.2"}) {
    const std::string out =
        taught(std::string("stiffness = 150\n[tutoring.channel]\nloss = 0.05\njitter = 0.02\n") +
                   "duplication = 0.02\nreordering = 0.05\ndelay = " + delay + "\n",
               std::string("out") + delay);
    const auto a = record::SessionReader(out + "/S01.h5").rows<LinkRow>();
    const auto b = record::SessionReader(out + "/teaching/S01.h5").rows<LinkRow>();
    expect_passive(a, b);
    const double share = a.back().lost / static_cast<double>(b.back().sent);
    EXPECT_GT(share, 0.035);
    EXPECT_LT(share, 0.1) << "with what was overtaken and is still under way";
    EXPECT_TRUE(std::ranges::any_of(a, [](const LinkRow& r) { return r.coupling.norm() > 0.05; }));
  }
}

TEST_F(TaughtTest, TheSameAgainIsTheSameToTheByte) {
  const std::string channel =
      "[tutoring.channel]\ndelay = 0.03\njitter = 0.01\nloss = 0.1\nreordering = 0.1\n";
  const std::string a = taught(channel, "a", "--jobs 1");
  const std::string b = taught(channel, "b", "--jobs 2");
  for (const char* file : {"/S01.h5", "/teaching/S01.h5"}) {
    const record::SessionReader first(a + file);
    const record::SessionReader second(b + file);
    const auto rows = first.rows<LinkRow>();
    const auto again = second.rows<LinkRow>();
    ASSERT_EQ(rows.size(), again.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      ASSERT_EQ(rows[i].heard, again[i].heard) << i;
      ASSERT_EQ(rows[i].coupling, again[i].coupling) << i;
      ASSERT_EQ(rows[i].energy_given, again[i].energy_given) << i;
    }
    const auto samples = first.samples(0, first.sample_count());
    const auto same = second.samples(0, second.sample_count());
    ASSERT_EQ(samples.size(), same.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      ASSERT_EQ(samples[i].position, same[i].position) << i;
      ASSERT_EQ(samples[i].force, same[i].force) << i;
    }
    const auto events = first.events();
    const auto same_events = second.events();
    ASSERT_EQ(events.size(), same_events.size());
    for (std::size_t i = 0; i < events.size(); ++i) {
      EXPECT_EQ(events[i].time_ns, same_events[i].time_ns);
      EXPECT_EQ(events[i].text, same_events[i].text);
    }
  }
}

TEST_F(TaughtTest, ALostNetworkEndsADryRunWithASentence) {
  const std::string file = (folder_ / "lost.toml").string();
  test::write_text(file, test::brisk_text() +
                             "\n[tutoring]\npatience = 1\n"
                             "[tutoring.channel]\nloss = 1.0\n");
  const std::string out = (folder_ / "lost").string();
  const test::CommandResult r =
      run_command("haptrial dry-run " + file + " --subjects 1 --trials 1 --taught --out " + out);
  EXPECT_EQ(r.status, 1);
  EXPECT_THAT(r.errors, HasSubstr("was not heard for"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

/// The delay that a trial had, as its ticks found it [s].
double found_delay(const record::SessionReader& reader, const record::PassRow& pass) {
  std::vector<double> delays;
  for (const LinkRow& row : reader.rows<LinkRow>()) {
    if (row.sequence >= pass.first_sample && row.sequence <= pass.last_sample && row.delay > 0.0) {
      delays.push_back(row.delay);
    }
  }
  const auto middle = delays.begin() + static_cast<std::ptrdiff_t>(delays.size() / 2);
  std::ranges::nth_element(delays, middle);
  return *middle;
}

/// Root mean square between the hands while they were coupled: the partner's place from the
/// partner's own file, at the tick whose message was heard [m].
double distance_from_both_files(const record::SessionReader& reader,
                                const record::SessionReader& partner, const record::PassRow& pass) {
  const std::vector<LinkRow> theirs = partner.rows<LinkRow>();
  const auto numbered = by_number(theirs);
  double squares = 0.0;
  int ticks = 0;
  for (const LinkRow& row : reader.rows<LinkRow>()) {
    const bool within = row.sequence >= pass.first_sample && row.sequence <= pass.last_sample;
    if (within && (row.state & record::kLinkEngaged) != 0) {
      const std::uint64_t tick = numbered.at(row.heard)->sequence;
      squares +=
          (reader.samples(row.sequence, 1)[0].position - partner.samples(tick, 1)[0].position)
              .squaredNorm();
      ++ticks;
    }
  }
  return std::sqrt(squares / ticks);
}

TEST_F(TaughtTest, NetworksAreAConditionOfTheTrials) {
  const std::string file = (folder_ / "networks.toml").string();
  test::write_text(file, test::brisk_text() +
                             "\n[[tutoring.networks]]\nname = \"near\"\n"
                             "[[tutoring.networks]]\nname = \"far\"\ndelay = 0.1\nloss = 0.02\n");
  const std::string out = (folder_ / "networks").string();
  const test::CommandResult r =
      run_command("haptrial dry-run " + file + " --subjects 1 --trials 2 --taught --out " + out);
  ASSERT_EQ(r.status, 0) << r.errors;
  const record::SessionReader learns(out + "/S01.h5");
  const record::SessionReader teaches(out + "/teaching/S01.h5");
  const auto own = learns.rows<record::NetworkRow>();
  const auto other = teaches.rows<record::NetworkRow>();
  const auto passes = learns.passes();
  ASSERT_EQ(own.size(), passes.size());
  ASSERT_EQ(other.size(), own.size());
  std::map<std::string, int> trials;
  for (std::size_t i = 0; i < own.size(); ++i) {
    EXPECT_EQ(own[i].pass, static_cast<std::int32_t>(i));
    EXPECT_EQ(own[i].name, other[i].name);
    EXPECT_EQ(own[i].delay, own[i].name == "far" ? 0.1 : 0.0);
    EXPECT_EQ(own[i].loss, own[i].name == "far" ? 0.02 : 0.0);
    EXPECT_NEAR(found_delay(learns, passes[i]), own[i].delay, 2e-3) << own[i].name;
    ++trials[own[i].name];
  }
  EXPECT_EQ(trials["near"], trials["far"]) << "each once in two trials";

  const test::CommandResult analysed = run_command("haptrial analyze " + out);
  EXPECT_EQ(analysed.status, 0) << analysed.errors;
  EXPECT_THAT(analysed.output, HasSubstr("/link.html"));
  for (const analysis::link::LedPass& led : analysis::link::led_passes(learns)) {
    EXPECT_EQ(led.set_delay, led.network == "far" ? 0.1 : 0.0);
    EXPECT_NEAR(led.delay, led.set_delay, 2e-3);
    EXPECT_NEAR(led.lost, led.network == "far" ? 0.02 : 0.0, 0.01);
    EXPECT_NEAR(led.apart, distance_from_both_files(learns, teaches, led.pass), 1e-5);
  }
  EXPECT_EQ(analysis::link::led_passes(learns).size(), 2u) << "the training pass of each trial";
  EXPECT_TRUE(std::filesystem::exists(out + "/link.csv"));
}

TEST_F(TaughtTest, StiffCouplingsWithoutControlAreWarnedOf) {
  const std::string file = (folder_ / "stiff.toml").string();
  const auto warned = [&](const std::string& tutoring) {
    test::write_text(file, test::brisk_text() + "\n[tutoring]\n" + tutoring);
    return run_command("haptrial validate " + file).output;
  };
  // b = 15 of the hand and 2 of the law; 100 ms there and back: 17 / 0.1005 = 169 N/m.
  const std::string far = "\n[tutoring.channel]\ndelay = 0.05\n";
  EXPECT_THAT(warned("passivity = \"none\"\nstiffness = 170" + far), HasSubstr("about 169 N/m on"));
  EXPECT_THAT(warned("passivity = \"none\"\nstiffness = 168" + far),
              testing::Not(HasSubstr("swing up")));
  EXPECT_THAT(warned("stiffness = 500" + far), testing::Not(HasSubstr("swing up")));
}

/// Version 0.2 could also couple hands by waves: its sessions are analysed, but none begins.
TEST_F(TaughtTest, SessionsThatWavesLedCanStillBeAnalysed) {
  const std::string out = taught("passivity = \"tank\"\n[tutoring.channel]\ndelay = 0.02\n", "out");
  const std::string edit =
      "import h5py, sys\n"
      "with h5py.File(sys.argv[1], 'r+') as f:\n"
      "    f.attrs['definition'] = f.attrs['definition'].replace('\"tank\"', '\"waves\"')\n";
  test::write_text((folder_ / "edit.py").string(), edit);
  const test::CommandResult edited =
      run_command("/usr/bin/python3 '" + (folder_ / "edit.py").string() + "' " + out + "/S01.h5");
  ASSERT_EQ(edited.status, 0) << edited.errors;
  const test::CommandResult analysed = run_command("haptrial analyze " + out);
  EXPECT_EQ(analysed.status, 0) << analysed.errors;

  const std::string file = (folder_ / "waves.toml").string();
  test::write_text(file, test::brisk_text() + "\n[tutoring]\npassivity = \"waves\"\n");
  const test::CommandResult refused = run_command("haptrial validate " + file);
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("tutoring.passivity is 'waves'"));
  EXPECT_THAT(refused.errors, HasSubstr("allowed: tank, none"));
}

}  // namespace
}  // namespace haptrial::experiments
