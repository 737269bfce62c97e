#include "core/channel/channel_kinds.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/base/random.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/channel_run.h"
#include "tests/support/message_of.h"
#include "tests/support/stand_in_rdt.h"

namespace haptrial::channel {
namespace {

using test::ChannelRun;
using test::RdtRecord;
using test::StandInPage;
using test::StandInRdt;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string rdt_keys(const StandInRdt& sensor, const std::string& more = "") {
  return fmt::format(
      "[channels.sensor]\nkind = 'rdt'\nhost = '127.0.0.1'\nport = {}\nrate = 1000.0\n"
      "counts_per_force = 1000000.0\ncounts_per_torque = 250000.0\n{}",
      sensor.port(), more);
}

TEST(RdtChannelTest, ValuesAreRightToTheLastCount) {
  StandInRdt sensor;
  ChannelRun run(rdt_keys(sensor));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  RandomStream random(3, "counts");
  std::vector<RdtRecord> sent{{1}};
  for (std::uint32_t i = 2; i <= 300; ++i) {
    RdtRecord record{i};
    for (std::int32_t& counts : record.counts) {
      counts = static_cast<std::int32_t>(random.uniform() * 4294967295.0 - 2147483648.0);
    }
    sent.push_back(record);
  }
  sent[1].counts = {std::numeric_limits<std::int32_t>::min(),
                    std::numeric_limits<std::int32_t>::max(),
                    -1,
                    1,
                    0,
                    -256};
  for (std::size_t i = 1; i < sent.size(); ++i) {
    sensor.send(sent[i]);
    run.rows(i + 1);
  }
  const auto& rows = run.rows(sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_EQ(rows[i].sample, i);
    EXPECT_DOUBLE_EQ(rows[i].device_time, 1e-3 * static_cast<double>(i + 1));
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_EQ(std::llround(rows[i].values[k] * (k < 3 ? 1e6 : 2.5e5)), sent[i].counts[k]);
    }
  }
  EXPECT_TRUE(run.of_kind(Incident::kGap).empty());
}

TEST(RdtChannelTest, MissingRecordsAreCountedAndRepeatedOrLateOnesLeftOut) {
  StandInRdt sensor;
  ChannelRun run(rdt_keys(sensor));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  for (const std::uint32_t sequence : {2u, 3u, 7u, 7u, 5u, 8u}) {
    sensor.send(RdtRecord{sequence});
  }
  const auto& rows = run.rows(5);
  ASSERT_EQ(rows.size(), 5u);
  const std::vector<std::uint64_t> samples{rows[0].sample, rows[1].sample, rows[2].sample,
                                           rows[3].sample, rows[4].sample};
  EXPECT_THAT(samples, ElementsAre(0, 1, 2, 6, 7));
  EXPECT_DOUBLE_EQ(rows[3].device_time, 7e-3);
  ASSERT_EQ(run.incidents(Incident::kGap, 1).size(), 1u);
  EXPECT_EQ(run.of_kind(Incident::kGap)[0].amount, 3.0);
  ASSERT_EQ(run.incidents(Incident::kRepeated, 2).size(), 2u);
  EXPECT_EQ(run.of_kind(Incident::kRepeated)[0].amount, 1.0);
}

TEST(RdtChannelTest, DatagramsThatHoldNoRecordsAreCounted) {
  StandInRdt sensor;
  ChannelRun run(rdt_keys(sensor, "mode = 'buffered'"));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  const std::array<char, 100> rubbish{};
  sensor.send_bytes(rubbish.data(), 35);
  sensor.send_bytes(rubbish.data(), 0);
  sensor.send_bytes(rubbish.data(), 100);
  const std::vector<RdtRecord> together{{2}, {3}, {4}};
  sensor.send(together);
  run.rows(4);
  const auto malformed = run.incidents(Incident::kMalformed, 3);
  ASSERT_EQ(malformed.size(), 3u);
  EXPECT_EQ(malformed[0].amount, 35.0);
  EXPECT_EQ(malformed[1].amount, 0.0);
  EXPECT_EQ(malformed[2].amount, 100.0);
  EXPECT_THAT(sensor.commands(), ElementsAre(3));
}

TEST(RdtChannelTest, TheCounterOfTheSensorMayBeginAgain) {
  StandInRdt sensor(0xFFFFFFFEu);
  ChannelRun run(rdt_keys(sensor));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  for (const std::uint32_t sequence : {0xFFFFFFFFu, 0u, 1u}) {
    sensor.send(RdtRecord{sequence});
  }
  const auto& rows = run.rows(4);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(rows[i].sample, i);
    EXPECT_DOUBLE_EQ(rows[i].device_time, 1e-3 * static_cast<double>(i + 1));
  }
  EXPECT_TRUE(run.of_kind(Incident::kGap).empty());
  EXPECT_TRUE(run.of_kind(Incident::kRepeated).empty());
}

