#include "core/base/definition/schema.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "core/base/definition/key_exploration.h"
#include "core/base/error.h"
#include "tests/support/message_of.h"

namespace haptrial::schema_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Lamp {
  enum class Kind { kSteady, kBlinking };
  Kind kind{Kind::kSteady};
  double brightness{0.5};
  double period{1.0};  // of a blinking lamp [s]
  int count{1};
  std::string label;
  std::string hint{"Look here"};
};

bool blinks(const Lamp& lamp) { return lamp.kind == Lamp::Kind::kBlinking; }

const Schema<Lamp>& lamp_schema() {
  using L = Lamp;
  static const auto schema =
      Schema<L>()
          .choice("kind", &L::kind,
                  {{"steady", L::Kind::kSteady}, {"blinking", L::Kind::kBlinking}}, "Kind of lamp")
          .required()
          .number("brightness", &L::brightness, {0.0, 1.0}, "1", "Brightness of a lamp")
          .number("period", &L::period, {0.0, 10.0, true}, "s", "Time between two flashes")
          .only_if(blinks)
          .integer("count", &L::count, 1, 9, "Number of lamps")
          .shown_text("label", &L::label, "Words on a lamp")
          .otherwise("none")
          .shown_text("hint", &L::hint, 20, "Words below a lamp");
  return schema;
}

Lamp read(const std::string& text) {
  Table root = Table::parse(text, "lamp.toml");
  Lamp lamp = lamp_schema().read(root);
  root.finish();
  return lamp;
}

/// Lamps whose keys stand in the tables [[own]], or else in [shared].
std::vector<Lamp> read_two(const std::string& text) {
  Table root = Table::parse(text, "lamp.toml");
  Table shared = root.table("shared");
  std::vector<Lamp> lamps;
  for (Table& own : root.tables("own")) {
    lamp_schema().read(own, shared, lamps.emplace_back());
  }
  root.finish();
  return lamps;
}

TEST(SchemaTest, AMistakeGetsASentence) {
  EXPECT_EQ(test::message_of<InputError>([] { read("kind = \"steady\"\nbrightness = 2.0\n"); }),
            "lamp.toml:2: brightness is 2; allowed: a number of at least 0 and at most 1 [1]");
  EXPECT_THAT(test::message_of<InputError>([] { read("count = 3\n"); }),
              HasSubstr("kind is missing"));
  EXPECT_THAT(test::message_of<InputError>(
                  [] { read("kind = \"steady\"\nhint = \"Look at the lamp on the left\"\n"); }),
              HasSubstr("hint is 28 bytes long; allowed: at most 20 bytes"));
}

TEST(SchemaTest, AKeyOfAnotherKindIsNotKnown) {
  EXPECT_EQ(read("kind = \"blinking\"\nperiod = 2.0\n").period, 2.0);
  EXPECT_EQ(test::message_of<InputError>([] { read("kind = \"steady\"\nperiod = 2.0\n"); }),
            "lamp.toml:2: period is not a known key; known here: brightness, count, hint, kind, "
            "label");
}

TEST(SchemaTest, AKeyIsTakenFromTheFirstOfTwoTablesThatHasIt) {
  const auto lamps = read_two(
      "[[own]]\ncount = 2\n[[own]]\nkind = \"steady\"\n"
      "[shared]\nkind = \"blinking\"\nperiod = 2.0\ncount = 7\n");
  ASSERT_EQ(lamps.size(), 2U);
  EXPECT_EQ(lamps[0].kind, Lamp::Kind::kBlinking);
  EXPECT_EQ(lamps[0].period, 2.0);
  EXPECT_EQ(lamps[0].count, 2);
  EXPECT_EQ(lamps[0].brightness, 0.5);
  EXPECT_EQ(lamps[1].kind, Lamp::Kind::kSteady);
  EXPECT_EQ(lamps[1].period, 1.0);
  EXPECT_EQ(lamps[1].count, 7);
}

TEST(SchemaTest, AKeyThatEveryTableStatesItselfIsKnownAllTheSame) {
  const auto lamps =
      read_two("[[own]]\ncount = 2\n[[own]]\ncount = 3\n[shared]\nkind = \"steady\"\ncount = 7\n");
  EXPECT_EQ(lamps[0].count, 2);
  EXPECT_EQ(lamps[1].count, 3);
}

