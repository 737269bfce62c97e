#include "core/record/recovery/recover.h"
#include "core/base/file_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/bone/record/tool_rows.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/common_tables.h"
#include "core/record/table/schema.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record {
namespace {

/// Rows of each tick, of 22 and of 33 bytes.
struct ShortRow {
  std::uint64_t sequence{0};
  double a{0.0};
  std::uint32_t b{0};
  bool c{false};
  bool d{false};
};
struct LongRow {
  std::uint64_t sequence{0};
  double a{0.0};
  double b{0.0};
  double c{0.0};
  bool d{false};
};

}  // namespace

template <>
const Table<ShortRow>& table_of<ShortRow>() {
  using T = Table<ShortRow>;
  static const T table(
      {"short", "rows of 22 bytes", 4096, RowsOf::kEachTick, {"sequence"}},
      {T::column("sequence", &ShortRow::sequence, "1", "tick number"),
       T::column("a", &ShortRow::a, "1", "a number"), T::column("b", &ShortRow::b, "1", "another"),
       T::column("c", &ShortRow::c, "1", "a truth"), T::column("d", &ShortRow::d, "1", "another")});
  return table;
}

template <>
const Table<LongRow>& table_of<LongRow>() {
  using T = Table<LongRow>;
  static const T table(
      {"long", "rows of 33 bytes", 4096, RowsOf::kEachTick, {"sequence"}},
      {T::column("sequence", &LongRow::sequence, "1", "tick number"),
       T::column("a", &LongRow::a, "1", "a number"), T::column("b", &LongRow::b, "1", "another"),
       T::column("c", &LongRow::c, "1", "a third"), T::column("d", &LongRow::d, "1", "a truth")});
  return table;
}

namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using testing::HasSubstr;

constexpr std::uint64_t kRows = 60000;

/// A live session of a minute, and how long its file was when so many rows were in it.
struct Original {
  TemporaryFolder folder;
  std::vector<Sample> samples = test::hand_motion(kRows, 5);
  std::vector<std::pair<std::size_t, std::uint64_t>> lengths;  // [bytes] -> rows
  std::string bytes;

  Original() {
    SessionInfo info = test::example_info();
    info.clock = "real";
    for (int i = 0; i < 300; ++i) {
      info.definition += "# line " + std::to_string(i) + "\n";
    }
    SessionWriter writer(folder / "a.h5", info);
    writer.add_stimulus(std::vector<StimulusRow>{{1, 0.0, {0.1, 0, 0}, 1.0}});
    for (std::uint64_t at = 0; at < kRows; at += 1000) {
      writer.append(std::span(samples).subspan(at, 1000));
      if (at % 5000 == 4000) {
        writer.add_pass({1, "haptic", Phase::kTest, 1, 1, 7, at - 4000, at + 999, {}});
        writer.add_event({static_cast<std::int64_t>(at), "note", std::string(300, 'n')});
        writer.add_frames(std::vector<FrameRow>{{static_cast<std::int64_t>(at) + 1, 2, 0}});
        writer.sync();
        lengths.emplace_back(fs::file_size(folder / "a.h5.partial"), at + 1000);
      } else {
        writer.flush();
      }
    }
    writer.set_timing(std::vector<TimingRow>{{0, 1, 2, 3, 4}}, {kRows, 1, 0});
    writer.close();
    bytes = file_text(folder / "a.h5");
  }

  /// Rows that were in the file when it was no longer than this.
  std::uint64_t rows_within(std::size_t length) const {
    std::uint64_t rows = 0;
    for (const auto& [bytes_then, rows_then] : lengths) {
      if (bytes_then <= length) {
        rows = rows_then;
      }
    }
    return rows;
  }

  /// Recovers the bytes and checks that every row that came back is one that was recorded.
  Recovery recover(const std::string& damaged) const {
    fs::remove(folder / "out.h5");
    std::ofstream(folder / "damaged.h5", std::ios::binary) << damaged;
    const Recovery found = recover_session(folder / "damaged.h5", folder / "out.h5");
    EXPECT_EQ(fs::exists(folder / "out.h5"), found.anything());
    if (!found.anything()) {
      return found;
    }
    const SessionReader reader(folder / "out.h5");
    EXPECT_EQ(reader.sample_count(), found.samples);
    EXPECT_EQ(reader.passes().size(), found.passes);
    for (const Sample& sample : reader.samples(0, found.samples)) {
      const bool good =
          sample.sequence < kRows && test::same(sample, test::on_file(samples[sample.sequence]));
      EXPECT_TRUE(good) << "row " << sample.sequence;
      if (!good) {
        break;
      }
    }
    check_session(reader);
    return found;
  }
};

const Original& original() {
  static const Original once;
  return once;
}

