#include "core/channel/channel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>

#include "core/channel/channel_set.h"
#include "core/record/rows/common_tables.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/message_of.h"
#include "tests/support/scripted_channel.h"
#include "tests/support/wait.h"

namespace haptrial::channel::channel_test {
namespace {

using test::message_of;
using test::ScriptedInstrument;
using test::wait_until;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

/// The tests' own kind; each test plays an instrument of its own by it.
std::shared_ptr<ScriptedInstrument>& played() {
  static std::shared_ptr<ScriptedInstrument> instrument;
  return instrument;
}

std::shared_ptr<ScriptedInstrument> play() {
  static const bool added = [] {
    const auto first = std::make_shared<ScriptedInstrument>();
    ChannelKind kind = test::scripted_kind(first);
    kind.read = [](Table& table) { return test::scripted_kind(played()).read(table); };
    add_kind_of_channel(kind);
    return true;
  }();
  static_cast<void>(added);
  played() = std::make_shared<ScriptedInstrument>();
  return played();
}

std::vector<ChannelOptions> read(const std::string& text) {
  Table root = Table::parse(text, "lab.toml");
  std::vector<ChannelOptions> channels = read_channels(root);
  root.finish();
  return channels;
}

const std::string kGrip =
    "[channels.grip]\nkind = \"scripted\"\nquantities = { force = \"N\", angle = \"1\" }\n";

/// Rows that a set has given so far.
struct Kept {
  std::vector<ChannelRow> rows;
  std::vector<IncidentRow> incidents;

