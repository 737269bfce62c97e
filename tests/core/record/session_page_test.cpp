// The tables of docs/session-file.md are those of the descriptions.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "core/base/file_text.h"
#include "core/bone/hint/hint_rows.h"
#include "core/bone/nerve/nerve_rows.h"
#include "core/bone/record/bone_rows.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/tool_rows.h"
#include "core/bone/region/forbidden_region.h"
#include "core/channel/channel_row.h"
#include "core/record/rows/common_tables.h"
#include "core/record/rows/device_rows.h"
#include "core/record/rows/object_rows.h"
#include "core/record/rows/session_tables.h"
#include "core/record/rows/trial_rows.h"
#include "core/subject/drilling/work_row.h"

namespace haptrial::record::session_page_test {
namespace {

const std::string kPage = HAPTRIAL_SOURCE_DIR "/docs/session-file.md";
const std::string kEnd = "<!-- end of the tables -->\n";

std::string type_of(const Column& column) {
  switch (column.type) {
    case ColumnType::kU8:
      return "u8";
    case ColumnType::kI32:
      return "i32";
    case ColumnType::kI64:
      return "i64";
    case ColumnType::kU64:
      return "u64";
    case ColumnType::kF32:
      return "f32";
    case ColumnType::kF64:
      return "f64";
    case ColumnType::kText:
      break;
  }
  return fmt::format("text {}", column.bytes);
}

/// The tables with one row a column.
std::string page_of(const TableList& tables) {
  std::string page =
      "| Dataset | Column | Type | Unit | Meaning |\n| --- | --- | --- | --- | --- |\n";
  for (const TableDescription* table : tables) {
    bool first = true;
    for (const Field& field : table->fields()) {
      const std::string since = field.since > table->since()
                                    ? fmt::format(" (since schema version {})", field.since)
                                    : "";
      page +=
          fmt::format("| {} | `{}` | {} | {} | {}{} |\n", first ? "`/" + table->name() + "`" : "",
                      field.column.name, type_of(field.column), field.column.unit,
                      field.column.description, since);
      first = false;
    }
  }
  return page;
}

/// The text between the marks. @param from  receives where it begins
std::string block(const std::string& page, const std::string& name, std::size_t& from) {
  const std::string begin = "<!-- tables: " + name + " -->\n\n";
  from = page.find(begin);
  if (from == std::string::npos) {
    return "";
  }
  from += begin.size();
  return page.substr(from, page.find(kEnd, from) - from);
}

/// With HAPTRIAL_WRITE_PAGES=1 in the environment the page is written anew.
void expect_described(const std::string& name, const TableList& tables) {
  std::string page = file_text(kPage);
  std::size_t from = 0;
  const std::string found = block(page, name, from);
  const std::string expected = page_of(tables);
  if (std::getenv("HAPTRIAL_WRITE_PAGES") != nullptr && from != std::string::npos) {
    page.replace(from, found.size(), expected);
    std::ofstream(kPage, std::ios::binary) << page;
    return;
  }
  EXPECT_EQ(found, expected) << "write docs/session-file.md anew: HAPTRIAL_WRITE_PAGES=1 "
                                "build/test_record --gtest_filter='SessionPageTest.*'";
}

TEST(SessionPageTest, TablesOfEverySession) { expect_described("session", session_tables()); }
TEST(SessionPageTest, TablesOfAnyProtocol) { expect_described("responses", common_tables()); }
TEST(SessionPageTest, TablesOfChannels) {
  expect_described("channels", {&table_of<channel::IncidentRow>()});
}
TEST(SessionPageTest, TablesOfTrials) {
  TableList tables = trial_tables();
  tables.insert(tables.end(), adaptation_tables().begin(), adaptation_tables().end());
  tables.insert(tables.end(), out_of_time_tables().begin(), out_of_time_tables().end());
  tables.push_back(&table_of<ContactRow>());
  tables.push_back(&table_of<CursorRow>());
  tables.push_back(&table_of<TargetRow>());
  tables.push_back(&table_of<ObjectFileRow>());
  tables.push_back(&table_of<TouchedBodyRow>());
  tables.push_back(&table_of<MovingBodyRow>());
  tables.push_back(&table_of<LateWindowRow>());
  tables.push_back(&table_of<ArmRow>());
  expect_described("trials", tables);
}
TEST(SessionPageTest, TablesOfDrillings) {
  TableList tables = drilling_tables();
  tables.push_back(&table_of<TearRow>());
  tables.push_back(&table_of<LedRow>());
  tables.push_back(&table_of<SecondHandRow>());
  tables.push_back(&table_of<ToolContactRow>());
  tables.push_back(&table_of<BurrRow>());
  tables.push_back(&table_of<HandpieceRow>());
  tables.push_back(&table_of<OpeningRow>());
  tables.push_back(&table_of<FieldRow>());
  tables.push_back(&table_of<PieceRow>());
  tables.push_back(&table_of<ScrewRow>());
  tables.push_back(&table_of<WorkRow>());
  tables.push_back(&table_of<CrossingRow>());
  expect_described("drilling", tables);
}
TEST(SessionPageTest, TablesOfHints) { expect_described("hints", hint_tables()); }
TEST(SessionPageTest, TablesOfNerveMonitors) { expect_described("nerves", nerve_tables()); }

}  // namespace
}  // namespace haptrial::record::session_page_test