TEST(RecoverTest, AWholeFileComesBackWhole) {
  const Recovery found = original().recover(original().bytes);
  EXPECT_EQ(found.samples, kRows);
  EXPECT_EQ(found.missing, 0u);
  EXPECT_EQ(found.passes, kRows / 5000);
  EXPECT_EQ(found.passes_cut, 0u);
  EXPECT_EQ(found.stimulus_blocks, 1u);
  EXPECT_EQ(found.frames, kRows / 5000);
  EXPECT_TRUE(found.info);
  EXPECT_TRUE(found.ended);
  const SessionReader before(original().folder / "a.h5");
  const SessionReader after(original().folder / "out.h5");
  EXPECT_EQ(after.info().definition, before.info().definition);
  EXPECT_EQ(after.info().seed, before.info().seed);
  EXPECT_EQ(after.info().device_max_force, 8.5);
  EXPECT_EQ(after.info().participant.notes, "trägt Brille");
  EXPECT_EQ(after.timing_summary()->overruns, 1u);
  ASSERT_EQ(after.events().size(), before.events().size() + 1);
  EXPECT_EQ(after.events().back().kind, "recovered");
  EXPECT_EQ(after.events()[3].text, before.events()[3].text);
}

TEST(RecoverTest, CutAtFiftyLengthsEverythingBeforeTheCutComesBack) {
  const Original& from = original();
  RandomStream random(1, "cuts");
  double sum = 0.0;
  for (int i = 0; i < 50; ++i) {
    const std::size_t length = random.below(from.bytes.size());
    const Recovery found = from.recover(from.bytes.substr(0, length));
    const std::uint64_t before = from.rows_within(length);
    ASSERT_GE(found.samples, before) << length << " bytes";
    if (before > 0) {
      const Sample last = SessionReader(from.folder / "out.h5").samples(before - 1, 1).front();
      EXPECT_EQ(last.sequence, before - 1) << length << " bytes: a gap before the cut";
    }
    const double whole = static_cast<double>(kRows) * static_cast<double>(length) /
                         static_cast<double>(from.bytes.size());
    const double fraction = static_cast<double>(found.samples) / whole;
    sum += fraction;
  }
  std::printf("50 cuts: rows back / (rows x length / whole length): mean %.3f\n", sum / 50);
}

TEST(RecoverTest, ZeroedPagesCostOnlyTheChunksThatTheyTouch) {
  const Original& from = original();
  RandomStream random(2, "pages");
  const std::uint64_t chunk = live_chunk_rows(1000.0);
  double least = 1.0, sum = 0.0;
  int with_info = 0;
  for (int i = 0; i < 50; ++i) {
    std::string bytes = from.bytes;
    const std::uint64_t pages = 1 + random.below(8);
    for (std::uint64_t k = 0; k < pages; ++k) {
      const std::size_t at = 4096 * random.below(bytes.size() / 4096);
      bytes.replace(at, 4096, 4096, '\0');
    }
    const Recovery found = from.recover(bytes);
    EXPECT_GE(found.samples + 2 * chunk * pages, kRows) << pages << " pages";
    const double fraction = static_cast<double>(found.samples) / kRows;
    least = std::min(least, fraction);
    sum += fraction;
    with_info += found.info ? 1 : 0;
  }
  std::printf(
      "50 times 1 to 8 zeroed pages of %zu: mean %.3f of the rows back, least %.3f; the "
      "definition %d times\n",
      from.bytes.size() / 4096, sum / 50, least, with_info);
  EXPECT_GT(with_info, 40);
}

TEST(RecoverTest, WithoutItsHeaderAFileStillGivesItsRows) {
  const Original& from = original();
  for (const std::size_t lost : {1u, 48u, 512u, 2048u}) {
    const Recovery found = from.recover(std::string(lost, '\0') + from.bytes.substr(lost));
    EXPECT_EQ(found.samples, kRows) << lost;
    EXPECT_TRUE(found.info);
  }
}

TEST(RecoverTest, RandomDamageNeverCrashesAndNeverMakesRowsUp) {
  const Original& from = original();
  RandomStream random(3, "noise");
  for (int i = 0; i < 40; ++i) {
    std::string bytes = from.bytes;
    const std::size_t at = random.below(i % 2 == 0 ? 20000 : bytes.size());
    const std::size_t size = std::min<std::size_t>(1 + random.below(8192), bytes.size() - at);
    for (std::size_t k = 0; k < size; ++k) {
      bytes[at + k] = static_cast<char>(random.below(256));
    }
    from.recover(bytes);
  }
}

TEST(RecoverTest, AFileOfVersionOneGivesItsRowsAndItsAttributes) {
  const TemporaryFolder folder;
  const std::string old = file_text(HAPTRIAL_SOURCE_DIR "/tests/core/record/data/version1.hdf5");
  const auto recover = [&](const std::string& bytes) {
    fs::remove(folder / "out.h5");
    std::ofstream(folder / "old.h5", std::ios::binary) << bytes;
    return recover_session(folder / "old.h5", folder / "out.h5");
  };
  Recovery found = recover(old);
  EXPECT_EQ(found.samples, 500u);
  EXPECT_EQ(found.passes, 2u);
  EXPECT_TRUE(found.info);
  EXPECT_EQ(found.subject, "P07");
  EXPECT_EQ(SessionReader(folder / "out.h5").passes()[1].last_sample, 449u);
  EXPECT_EQ(SessionReader(folder / "out.h5").passes()[1].attempt, 1);
  found = recover(std::string(48, '\0') + old.substr(48));
  EXPECT_EQ(found.samples, 500u);
  EXPECT_FALSE(found.info);
}

