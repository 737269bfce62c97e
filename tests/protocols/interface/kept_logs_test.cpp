#include "protocols/interface/session_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/record/rows/device_rows.h"
#include "core/record/rows/object_rows.h"

namespace haptrial::protocols {
namespace {

using testing::ElementsAre;

/// Keeps the names of the tables to which rows came, and how many.
class CountedRows final : public SessionFile {
 public:
  std::vector<std::pair<std::string, std::size_t>> rows;

  void keep_stimulus(std::int32_t, std::span<const record::StimulusRow>) override {}
  bool holds_stimulus(std::int32_t) const override { return false; }
  void event(const std::string&, const std::string&) override {}
  const std::vector<record::PassRow>& earlier_passes() const override { return passes_; }
  bool was_cut_short(const PlannedTrial&) const override { return false; }

 protected:
  void put(const record::Rows& batch) override {
    rows.emplace_back(batch.table->name(), batch.count);
  }

 private:
  std::vector<record::PassRow> passes_;
};

TEST(KeptLogsTest, ALogThatIsNamedOnceHasATableIsEmptiedAndCountsWhatItDropped) {
  realtime::BlockLog<record::ContactRow> contacts{8, 4};
  realtime::BlockLog<int> entries{2, 4};
  KeptLogs kept;
  kept.keep(contacts);
  kept.keep<int>(entries, record::table_of<record::CursorRow>(),
                 [](SessionFile& file, std::span<const int> all) {
                   const std::vector<record::CursorRow> rows(2 * all.size());
                   file.add(std::span(rows));
                 });
  EXPECT_THAT(kept.tables(), ElementsAre(&record::table_of<record::ContactRow>(),
                                         &record::table_of<record::CursorRow>()));
  for (int i = 0; i < 3; ++i) {
    contacts.push({});
  }
  for (int i = 0; i < 11; ++i) {
    entries.push(i);
  }
  EXPECT_EQ(kept.dropped(), 3u);
  CountedRows file;
  kept.empty(file);
  std::size_t cursors = 0;
  for (const auto& [table, count] : file.rows) {
    cursors += table == "cursor" ? count : 0;
  }
  EXPECT_THAT(file.rows.front(), testing::Pair("contacts", 3u));
  EXPECT_EQ(cursors, 16u);
  file.rows.clear();
  kept.empty(file);
  EXPECT_TRUE(file.rows.empty());
}

}  // namespace
}  // namespace haptrial::protocols
