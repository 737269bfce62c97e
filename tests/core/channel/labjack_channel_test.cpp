#include "core/channel/channel_kinds.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <vector>

#include "core/base/random.h"
#include "tests/support/channel_run.h"
#include "tests/support/message_of.h"
#include "tests/support/stand_in_labjack.h"

namespace haptrial::channel {
namespace {

using test::ChannelRun;
using test::StandInLabJack;
using ::testing::HasSubstr;
using Mistake = StandInLabJack::Mistake;

constexpr const char* kInputs = R"(
inputs.grip = { input = 2, unit = "N", scale = 120.0, offset = -3.0 }
inputs.light = { input = 0 }
inputs.shaft = { input = 3, unit = "deg", scale = -72.0 }
inputs.far = { input = 12 }
)";

std::string labjack_keys(const StandInLabJack& instrument, const std::string& inputs = kInputs) {
  return fmt::format(
      "[channels.sensor]\nkind = 'labjack'\nhost = '127.0.0.1'\nport = {}\nrate = 500.0\n{}",
      instrument.port(), inputs);
}

TEST(LabJackChannelTest, QuantitiesAreThoseOfTheirInputs) {
  StandInLabJack instrument;
  instrument.set_voltage(0, 1.25F);
  instrument.set_voltage(2, -0.1F);
  instrument.set_voltage(3, 3.3F);
  instrument.set_voltage(12, 9.9999F);
  ChannelRun run(labjack_keys(instrument));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  const auto& quantities = run.options().plan.quantities;
  ASSERT_EQ(quantities.size(), 4u);
  EXPECT_EQ(quantities[0].name, "grip");
  EXPECT_EQ(quantities[0].unit, "N");
  EXPECT_EQ(quantities[1].unit, "V");
  const auto& values = run.rows(1)[0].values;
  EXPECT_EQ(values[0], 120.0 * double{-0.1F} - 3.0);
  EXPECT_EQ(values[1], 1.25);
  EXPECT_EQ(values[2], -72.0 * double{3.3F});
  EXPECT_EQ(values[3], double{9.9999F});
  EXPECT_TRUE(std::isnan(values[4]));
  EXPECT_TRUE(std::isnan(run.rows(1)[0].device_time));
}

TEST(LabJackChannelTest, AnInputWithoutAReadingIsSaidOnce) {
  StandInLabJack instrument;
  instrument.set_voltage(2, -9999.0F);  // which stands for an error
  ChannelRun run(labjack_keys(instrument));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  EXPECT_TRUE(std::isnan(run.rows(5)[4].values[0]));
  EXPECT_EQ(run.rows(5)[4].values[1], 0.0);
  instrument.set_voltage(0, std::numeric_limits<float>::quiet_NaN());
  run.incidents(Incident::kStatus, 2);
  instrument.set_voltage(2, 1.0F);
  instrument.set_voltage(0, 1.0F);
  test::wait_until([&] { return run.of_kind(Incident::kStatus).back().amount == 0.0; });
  const auto said = run.of_kind(Incident::kStatus);
  EXPECT_EQ(said[0].text, "no reading of AIN2");
  EXPECT_EQ(said[1].text, "no reading of AIN2, AIN0");
  EXPECT_EQ(said[1].amount, 2.0);
  EXPECT_EQ(said.back().text, "all inputs have a reading");
}

TEST(LabJackChannelTest, AnAnswerThatComesTwiceIsLeftOut) {
  StandInLabJack instrument;
  ChannelRun run(labjack_keys(instrument));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  run.rows(2);
  instrument.set_mistake(Mistake::kTwice);
  EXPECT_EQ(run.incidents(Incident::kRepeated, 1)[0].amount, 1.0);
  const std::size_t count = run.rows(0).size();
  const auto& rows = run.rows(count + 5);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].sample, i);
  }
  EXPECT_TRUE(run.of_kind(Incident::kLost).empty());
}

TEST(LabJackChannelTest, AnswersThatAreNoneEndTheConnectionWhichIsMadeAnew) {
  for (const Mistake mistake : {Mistake::kRubbish, Mistake::kShort, Mistake::kHangUp}) {
    StandInLabJack instrument;
    ChannelRun run(labjack_keys(instrument));
    ASSERT_EQ(run.channel().wait_until_open(), "");
    run.rows(2);
    instrument.set_mistake(mistake);
    EXPECT_THAT(run.incidents(Incident::kLost, 1)[0].text,
                HasSubstr(mistake == Mistake::kHangUp ? "closed the connection"
                                                      : "sends what is no answer of Modbus"));
    run.incidents(Incident::kBack, 1);
    const auto malformed = run.of_kind(Incident::kMalformed);
    if (mistake == Mistake::kHangUp) {
      EXPECT_TRUE(malformed.empty());
    } else {
      ASSERT_EQ(malformed.size(), 1u);
      EXPECT_GT(malformed[0].amount, 0.0);
    }
    EXPECT_TRUE(run.channel().seen().live);
  }
}

