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

namespace haptrial {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

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

TEST(SchemaTest, ListsOfKeysShowDescriptionsAndDefaults) {
  const auto keys = known_keys("[sensor]\n", [](Table& root) {
    Table table = root.table("sensor");
    sensor_schema().read(table);
  });
  const auto cutoff = std::ranges::find(keys, "sensor.filter.cutoff", &KnownKey::path);
  ASSERT_NE(cutoff, keys.end());
  EXPECT_EQ(cutoff->words, "Cut-off frequency of the filter");
  EXPECT_EQ(cutoff->otherwise, "20");
  EXPECT_EQ(cutoff->unit, "Hz");
  EXPECT_TRUE(cutoff->optional);
}

}  // namespace
}  // namespace haptrial
