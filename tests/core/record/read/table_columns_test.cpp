// Columns as arrays: the values that rows have, of tables that the program knows and of those that
// only the file describes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/bone/record/drilling_tables.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/session_tables.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record::table_columns_test {
namespace {

using test::TemporaryFolder;
using testing::Contains;
using testing::HasSubstr;

constexpr std::size_t kRows = 9001;  // some chunks, the last one begun

std::filesystem::path written(const TemporaryFolder& folder) {
  const std::filesystem::path file = folder / "a.h5";
  SessionWriter writer(file, test::example_info(), drilling_tables());
  writer.append(test::hand_motion(kRows, 1));
  const std::vector<ToolRow> tools = test::tool_motion(kRows, 2);
  writer.add(std::span(tools));
  writer.add_event({7, "session_start", "a text"});
  writer.close();
  return file;
}

std::size_t field(const TableDescription& table, std::string_view name) {
  for (std::size_t i = 0; i < table.fields().size(); ++i) {
    if (name == table.fields()[i].column.name) {
      return i;
    }
  }
  return table.fields().size();
}

template <class T>
std::vector<T> column(const SessionReader& reader, const TableDescription& table,
                      std::string_view name, std::uint64_t first, std::uint64_t count) {
  std::vector<T> values(count);
  const ColumnTarget target{field(table, name), reinterpret_cast<std::uint8_t*>(values.data())};
  reader.columns(table, first, count, std::vector{target});
  return values;
}

TEST(TableColumnsTest, HaveTheValuesOfTheRows) {
  const TemporaryFolder folder;
  const SessionReader reader(written(folder));
  constexpr std::uint64_t kFirst = 4000, kCount = 4500;
  const auto rows = reader.samples(kFirst, kCount);
  const auto time = column<std::int64_t>(reader, samples_table(), "time_ns", kFirst, kCount);
  const auto y = column<float>(reader, samples_table(), "position_y", kFirst, kCount);
  const auto stage = column<std::uint8_t>(reader, samples_table(), "stage", kFirst, kCount);
  const auto pass = column<std::int32_t>(reader, samples_table(), "pass", kFirst, kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    ASSERT_EQ(time[i], rows[i].time_ns);
    ASSERT_EQ(y[i], static_cast<float>(rows[i].position.y()));
    ASSERT_EQ(stage[i], static_cast<std::uint8_t>(rows[i].stage));
    ASSERT_EQ(pass[i], rows[i].pass);
  }
  EXPECT_THROW(column<float>(reader, samples_table(), "force_x", kRows, 1), std::invalid_argument);
}

TEST(TableColumnsTest, TextsArePaddedWithZeros) {
  const TemporaryFolder folder;
  const SessionReader reader(written(folder));
  std::vector<char> texts(kTextBytes, 'x');
  const ColumnTarget target{field(events_table(), "text"),
                            reinterpret_cast<std::uint8_t*>(texts.data())};
  reader.columns(events_table(), 0, 1, std::vector{target});
  EXPECT_EQ(std::string(texts.data(), texts.size()), "a text" + std::string(kTextBytes - 6, '\0'));
}

TEST(TableColumnsTest, AFileDescribesATableAsItsProgramDoes) {
  const TemporaryFolder folder;
  const SessionReader reader(written(folder));
  const TableDescription& known = table_of<ToolRow>();
  ASSERT_THAT(reader.table_names(), Contains(known.name()));
  const auto found = reader.description(known.name());
  EXPECT_STREQ(found->schema().description, known.schema().description);
  ASSERT_EQ(found->fields().size(), known.fields().size());
  for (std::size_t i = 0; i < known.fields().size(); ++i) {
    const Column& a = found->fields()[i].column;
    const Column& b = known.fields()[i].column;
    EXPECT_STREQ(a.name, b.name);
    EXPECT_EQ(a.type, b.type) << a.name;
    EXPECT_EQ(a.bytes, b.bytes) << a.name;
    EXPECT_STREQ(a.unit, b.unit) << a.name;
    EXPECT_STREQ(a.description, b.description) << a.name;
    EXPECT_EQ(a.resolution, b.resolution) << a.name;
  }
  ASSERT_EQ(reader.count(*found), kRows);
  EXPECT_EQ(column<std::uint64_t>(reader, *found, "sequence", 0, kRows),
            column<std::uint64_t>(reader, known, "sequence", 0, kRows));
}

TEST(TableColumnsTest, ATableThatIsNotThereIsRefusedInASentence) {
  const TemporaryFolder folder;
  const SessionReader reader(written(folder));
  try {
    reader.description("nowhere");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/nowhere is missing"));
  }
}

}  // namespace
}  // namespace haptrial::record::table_columns_test