TEST(SchemaTest, AMistakeInTwoTablesNamesTheOneThatHasIt) {
  EXPECT_THAT(test::message_of<InputError>(
                  [] { read_two("[[own]]\ncount = 0\n[shared]\nkind = \"steady\"\n"); }),
              HasSubstr("lamp.toml:2: own[1].count is 0"));
  EXPECT_THAT(test::message_of<InputError>(
                  [] { read_two("[[own]]\ncount = 1\n[shared]\nkind = \"steady\"\nhint = 3\n"); }),
              HasSubstr("lamp.toml:5: shared.hint is 3"));
  EXPECT_THAT(test::message_of<InputError>(
                  [] { read_two("[[own]]\nperiod = 1.0\n[shared]\nkind = \"steady\"\n"); }),
              HasSubstr("own[1].period is not a known key"));
}

TEST(SchemaTest, ATextThatIsNotThereIsNotTranslated) {
  Table root = Table::parse("kind = \"steady\"\n", "lamp.toml");
  lamp_schema().read(root);
  const auto shown = root.shown_texts();
  ASSERT_EQ(shown.size(), 1U);
  EXPECT_EQ(shown.front().key, "hint");
}

TEST(SchemaTest, ListsOfKeysTakeWordsAndDefaultsFromIt) {
  const auto keys = known_keys("[a]\n", [](Table& root) { lamp_schema().read(root); });
  const auto key = [&](const std::string& name) {
    const auto found = std::ranges::find(keys, name, &KnownKey::key);
    return found != keys.end() ? *found : KnownKey{};
  };
  EXPECT_FALSE(key("kind").optional);
  EXPECT_EQ(key("kind").words, "Kind of lamp");
  EXPECT_TRUE(key("brightness").optional);
  EXPECT_EQ(key("brightness").otherwise, "0.5");
  EXPECT_EQ(key("label").otherwise, "none");
  EXPECT_EQ(key("period").unit, "s");
  EXPECT_THAT(key("period").when, ElementsAre("kind: blinking"));
}

struct Filter {
  double cutoff{20.0};
};

struct Sensor {
  std::vector<double> gains{1.0};
  std::optional<Filter> filter;
};

const Schema<Filter>& filter_schema() {
  static const auto schema = Schema<Filter>().number("cutoff", &Filter::cutoff, {1.0, 100.0}, "Hz",
                                                     "Cut-off frequency of the filter");
  return schema;
}

const Schema<Sensor>& sensor_schema() {
  static const auto schema =
      Schema<Sensor>()
          .numbers("gains", &Sensor::gains, {0.0, 10.0}, "V/N", "Gains of the channels")
          .table("filter", &Sensor::filter, filter_schema(), "Filter of every channel");
  return schema;
}

Sensor read_sensor(const std::string& text) {
  Table root = Table::parse("[sensor]\n" + text, "lab.toml");
  Table table = root.table("sensor");
  Sensor sensor = sensor_schema().read(table);
  root.finish();
  return sensor;
}

TEST(SchemaTest, KeysThatAreLeftOutKeepTheirDefaults) {
  const Sensor sensor = read_sensor("");
  EXPECT_THAT(sensor.gains, ElementsAre(1.0));
  EXPECT_FALSE(sensor.filter.has_value());
}

TEST(SchemaTest, AnOptionalTableIsReadByItsOwnSchema) {
  const Sensor sensor = read_sensor("gains = [2.0, 3.0]\n[sensor.filter]\n");
  EXPECT_THAT(sensor.gains, ElementsAre(2.0, 3.0));
  ASSERT_TRUE(sensor.filter.has_value());
  EXPECT_EQ(sensor.filter->cutoff, 20.0);
  EXPECT_EQ(read_sensor("[sensor.filter]\ncutoff = 5.0\n").filter->cutoff, 5.0);
}

TEST(SchemaTest, MistakesHaveTheirLineAndWhatIsAllowed) {
  const std::string message = test::message_of<InputError>(
      [] { read_sensor("gains = [11.0]\n[sensor.filter]\ncutoff = 0.5\ncut = 1.0\n"); });
  EXPECT_THAT(message, HasSubstr("lab.toml:2: sensor.gains"));
  EXPECT_THAT(message, HasSubstr("lab.toml:4: sensor.filter.cutoff is 0.5; allowed:"));
  EXPECT_THAT(message, HasSubstr("lab.toml:5: sensor.filter.cut "));
}

}  // namespace
}  // namespace haptrial::schema_test