  void take_from(ChannelSet& set) {
    set.collect(0, [this](const record::Rows& batch) {
      const auto more = batch.as<IncidentRow>();
      incidents.insert(incidents.end(), more.begin(), more.end());
      if (more.empty()) {
        const auto* first = static_cast<const ChannelRow*>(batch.data);
        rows.insert(rows.end(), first, first + batch.count);
      }
    });
  }
  bool has(Incident what) const {
    return std::any_of(incidents.begin(), incidents.end(),
                       [&](const IncidentRow& row) { return row.what == what; });
  }
};

TEST(ChannelTest, SamplesComeWithTheirNumbersAndTheNewestReachesATick) {
  const auto instrument = play();
  ChannelSet set(read(kGrip), {}, true);
  std::atomic<std::int64_t> now{5'000'000};
  EXPECT_THAT(set.start([&] { return now.load(); }, {100}), IsEmpty());
  set.begin();
  set.take(0);
  EXPECT_TRUE(std::isnan(set.values()[0])) << "nothing has come yet";
  instrument->give({{1.5, 2.5}});
  instrument->give({{1.75, 3.5}, std::numeric_limits<double>::quiet_NaN(), 3});
  Kept kept;
  wait_until([&] {
    kept.take_from(set);
    return kept.rows.size() == 2;
  });
  EXPECT_EQ(kept.rows[0].sample, 100u);
  EXPECT_EQ(kept.rows[1].sample, 104u) << "three were lost on the way";
  EXPECT_EQ(kept.rows[0].received_ns, 5'000'000);
  EXPECT_EQ(kept.rows[1].values[1], 3.5);
  EXPECT_TRUE(kept.has(Incident::kOpened));
  EXPECT_TRUE(kept.has(Incident::kGap));
  wait_until([&] {
    set.take(0);
    return set.values()[0] == 1.75;
  });
  const test::AllocationGuard guard;
  set.take(1);
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_EQ(set.alarm(), Alarm::kNone);
}

TEST(ChannelTest, SamplesFromBeforeTheFirstTickAreLeftOut) {
  const auto instrument = play();
  ChannelSet set(read(kGrip), {}, true);
  std::atomic<std::int64_t> now{0};
  EXPECT_THAT(set.start([&] { return now.load(); }, {}), IsEmpty());
  instrument->give({{1.0, 1.0}});
  wait_until([&] { return instrument->is_idle(); });
  now = 1'000'000;
  set.begin();
  instrument->give({{2.0, 1.0}});
  Kept kept;
  wait_until([&] {
    kept.take_from(set);
    return !kept.rows.empty();
  });
  EXPECT_EQ(kept.rows[0].values[0], 2.0);
  EXPECT_EQ(kept.rows[0].sample, 0u);
  EXPECT_EQ(kept.rows[0].received_ns, 1'000'000);
}

TEST(ChannelTest, ALostInstrumentIsOpenedAnewAndAnAlarmWhereItIsNeeded) {
  const auto instrument = play();
  ChannelSet set(read(kGrip + "required = true\n"), {}, true);
  std::atomic<std::int64_t> now{1};
  EXPECT_THAT(set.start([&] { return now.load(); }, {}), IsEmpty());
  set.begin();
  instrument->give({{1.0, 1.0}});
  wait_until([&] {
    set.take(0);
    return set.alarm() == Alarm::kNone;
  });
  instrument->give({.failure = "the plug was pulled"});
  wait_until([&] {
    set.take(0);
    return set.alarm() == Alarm::kLost;
  });
  EXPECT_STREQ(set.sentence(), "channel grip is lost");
  EXPECT_TRUE(std::isnan(set.values()[0])) << "an old value is none";
  now = 2'000'000'001;
  instrument->give({{2.0, 1.0}});
  wait_until([&] {
    set.take(0);
    return set.alarm() == Alarm::kNone;
  });
  EXPECT_EQ(set.values()[0], 2.0);
  Kept kept;
  wait_until([&] {
    kept.take_from(set);
    return kept.has(Incident::kBack);
  });
  EXPECT_THAT(set.take_news(),
              ElementsAre(HasSubstr("the plug was pulled"), HasSubstr("grip is back after 2.0 s")));
}

TEST(ChannelTest, AFaultThatAnInstrumentStatesIsNews) {
  const auto instrument = play();
  ChannelSet set(read(kGrip), {}, true);
  EXPECT_THAT(set.start([] { return std::int64_t{1}; }, {}), IsEmpty());
  set.begin();
  instrument->give({.fault = "the battery is low"});
  Kept kept;
  wait_until([&] {
    kept.take_from(set);
    return kept.has(Incident::kStatus);
  });
  EXPECT_THAT(set.take_news(), ElementsAre("channel grip: the battery is low"));
}

TEST(ChannelTest, AnOpenInstrumentIsLostOnlyIfItsFirstSampleDoesNotComeInTime) {
  const auto instrument = play();
  ChannelSet set(read(kGrip + "required = true\npatience = 0.1\n"), {}, true);
  std::atomic<std::int64_t> now{0};
  set.start([&] { return now.load(); }, {});
  set.take(0);
  EXPECT_EQ(set.alarm(), Alarm::kNone) << "the session's clock stands";
  set.begin();
  wait_until([&] { return instrument->is_idle(); });
  set.take(0);
  EXPECT_EQ(set.alarm(), Alarm::kNone) << "no sample has come yet";
  now = 200'000'000;
  wait_until([&] {
    set.take(0);
    return set.alarm() == Alarm::kLost;
  });
}

TEST(ChannelTest, SilenceIsALoss) {
  const auto instrument = play();
  ChannelSet set(read(kGrip + "patience = 0.1\n"), {}, true);
  std::atomic<std::int64_t> now{0};
  set.start([&] { return now.load(); }, {});
  set.begin();
  instrument->give({{1.0, 1.0}});
  Kept kept;
  wait_until([&] {
    kept.take_from(set);
    return kept.rows.size() == 1;
  });
  EXPECT_FALSE(kept.has(Incident::kLost));
  now = 200'000'000;
  wait_until([&] {
    kept.take_from(set);
    return kept.has(Incident::kLost);
  });
}

TEST(ChannelTest, AMeasuredValueBeyondItsLimitIsAnAlarm) {
  const auto instrument = play();
  ChannelSet set(read(kGrip + "limit = 5.0\n"), {}, true);
  set.start([] { return std::int64_t{0}; }, {});
  set.begin();
  instrument->give({{-4.9, 0.0}});
  wait_until([&] {
    set.take(0);
    return set.values()[0] == -4.9;
  });
  EXPECT_EQ(set.alarm(), Alarm::kNone);
  instrument->give({{-5.1, 0.0}});
  wait_until([&] {
    set.take(0);
    return set.alarm() == Alarm::kBeyond;
  });
  EXPECT_STREQ(set.sentence(), "channel grip: force is beyond the limit of 5 N");
}

TEST(ChannelTest, EachOfSamplesThatComeTogetherIsComparedWithTheLimit) {
  const auto instrument = play();
  ChannelSet set(read(kGrip + "limit = 5.0\n"), {}, true);
  set.start([] { return std::int64_t{0}; }, {});
  set.begin();
  for (const double force : {0.0, -95.0, 0.5}) {
    instrument->give({{force, 1.0}});
  }
  wait_until([&] { return set.seen()[0].state.values[0] == 0.5; });
  set.take(0);
  EXPECT_EQ(set.values()[0], 0.5);
  EXPECT_EQ(set.alarm(), Alarm::kBeyond);
  EXPECT_STREQ(set.sentence(), "channel grip: force is beyond the limit of 5 N");
  set.take(1);
  EXPECT_EQ(set.alarm(), Alarm::kNone) << "one sample is one alarm";
}

TEST(ChannelTest, EverySampleReachesATickOnce) {
  const auto instrument = play();
  ChannelSet set(read(kGrip), {}, true);
  set.start([] { return std::int64_t{5'000'000}; }, {});
  set.begin();
  for (const double force : {1.0, 30.0, 0.5}) {
    instrument->give({{force, 2.0}});
  }
  std::vector<device::ArrivedValue> arrived;
  wait_until([&] {
    const test::AllocationGuard guard;
    set.take(8'000'000);
    EXPECT_EQ(guard.count(), 0u);
    arrived.insert(arrived.end(), set.arrived().begin(), set.arrived().end());
    return arrived.size() >= 6;
  });
  ASSERT_EQ(arrived.size(), 6u);
  EXPECT_EQ(arrived[2].value, 30.0);
  EXPECT_EQ(arrived[2].place, 0u);
  EXPECT_EQ(arrived[3].place, 1u);
  EXPECT_GT(arrived[2].age, 0.0029);
  set.take(9'000'000);
  EXPECT_THAT(set.arrived(), IsEmpty());
}

TEST(ChannelTest, AnOverloadIsBeyondEveryLimitAndRecordedAsNoValue) {
  const auto instrument = play();
  ChannelSet set(read(kGrip + "limit = 5.0\n"), {}, true);
  set.start([] { return std::int64_t{0}; }, {});
  set.begin();
  instrument->give({{-std::numeric_limits<double>::infinity(), 1.0}});
  Kept kept;
  wait_until([&] {
    kept.take_from(set);
    return kept.rows.size() == 1;
  });
  wait_until([&] {
    set.take(0);
    return set.alarm() == Alarm::kBeyond;
  });
  EXPECT_TRUE(std::isnan(kept.rows[0].values[0]));
  EXPECT_TRUE(std::isnan(set.values()[0]));
}

TEST(ChannelTest, ASensorWithoutNumbersIsLostWhereSomebodyReliesOnThem) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    std::string keys;
    std::vector<double> values;
    bool lost;
  };
  for (const Case& each :
       {Case{"limit = 5.0\n", {kNan, 1.0}, true}, Case{"required = true\n", {kNan, 1.0}, false},
        Case{"required = true\n", {kNan, kNan}, true}, Case{"", {kNan, kNan}, false}}) {
    const auto instrument = play();
    ChannelSet set(read(kGrip + "patience = 0.1\n" + each.keys), {}, true);
    std::atomic<std::int64_t> now{0};
    set.start([&] { return now.load(); }, {});
    set.begin();
    instrument->give({{1.0, 1.0}});
    Kept kept;
    for (std::size_t i = 1; i <= 4; ++i) {
      wait_until([&] {
        kept.take_from(set);
        return kept.rows.size() == i;
      });
      now = now + 50'000'000;
      instrument->give({each.values});
    }
    wait_until([&] {
      kept.take_from(set);
      return kept.rows.size() == 5 && kept.has(Incident::kLost) == each.lost;
    });
    if (each.lost) {
      EXPECT_THAT(set.take_news(), ElementsAre(HasSubstr("its values are no numbers any more")));
      instrument->give({{1.0, 1.0}});
      wait_until([&] {
        kept.take_from(set);
        return kept.has(Incident::kBack);
      });
    }
  }
}