TEST(RdtChannelTest, AStatusIsSaidOnceWithItsMeaning) {
  StandInRdt sensor;
  ChannelRun run(rdt_keys(sensor));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  std::uint32_t sequence = 2;
  for (const std::uint32_t status : {0x80020000u, 0x80020000u, 0x80000004u, 0xFFFFFFFFu, 0u}) {
    sensor.send(RdtRecord{sequence++, status});
  }
  run.rows(6);
  const auto said = run.incidents(Incident::kStatus, 4);
  ASSERT_EQ(said.size(), 4u);
  EXPECT_EQ(said[0].amount, 0x80020000u);
  EXPECT_EQ(said[0].text, "0x80020000: error, saturated, or an error of the A/D converter");
  EXPECT_EQ(said[1].text, "0x80000004: error, temperature out of range (Axia: broken strain gage)");
  EXPECT_LE(said[2].text.size(), 256u);
  EXPECT_THAT(said[2].text, HasSubstr(", ..."));
  EXPECT_EQ(said[3].text, "0x00000000: no error");
}

TEST(RdtChannelTest, ASensorThatStopsIsAskedAnewWithoutABias) {
  StandInRdt sensor;
  ChannelRun run(rdt_keys(sensor, "bias = true"));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  run.rows(1);
  run.set_now(3.0);  // beyond the patience of 1 s
  EXPECT_THAT(run.incidents(Incident::kLost, 1)[0].text, HasSubstr("no data come"));
  EXPECT_FALSE(run.channel().seen().live);
  run.incidents(Incident::kBack, 1);  // the stand-in answers when it is asked again
  EXPECT_TRUE(run.channel().seen().live);
  EXPECT_EQ(run.rows(2)[1].sample, 1u);
  run.close();
  test::wait_until([&] { return sensor.commands().size() == 5; });
  EXPECT_THAT(sensor.commands(), ElementsAre(0x42, 2, 0, 2, 0)) << "the last stops it";
}

TEST(RdtChannelTest, PlantedTimesAreWithinTheStatedUncertainty) {
  StandInRdt sensor;
  ChannelRun run(rdt_keys(sensor, "mode = 'buffered'"));
  RandomStream random(11, "way");
  const auto truth = [](std::uint32_t sequence) {
    return 1e-3 * (sequence - 1.0) * (1.0 + 100e-6) - 0.3e-3;
  };
  ASSERT_EQ(run.channel().wait_until_open(), "");
  run.rows(1);
  constexpr std::uint32_t kLast = 20001;
  double came_before = 0.0;
  for (std::uint32_t i = 2; i + 3 <= kLast; i += 4) {  // four records in a datagram
    const double came = truth(i + 3) + 0.3e-3 - 0.4e-3 * std::log(1.0 - random.uniform());
    came_before = std::max(came, came_before);
    run.set_now(came_before);
    sensor.send(std::vector<RdtRecord>{{i}, {i + 1}, {i + 2}, {i + 3}});
    run.rows(i + 3);
  }
  const auto& rows = run.rows(kLast);
  ASSERT_EQ(rows.size(), kLast);
  std::vector<double> truths;
  for (std::uint32_t i = 1; i <= kLast; ++i) {
    truths.push_back(truth(i));
  }
  EXPECT_GT(test::share_within(rows, truths), 0.95);
  EXPECT_TRUE(run.of_kind(Incident::kClockStep).empty());
}

TEST(RdtChannelTest, CountsAndUnitsComeFromThePageOfTheSensor) {
  StandInRdt sensor;
  const StandInPage page(
      "<?xml version=\"1.0\"?><netft><comrdtrate>1000</comrdtrate><cfgcpf>1000</cfgcpf>"
      "<cfgcpt>500</cfgcpt><scfgfu>lbf</scfgfu><scfgtu>lbf-in</scfgtu></netft>");
  ChannelRun run(
      fmt::format("[channels.sensor]\nkind = 'rdt'\nhost = '127.0.0.1'\nport = {}\nhttp_port = "
                  "{}\nrate = 1000.0",
                  sensor.port(), page.port()));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  sensor.send(RdtRecord{2, 0, {1000, -2000, 0, 500, -1000, 0}});
  const auto& values = run.rows(2)[1].values;
  constexpr double kPound = 0.45359237 * 9.80665;  // [N]
  EXPECT_NEAR(values[0], kPound, 1e-12);
  EXPECT_NEAR(values[1], -2.0 * kPound, 1e-12);
  EXPECT_NEAR(values[3], kPound * 0.0254, 1e-12);
  EXPECT_NEAR(values[4], -2.0 * kPound * 0.0254, 1e-12);
}

