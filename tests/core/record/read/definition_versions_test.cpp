#include "core/record/read/definition_versions.h"

#include <gtest/gtest.h>

#include "core/record/hdf5/session_writer.h"
#include "core/record/read/session_reader.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record {
namespace {

constexpr std::int64_t kPeriod = 1'000'000;  // [ns]

/// Passes of 10 ticks each, the first for practice; a tick between two.
void write_session(const std::filesystem::path& file, const std::vector<EventRow>& events) {
  SessionWriter writer(file, test::example_info());
  std::vector<Sample> samples = test::hand_motion(33, 1);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].sequence = i;
    samples[i].time_ns = static_cast<std::int64_t>(i) * kPeriod;
    samples[i].pass = i % 11 == 10 ? -1 : static_cast<std::int32_t>(i / 11);
  }
  writer.append(samples);
  for (std::int32_t i = 0; i < 3; ++i) {
    PassRow pass;
    pass.trial = i + 4;
    pass.practice = i == 0;
    pass.condition = "haptic";
    pass.first_sample = 11u * static_cast<std::uint64_t>(i);
    pass.last_sample = pass.first_sample + 9;
    writer.add_pass(pass);
  }
  for (const EventRow& event : events) {
    writer.add_event(event);
  }
  writer.set_timing({}, {33, 0, 0});
  writer.close();
}

TEST(DefinitionVersionsTest, ASessionThatWasNotResumedHasOne) {
  const test::TemporaryFolder folder;
  write_session(folder / "a.h5", {{0, "session_start", ""}});
  const auto versions = definition_versions(SessionReader(folder / "a.h5"));
  ASSERT_EQ(versions.size(), 1u);
  EXPECT_EQ(versions[0].text, test::example_info().definition);
  ASSERT_TRUE(versions[0].first);
  EXPECT_EQ(versions[0].first->trial, 4);
}

TEST(DefinitionVersionsTest, EachHasTheFirstPassThatWasRecordedWithIt) {
  const test::TemporaryFolder folder;
  write_session(folder / "a.h5", {{11 * kPeriod, kNewDefinition, "second"},
                                  {11 * kPeriod + 1, kNewDefinition, "third"},
                                  {40 * kPeriod, kNewDefinition, "last"}});
  const SessionReader reader(folder / "a.h5");
  const auto versions = definition_versions(reader);
  ASSERT_EQ(versions.size(), 4u);
  EXPECT_TRUE(versions[0].first->practice);
  EXPECT_EQ(versions[1].text, "second");
  EXPECT_EQ(versions[1].first->trial, 5);
  EXPECT_EQ(versions[2].first->trial, 6);
  EXPECT_FALSE(versions[3].first);
  EXPECT_EQ(newest_definition(reader.info(), reader.events()), "last");
  EXPECT_EQ(newest_definition(reader.info(), {}), reader.info().definition);
}

}  // namespace
}  // namespace haptrial::record