TEST(ChannelTest, AnInstrumentThatDoesNotAnswerIsSaidAndRefusedWhereItIsNeeded) {
  play()->refuse("there is no /dev/ttyACM0");
  ChannelSet beside(read(kGrip), {}, true);
  EXPECT_THAT(beside.start([] { return std::int64_t{0}; }, {}),
              ElementsAre(AllOf(HasSubstr("channel grip: there is no /dev/ttyACM0"),
                                HasSubstr("goes on without it"))));
  ChannelSet needed(read(kGrip + "required = true\n"), {}, true);
  EXPECT_THAT(message_of<RunError>([&] { needed.start([] { return std::int64_t{0}; }, {}); }),
              HasSubstr("the session needs it"));
}

TEST(ChannelSetTest, InADryRunEachQuantityIsASineAtTheStatedRate) {
  play();
  ChannelSet set(read(kGrip + "rate = 50.0\n"
                              "simulated = { mean = 2.0, amplitude = 0.5, frequency = 0.25 }\n"),
                 {}, false);
  set.start([] { return std::int64_t{0}; }, {});
  set.take(1'000'000'000);  // a quarter of a period
  EXPECT_NEAR(set.values()[0], 2.5, 1e-12);
  EXPECT_NEAR(set.values()[1], 2.5, 1e-12);
  std::vector<ChannelRow> rows;
  const auto keep = [&](const record::Rows& batch) {
    const auto* first = static_cast<const ChannelRow*>(batch.data);
    rows.insert(rows.end(), first, first + batch.count);
  };
  set.collect(1'000'000'000, keep);
  ASSERT_THAT(rows, SizeIs(50));
  set.collect(1'100'000'000, keep);
  ASSERT_THAT(rows, SizeIs(55));
  EXPECT_EQ(rows[50].sample, 50u);
  EXPECT_EQ(rows[50].time_ns, 1'000'000'000);
  EXPECT_NEAR(rows[50].values[0], 2.5, 1e-9);
}

TEST(ChannelSetTest, TablesHaveAColumnForEachQuantityAndChunksOfTheirOwn) {
  play();
  const std::string more =
      "[channels.hand]\nkind = \"scripted\"\nquantities = { x = \"m\", y = \"m\" }\n";
  const ChannelSet set(read(kGrip + more), {}, false);
  const record::TableList tables = set.tables();
  ASSERT_THAT(tables, SizeIs(3));
  EXPECT_EQ(tables[0]->name(), "channel_grip");
  EXPECT_EQ(tables[1]->name(), "channel_hand");
  EXPECT_EQ(std::string(tables[1]->fields().back().column.name), "y");
  EXPECT_EQ(std::string(tables[1]->fields().back().column.unit), "m");
  EXPECT_NO_THROW(record::check_chunk_sizes(tables));
}

TEST(ChannelOptionsTest, MistakesAreNamed) {
  play();
  const auto problem = [](const std::string& text) { return message_of([&] { read(text); }); };
  EXPECT_THAT(problem("[channels.grip]\nkind = \"teletype\"\n"),
              StartsWith("lab.toml:2: channels.grip.kind is 'teletype'; allowed: "));
  EXPECT_THAT(problem("[channels.grip]\nkind = \"scripted\"\nquantities = {}\n"),
              HasSubstr("channels.grip.quantities is 0 quantities; allowed: 1 to 64"));
  EXPECT_THAT(problem("[channels.grip]\nkind = \"scripted\"\nquantities = { time_ns = \"N\" }\n"),
              HasSubstr("a quantity called 'time_ns'; allowed: names of quantities other than "));
  EXPECT_THAT(problem(kGrip + "limit = -1.0\n"), HasSubstr("channels.grip.limit is -1"));
  EXPECT_THAT(problem(kGrip + "requird = true\n"), HasSubstr("required"));
  EXPECT_THAT(problem("[channels.\"a b\"]\nkind = \"scripted\"\nquantities = { x = \"m\" }\n"),
              HasSubstr("a name of up to 40 letters"));
  EXPECT_THAT(problem("[channels.events]\nkind = \"scripted\"\nquantities = { x = \"m\" }\n"),
              HasSubstr("channels.events is 'events'"));
}

TEST(ChannelOptionsTest, AQuantityIsFoundByItsChannelAndName) {
  play();
  const auto values =
      names_of_values(read(kGrip + "[channels.hand]\nkind = \"scripted\"\nquantities = { x = "
                                   "\"m\", y = \"m\" }\n"));
  EXPECT_EQ(place_of(values, "grip"), 0u);
  EXPECT_EQ(place_of(values, "grip.angle"), 1u);
  EXPECT_EQ(place_of(values, "hand"), 2u);
  EXPECT_EQ(place_of(values, "hand.y"), 3u);
  EXPECT_EQ(place_of(values, "angle"), std::nullopt);
  EXPECT_THAT(values, ElementsAre("grip.force", "grip.angle", "hand.x", "hand.y"));
}

}  // namespace
}  // namespace haptrial::channel::channel_test