TEST(RdtChannelTest, APageThatDoesNotFitGetsASentence) {
  StandInRdt sensor;
  const auto why = [&](const std::string& body) {
    const StandInPage page(body);
    ChannelRun run(
        fmt::format("[channels.sensor]\nkind = 'rdt'\nhost = '127.0.0.1'\nport = {}\nhttp_port = "
                    "{}\nrate = 1000.0",
                    sensor.port(), page.port()));
    return run.channel().wait_until_open();
  };
  EXPECT_THAT(why("<netft><cfgcpf>1</cfgcpf></netft>"), HasSubstr("state counts_per_force"));
  EXPECT_THAT(why("<cfgcpf>1</cfgcpf><cfgcpt>1</cfgcpt><scfgfu>stone</scfgfu><scfgtu>Nm</scfgtu>"),
              HasSubstr("'stone'"));
  EXPECT_THAT(why("<comrdtrate>7000</comrdtrate><cfgcpf>1</cfgcpf><cfgcpt>1</cfgcpt>"
                  "<scfgfu>N</scfgfu><scfgtu>Nm</scfgtu>"),
              HasSubstr("7000 records a second, and rate is 1000"));
  ChannelRun none(
      fmt::format("[channels.sensor]\nkind = 'rdt'\nhost = '127.0.0.1'\nport = {}\nhttp_port = "
                  "{}\nrate = 1000.0",
                  sensor.port(), test::free_port()));
  EXPECT_THAT(none.channel().wait_until_open(), HasSubstr("no such page"));
}

TEST(RdtChannelTest, ASensorThatIsNotThereGetsASentence) {
  StandInRdt sensor;
  sensor.set_answering(false);
  ChannelRun silent(rdt_keys(sensor));
  EXPECT_EQ(silent.channel().wait_until_open(),
            fmt::format("RDT sensor at 127.0.0.1:{}: sends no records", sensor.port()));
  ChannelRun unknown(
      "[channels.sensor]\nkind = 'rdt'\nhost = 'no.such.invalid'\nrate = 1000.0\n"
      "counts_per_force = 1.0\ncounts_per_torque = 1.0");
  EXPECT_THAT(unknown.channel().wait_until_open(),
              HasSubstr("RDT sensor at no.such.invalid:49152: the address"));
}

TEST(RdtChannelTest, MistakesInADefinitionGetASentence) {
  const auto problem = [](const std::string& keys) {
    return test::message_of([&] { test::channels_of("[channels.sensor]\nkind = 'rdt'\n" + keys); });
  };
  EXPECT_THAT(problem("rate = 1000.0"), HasSubstr("channels.sensor.host"));
  EXPECT_THAT(problem("host = 'a'"), HasSubstr("channels.sensor.rate"));
  EXPECT_THAT(problem("host = ''\nrate = 1.0"), HasSubstr("channels.sensor.host is an empty text"));
  EXPECT_THAT(problem("host = 'a'\nrate = -1.0"), HasSubstr("rate is -1"));
  EXPECT_THAT(problem("host = 'a'\nrate = 1.0\nport = 70000"), HasSubstr("port is 70000"));
  EXPECT_THAT(problem("host = 'a'\nrate = 1.0\nmode = 'fast'"), HasSubstr("realtime, buffered"));
  EXPECT_THAT(problem("host = 'a'\nrate = 1.0\ncounts_per_force = 1.0"),
              HasSubstr("needs the other one"));
}

/// Counts samples without keeping them.
class CountingInbox final : public ChannelInbox {
 public:
  void take(const InstrumentSample& /*sample*/) override { ++samples; }
  void note(Incident /*what*/, double /*amount*/, const std::string& /*text*/,
            std::optional<std::int64_t> /*time_ns*/) override {}
  std::int64_t now() const override { return 0; }
  std::size_t samples{0};
};

TEST(RdtChannelTest, ReadingDoesNotAllocate) {
  StandInRdt sensor;
  const auto source = test::channels_of(rdt_keys(sensor)).at(0).plan.open();
  CountingInbox inbox;
  const std::chrono::milliseconds patience{20};
  source->read(inbox, patience);
  for (std::uint32_t i = 2; i <= 100; ++i) {
    sensor.send(RdtRecord{i});
  }
  const test::AllocationGuard guard;
  while (inbox.samples < 100) {
    source->read(inbox, patience);
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace haptrial::channel
