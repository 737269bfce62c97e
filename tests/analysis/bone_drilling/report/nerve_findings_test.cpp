// Events of nerves as a session file has them.

#include "analysis/bone_drilling/report/nerve_findings.h"

#include <gtest/gtest.h>

#include "core/bone/nerve/nerve_rows.h"
#include "core/bone/record/drilling_tables.h"
#include "core/record/read/session_reader.h"
#include "tests/analysis/bone_drilling/session_of_drillings.h"

namespace haptrial::analysis::drilling {
namespace {

TEST(NerveFindingsTest, EventsOnABoneThatWasGivenUpDoNotCount) {
  const test::TemporaryFolder folder;
  const auto file = folder / "P07.h5";
  {
    const auto tables = record::with_tables(record::drilling_tables(), record::nerve_tables());
    const std::vector<record::BoneRecord> bones{test::block_record(0), test::block_record(1)};
    record::SessionWriter writer(file, test::drilling_info(), tables, record::rows_of(bones));
    RandomStream random(1, "nerves");
    for (const std::int32_t bone : {1, 2}) {
      std::vector<bool> gone;
      record::PassRow pass;
      pass.trial = 1;
      pass.repetition = bone;
      pass.condition = "monitor off";
      const auto at = static_cast<std::uint64_t>(400 * (bone - 1));
      test::write_pass(writer, test::wander(at, 300, bone - 1, random, gone), pass);
      for (int event = 0; event < 3 - bone; ++event) {
        record::NerveEventRow row;
        row.begin = at + 100 + 50 * static_cast<std::uint64_t>(event);
        row.end = row.sequence = row.begin + 5;
        writer.add(std::span<const record::NerveEventRow>(&row, 1));
      }
    }
    const record::NerveChannelRow channel{0, "orbicularis", "facial nerve", 2000.0};
    writer.add(std::span<const record::NerveChannelRow>(&channel, 1));
    writer.set_timing({}, {700, 0, 0});
    writer.close();
  }
  const auto procedures = load_nerves(record::SessionReader(file), "novices");
  ASSERT_EQ(procedures.size(), 1u);
  EXPECT_EQ(procedures[0].nerves.at(0).bursts, 1) << "the two on the first bone are given up";
  EXPECT_DOUBLE_EQ(procedures[0].duration, 0.3);
  EXPECT_FALSE(procedures[0].given);
}

}  // namespace
}  // namespace haptrial::analysis::drilling
