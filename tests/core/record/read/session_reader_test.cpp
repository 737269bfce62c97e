#include "core/record/read/session_reader.h"
#include "core/base/file_text.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/record/hdf5/hdf5_layer.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/rows/session_tables.h"
#include "core/record/table/schema.h"
#include "tests/core/record/session_fixture.h"

// HDF5 1.10 forgets a few hundred bytes when it meets a damaged header; ours are still counted.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5\n"; }

namespace haptrial::record {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;

/// Opens and reads the whole file; the message of the refusal, one sentence; nothing on stderr.
std::string refusal(const fs::path& file) {
  testing::internal::CaptureStderr();
  std::string message;
  try {
    const SessionReader reader(file);
    reader.samples(0, reader.sample_count());
    reader.passes();
    reader.events();
    reader.stimuli();
    reader.timing();
    reader.timing_summary();
  } catch (const InputError& error) {
    message = error.what();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(message.find('\n'), std::string::npos);
  if (!message.empty()) {
    EXPECT_THAT(message, HasSubstr(file.string()));
  }
  return message;
}

void write_file(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

fs::path example_session(const TemporaryFolder& folder) {
  const fs::path file = folder / "good.h5";
  SessionWriter writer(file, test::example_info());
  writer.append(test::hand_motion(20000, 1));
  writer.add_event({1, "session_start", "text"});
  writer.set_timing(std::vector<TimingRow>{{0, 1, 2, 3, 4}}, {20000, 0, 0});
  writer.close();
  return file;
}

TEST(SessionReaderTest, RefusesWhatIsNotASessionFile) {
  const TemporaryFolder folder;
  EXPECT_THAT(refusal(folder / "none.h5"), HasSubstr("no such file"));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("is a directory"));
  EXPECT_THAT(refusal("/dev/null"), HasSubstr("is not a regular file"));
  write_file(folder / "empty.h5", "");
  EXPECT_THAT(refusal(folder / "empty.h5"), HasSubstr("file signature not found"));
  write_file(folder / "text.h5", "sequence,time_ns\n0,0\n" + std::string(5000, ' '));
  EXPECT_THAT(refusal(folder / "text.h5"), HasSubstr("file signature not found"));
}

TEST(SessionReaderTest, RefusesOtherLayouts) {
  const TemporaryFolder folder;
  h5::create_file(folder / "bare.h5");
  EXPECT_THAT(refusal(folder / "bare.h5"), HasSubstr("attribute schema_version"));
  {
    const h5::Id file = h5::create_file(folder / "future.h5");
    h5::put(file, "schema_version", std::int64_t{kSchemaVersion + 1});
  }
  EXPECT_THAT(refusal(folder / "future.h5"), HasSubstr("schema version 6 instead of 1 to 5"));
  {
    const h5::Id file = h5::create_file(folder / "text_version.h5");
    h5::put(file, "schema_version", std::string("1"));
  }
  EXPECT_THAT(refusal(folder / "text_version.h5"), HasSubstr("attribute schema_version"));
}

/// All root attributes, and the datasets given.
void create_with(const fs::path& path, const std::vector<TableSchema>& schemas) {
  const h5::Id file = h5::create_file(path);
  h5::put(file, "schema_version", kSchemaVersion);
  for (const char* name : {"program_version", "program_commit", "definition", "definition_name",
                           "subject", "device", "clock", "start_utc", "participant_identifier",
                           "participant_handedness", "participant_age_band", "participant_sex",
                           "participant_consent_confirmed", "participant_notes"}) {
    h5::put(file, name, std::string("x"));
  }
  for (const char* name : {"device_max_force", "device_workspace_radius", "rate"}) {
    h5::put(file, name, 1.0);
  }
  for (const char* name : {"seed", "simulated"}) {
    h5::put(file, name, std::uint64_t{1});
  }
  for (const TableSchema& schema : schemas) {
    h5::create_table(file, schema);
  }
}

TEST(SessionReaderTest, RefusesMissingAndForeignDatasets) {
  const TemporaryFolder folder;
  const std::vector<TableSchema> all{
      samples_table().schema(),    trials_table().schema(), events_table().schema(),
      stimuli_table().schema(),    timing_table().schema(), frames_table().schema(),
      attributes_table().schema(), runs_table().schema(),   begun_table().schema()};
  for (std::size_t gone = 0; gone < all.size(); ++gone) {
    std::vector<TableSchema> rest = all;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(gone));
    const fs::path file = folder / (std::string(all[gone].name) + ".h5");
    create_with(file, rest);
    EXPECT_THAT(refusal(file), HasSubstr(fmt::format("/{} is missing", all[gone].name)));
  }
  std::vector<TableSchema> foreign = all;
  foreign[1].columns = events_table().schema().columns;
  create_with(folder / "foreign.h5", foreign);
  EXPECT_THAT(refusal(folder / "foreign.h5"), HasSubstr("/trials has other columns"));
  create_with(folder / "whole.h5", all);
  EXPECT_THAT(refusal(folder / "whole.h5"), HasSubstr("/attributes is empty"));
}

/// File that a killed writer leaves: as it is while the writer still has it open.
std::string unfinished_session(const TemporaryFolder& folder) {
  SessionWriter writer(folder / "open.h5", test::example_info());
  writer.append(test::hand_motion(20000, 1));
  writer.add_event({1, "session_start", "text"});
  writer.flush();
  return file_text(folder / "open.h5.partial");
}

TEST(SessionReaderTest, ReadsWhatAKilledWriterLeaves) {
  const TemporaryFolder folder;
  write_file(folder / "copy.h5", unfinished_session(folder));
  EXPECT_EQ(refusal(folder / "copy.h5"), "");
  EXPECT_EQ(SessionReader(folder / "copy.h5").sample_count(), 20000u);
}

TEST(SessionReaderTest, RefusesAnUnfinishedFileCutShortAnywhere) {
  const TemporaryFolder folder;
  const std::string whole = unfinished_session(folder);
  for (const double part : {0.0001, 0.001, 0.01, 0.1, 0.5, 0.9}) {
    const auto size = static_cast<std::size_t>(part * static_cast<double>(whole.size()));
    const auto file = folder / (std::to_string(size) + ".h5");
    write_file(file, whole.substr(0, size));
    EXPECT_NE(refusal(file), "") << size << " of " << whole.size() << " bytes";
  }
}

TEST(SessionReaderTest, RefusesAFileCutShortAnywhere) {
  const TemporaryFolder folder;
  const std::string whole = file_text(example_session(folder));
  for (const double part : {0.0001, 0.001, 0.01, 0.1, 0.5, 0.9, 0.999}) {
    const auto size = static_cast<std::size_t>(part * static_cast<double>(whole.size()));
    write_file(folder / "cut.h5", whole.substr(0, size));
    EXPECT_NE(refusal(folder / "cut.h5"), "") << size << " of " << whole.size() << " bytes";
  }
  write_file(folder / "cut.h5", whole.substr(0, whole.size() / 2));
  EXPECT_THAT(refusal(folder / "cut.h5"),
              HasSubstr("(it ends after " + std::to_string(whole.size() / 2) + " of " +
                        std::to_string(whole.size()) + " bytes)"));
}

TEST(SessionReaderTest, ChangedSamplesAreNotReadAsOthers) {
  const TemporaryFolder folder;
  const fs::path good = example_session(folder);
  const std::string whole = file_text(good);
  const SessionReader reader(good);
  const std::vector<Sample> samples = reader.samples(0, reader.sample_count());
  RandomStream random(1, "damage");
  int refused = 0;
  for (int repeat = 0; repeat < 100; ++repeat) {
    std::string bytes = whole;
    const std::size_t at = random.below(repeat % 5 == 0 ? 4096 : bytes.size());
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
    const fs::path damaged = folder / "damaged.h5";
    fs::remove(damaged);
    write_file(damaged, bytes);
    if (!refusal(damaged).empty()) {
      ++refused;
      continue;
    }
    // Then the byte was one that no sample depends on.
    const SessionReader again(damaged);
    ASSERT_EQ(again.sample_count(), samples.size());
    const std::vector<Sample> back = again.samples(0, samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      ASSERT_TRUE(test::same(back[i], samples[i]));
    }
  }
  EXPECT_GT(refused, 70);  // most of the file is compressed samples
}

}  // namespace
}  // namespace haptrial::record