TEST(LabJackChannelTest, AnInstrumentThatStopsComesBack) {
  StandInLabJack instrument;
  ChannelRun run(labjack_keys(instrument));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  const std::size_t before = run.rows(2).size();
  instrument.set_listening(false);
  run.incidents(Incident::kLost, 1);
  EXPECT_FALSE(run.channel().seen().live);
  instrument.set_listening(true);
  run.incidents(Incident::kBack, 1);
  const auto& rows = run.rows(before + 20);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].sample, i);
  }
}

TEST(LabJackChannelTest, AnInstrumentThatDoesNotAnswerIsLost) {
  StandInLabJack instrument;
  ChannelRun run(labjack_keys(instrument));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  run.rows(2);
  instrument.set_mistake(Mistake::kSilence);
  EXPECT_THAT(run.incidents(Incident::kLost, 1)[0].text, HasSubstr("does not answer"));
  instrument.set_mistake(Mistake::kNone);
  run.incidents(Incident::kBack, 1);
}

TEST(LabJackChannelTest, PlantedTimesAreWithinTheStatedUncertainty) {
  std::optional<StandInLabJack> stand_in(std::in_place);
  StandInLabJack& instrument = *stand_in;
  ChannelRun run(labjack_keys(instrument, "inputs.number = { input = 2 }"));
  ASSERT_EQ(run.channel().wait_until_open(), "");
  RandomStream random(17, "way");
  const auto pass = [&](double mean) {
    run.set_now(run.now() - mean * std::log(1.0 - random.uniform()));
  };
  std::mutex mutex;
  std::vector<double> truths{0.0};  // of the readings by the number that they give; 0: none
  const auto before = [&] {
    pass(1e-3);  // the request is on its way
    const std::lock_guard lock(mutex);
    instrument.set_voltage(2, static_cast<float>(truths.size()));
    truths.push_back(run.now());
  };
  instrument.set_clock(before, [&] { pass(0.5e-3); });
  std::vector<ChannelRow> rows;
  for (std::size_t wanted = 500; rows.size() < 500; ++wanted) {
    rows = run.rows(wanted);
    std::erase_if(rows, [](const ChannelRow& row) { return row.values[0] == 0.0; });
  }
  run.close();
  stand_in.reset();  // nothing is planted any more
  std::vector<double> planted;
  for (const ChannelRow& row : rows) {
    planted.push_back(truths.at(static_cast<std::size_t>(row.values[0])));
  }
  EXPECT_GT(test::share_within(rows, planted), 0.95);
}

TEST(LabJackChannelTest, AnInstrumentThatIsNotThereGetsASentence) {
  StandInLabJack instrument;
  instrument.set_inputs(12);  // a T4
  ChannelRun few(labjack_keys(instrument));
  EXPECT_EQ(few.channel().wait_until_open(),
            fmt::format("LabJack at 127.0.0.1:{}: cannot read AIN12 (exception 2: no such input)",
                        instrument.port()));
  ChannelRun none(
      fmt::format("[channels.sensor]\nkind = 'labjack'\nhost = '127.0.0.1'\nport = {}\n"
                  "inputs.grip.input = 2\n",
                  test::free_port()));
  EXPECT_THAT(none.channel().wait_until_open(), HasSubstr("cannot be reached"));
}

TEST(LabJackChannelTest, MistakesInADefinitionGetASentence) {
  const auto problem = [](const std::string& keys) {
    return test::message_of(
        [&] { test::channels_of("[channels.sensor]\nkind = 'labjack'\n" + keys); });
  };
  EXPECT_THAT(problem("inputs.a.input = 1"), HasSubstr("channels.sensor.host"));
  EXPECT_THAT(problem("host = 'a'"), HasSubstr("channels.sensor.inputs"));
  EXPECT_THAT(problem("host = 'a'\ninputs = {}"), HasSubstr("0 quantities"));
  EXPECT_THAT(problem("host = 'a'\ninputs.a = {}"), HasSubstr("channels.sensor.inputs.a.input"));
  EXPECT_THAT(problem("host = 'a'\ninputs.a.input = 255"), HasSubstr("input is 255"));
  EXPECT_THAT(problem("host = 'a'\ninputs.'a b'.input = 2"), HasSubstr("'a b'"));
  EXPECT_THAT(problem("host = 'a'\nrate = 5000.0\ninputs.a.input = 2"), HasSubstr("rate is 5000"));
  std::string many = "host = 'a'\n";
  for (std::size_t i = 0; i < kMostQuantities + 1; ++i) {
    many += fmt::format("inputs.a{0}.input = {0}\n", i);
  }
  EXPECT_THAT(problem(many), HasSubstr("65 quantities"));
}

}  // namespace
}  // namespace haptrial::channel