// At this rate a chunk of /short is as long as 512 rows of /long, and one of /long as 1,152 of
// /short.
TEST(RecoverTest, TablesOfEachTickAreToldByTheirTicks) {
  const TableList own{&table_of<ShortRow>(), &table_of<LongRow>()};
  EXPECT_NO_THROW(check_chunk_sizes(own));
  SessionInfo info = test::example_info();
  info.clock = "real";
  ASSERT_EQ(live_chunk_rows(info.rate), 768u);
  const TemporaryFolder folder;
  constexpr std::uint64_t kTicks = 4000;
  std::vector<ShortRow> shorts;
  std::vector<LongRow> longs;
  for (std::uint64_t tick = 0; tick < kTicks; ++tick) {
    shorts.push_back({tick, 0.5 + static_cast<double>(tick), 7, true, true});
    longs.push_back({tick, -1.5, 1e-3 * static_cast<double>(tick), 2.5, true});
  }
  SessionWriter writer(folder / "a.h5", info, own);
  writer.append(test::hand_motion(kTicks, 5));
  writer.add(std::span<const ShortRow>(shorts));
  writer.add(std::span<const LongRow>(longs));
  writer.set_timing({}, {kTicks, 0, 0});
  writer.close();
  std::string damaged = file_text(folder / "a.h5");
  damaged.replace(0, 512, 512, '\0');  // no structure is left
  std::ofstream(folder / "damaged.h5", std::ios::binary) << damaged;
  const Recovery found = recover_session(folder / "damaged.h5", folder / "out.h5", own);
  ASSERT_TRUE(found.anything());
  const SessionReader reader(folder / "out.h5");
  const auto short_rows = reader.rows<ShortRow>();
  const auto long_rows = reader.rows<LongRow>();
  ASSERT_EQ(short_rows.size(), kTicks);
  ASSERT_EQ(long_rows.size(), kTicks);
  for (std::uint64_t tick = 0; tick < kTicks; ++tick) {
    ASSERT_EQ(short_rows[tick].sequence, tick);
    ASSERT_EQ(short_rows[tick].a, shorts[tick].a);
    ASSERT_EQ(long_rows[tick].sequence, tick);
    ASSERT_EQ(long_rows[tick].b, longs[tick].b);
  }
}

// A chunk of /timing is as long as 512 rows of /tool_contact. Bins of very late ticks are read as
// tick numbers that rise.
TEST(RecoverTest, HistogramsOfLateTicksAreNoTicks) {
  const TableList own{&table_of<ToolContactRow>()};
  SessionInfo info = test::example_info();
  info.clock = "real";
  const TemporaryFolder folder;
  std::vector<TimingRow> bins;
  for (std::int64_t i = 0; i < 256 + 6; ++i) {
    const std::int64_t low = i < 256 ? i : 65536 * (i - 255);
    bins.push_back({low, i < 256 ? low + 1 : low + 65536, 1, 0, 0});
  }
  SessionWriter writer(folder / "a.h5", info);
  writer.append(test::hand_motion(4000, 5));
  writer.set_timing(bins, {4000, 0, 0});
  writer.close();
  std::string damaged = file_text(folder / "a.h5");
  damaged.replace(0, 512, 512, '\0');
  std::ofstream(folder / "damaged.h5", std::ios::binary) << damaged;
  ASSERT_TRUE(recover_session(folder / "damaged.h5", folder / "out.h5", own).anything());
  const SessionReader reader(folder / "out.h5");
  EXPECT_EQ(reader.rows<ToolContactRow>().size(), 0u);
  EXPECT_EQ(reader.timing().size(), bins.size());
}

TEST(RecoverTest, NothingIsWrittenWhereNothingIsLeftAndNothingIsOverwritten) {
  EXPECT_FALSE(original().recover("").anything());
  EXPECT_FALSE(original().recover(std::string(100000, '\0')).anything());
  EXPECT_FALSE(original().recover("no session at all").anything());
  const TemporaryFolder folder;
  std::ofstream(folder / "there.h5") << "x";
  const auto refusal = [&](const fs::path& from) {
    try {
      recover_session(from, folder / "there.h5");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(refusal(original().folder / "a.h5"), HasSubstr("there.h5: exists already"));
  EXPECT_THAT(refusal(folder / "none.h5"), HasSubstr("none.h5"));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("is not a file"));
  SessionWriter writer(folder / "live.h5", test::example_info());
  EXPECT_THAT(refusal(folder / "live.h5.partial"), HasSubstr("records into it"));
}

}  // namespace
}  // namespace haptrial::record
