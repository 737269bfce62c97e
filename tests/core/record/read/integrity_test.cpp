#include "core/record/read/integrity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/record/hdf5/session_writer.h"
#include "core/record/rows/device_rows.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record {
namespace {

using test::TemporaryFolder;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

/// A session of 70000 ticks with two passes, sound until a test breaks it.
struct Session {
  std::vector<Sample> samples{70000};
  std::vector<PassRow> passes{2};
  std::vector<TimingSummary> summary{{70000, 0, 0}};

  Session() {
    passes[0].first_sample = 100;
    passes[0].last_sample = 40000;
    passes[1].first_sample = 40001;
    passes[1].last_sample = 69999;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      samples[i].sequence = i;
      samples[i].time_ns = static_cast<std::int64_t>(i) * 1000000;
      samples[i].pass = i < 100 ? -1 : (i <= 40000 ? 0 : 1);
    }
  }

  Integrity check() const {
    const TemporaryFolder folder;
    SessionWriter writer(folder / "a.h5", test::example_info());
    writer.append(samples);
    for (const PassRow& pass : passes) {
      writer.add_pass(pass);
    }
    for (const TimingSummary& counts : summary) {
      writer.set_timing({}, counts);
    }
    writer.close();
    return check_session(SessionReader(folder / "a.h5"));
  }
};

TEST(IntegrityTest, ASoundSessionHasNoProblem) {
  Session session;
  session.passes[1].status = PassStatus::kAborted;
  session.passes[0].practice = true;
  session.summary[0].overruns = 12;
  const Integrity result = session.check();
  EXPECT_TRUE(result.ok);
  EXPECT_THAT(result.problems, ElementsAre());
  EXPECT_EQ(result.rows, 70000u);
  EXPECT_EQ(result.gaps, 0u);
  EXPECT_EQ(result.first_sequence, 0u);
  EXPECT_EQ(result.last_sequence, 69999u);
  EXPECT_EQ(result.passes, 2u);
  EXPECT_EQ(result.aborted, 1u);
  EXPECT_EQ(result.practice, 1u);
  EXPECT_EQ(result.overruns, 12u);
  EXPECT_EQ(result.dropped, 0u);
}

TEST(IntegrityTest, AnEmptySessionThatEndedIsSound) {
  Session session;
  session.samples.clear();
  session.passes.clear();
  session.summary[0].ticks = 0;
  EXPECT_TRUE(session.check().ok);
}

TEST(IntegrityTest, AttemptsCountFromOne) {
  Session session;
  session.passes[1].attempt = 0;
  EXPECT_THAT(session.check().problems,
              ElementsAre("pass 1 is attempt 0, and attempts count from 1"));
}

TEST(IntegrityTest, MissingTicksAreFound) {
  Session session;
  session.samples.erase(session.samples.begin() + 65536);  // where two pieces meet
  session.samples.erase(session.samples.begin() + 10, session.samples.begin() + 20);
  const Integrity result = session.check();
  EXPECT_FALSE(result.ok);
  EXPECT_EQ(result.gaps, 2u);
  EXPECT_THAT(result.problems,
              ElementsAre("sequence number 20 follows 9 (and 1 more like it)",
                          "the loop ran 70000 ticks, but 69989 rows were recorded"));
}

TEST(IntegrityTest, AMissingBeginningAndEndAreFound) {
  Session session;
  session.samples.erase(session.samples.begin(), session.samples.begin() + 5);
  session.samples.pop_back();
  const Integrity result = session.check();
  EXPECT_EQ(result.gaps, 0u);
  EXPECT_EQ(result.first_sequence, 5u);
  EXPECT_THAT(result.problems,
              ElementsAre("the first sequence number is 5 instead of 0",
                          "the loop ran 70000 ticks, but 69994 rows were recorded",
                          "pass 1 has samples 40001 to 69999, some of which are missing"));
}

TEST(IntegrityTest, RepeatedTicksAndAClockThatStandsAreFound) {
  Session session;
  session.samples[500] = session.samples[499];
  const Integrity result = session.check();
  EXPECT_EQ(result.gaps, 2u);
  EXPECT_THAT(result.problems, ElementsAre("sequence number 499 follows 499 (and 1 more like it)",
                                           "the time does not advance at sequence number 499"));
}

TEST(IntegrityTest, SamplesThatBelongToAnotherPassAreFound) {
  Session session;
  session.samples[99].pass = 0;
  session.samples[40001].pass = 0;
  session.samples[50000].pass = -1;
  EXPECT_THAT(session.check().problems,
              ElementsAre("sequence number 99 is marked as pass 0, and /trials puts it in pass -1 "
                          "(and 2 more like it)"));
}

TEST(IntegrityTest, PassesOutOfOrderAreFound) {
  Session session;
  session.passes[1].first_sample = 40000;
  EXPECT_THAT(session.check().problems,
              Contains("pass 1 has samples 40000 to 69999, but the pass before ends at 40000"));
  session = Session();
  std::swap(session.passes[0].first_sample, session.passes[0].last_sample);
  EXPECT_THAT(session.check().problems, Contains("pass 0 has samples 40000 to 100, in reverse"));
}

/// A program that dies in mid-pass leaves samples of a pass that has no row in /trials.
TEST(IntegrityTest, APassThatWasUnderWayWhenTheProgramDiedIsNoProblemOfItsSamples) {
  const Session session;
  for (const bool known : {true, false}) {
    const TemporaryFolder folder;
    SessionWriter writer(folder / "a.h5", test::example_info());
    writer.append(session.samples);
    writer.add_pass(session.passes[0]);
    if (known) {
      BegunRow begun;
      begun.row = 1;
      writer.begin_pass(begun);
    }
    writer.close();
    const auto problems = check_session(SessionReader(folder / "a.h5")).problems;
    EXPECT_EQ(std::count_if(problems.begin(), problems.end(),
                            [](const std::string& text) {
                              return text.find("is marked as pass 1") != std::string::npos;
                            }),
              known ? 0 : 1);
  }
}

TEST(IntegrityTest, DroppedRecordsAndAnUnfinishedSessionAreFound) {
  Session session;
  session.summary[0].dropped = 4;
  EXPECT_EQ(session.check().dropped, 4u);
  EXPECT_THAT(session.check().problems, ElementsAre("4 lost records"));
  session.summary.clear();
  EXPECT_THAT(session.check().problems, ElementsAre(HasSubstr("the session is unfinished")));
}

/// A session of 300 ticks with two devices. @param tick  of the last row of /devices
std::vector<std::string> problems_with_last_row_of(std::uint64_t tick) {
  const TemporaryFolder folder;
  SessionWriter writer(folder / "a.h5", test::example_info(), {&table_of<DeviceRow>()});
  std::vector<Sample> samples(300);
  std::vector<DeviceRow> devices(300);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].sequence = devices[i].sequence = i;
    samples[i].time_ns = static_cast<std::int64_t>(i) * 1000000;
    samples[i].pass = -1;
  }
  devices.back().sequence = tick;
  writer.add(std::span<const DeviceRow>(devices));
  writer.append(samples);
  writer.set_timing({}, {300, 0, 0});
  writer.close();
  return check_session(SessionReader(folder / "a.h5")).problems;
}

TEST(IntegrityTest, TicksOfASecondDeviceNeverGoBack) {
  EXPECT_THAT(problems_with_last_row_of(299), ElementsAre());
  EXPECT_THAT(problems_with_last_row_of(298), ElementsAre());  // one device more
  EXPECT_THAT(problems_with_last_row_of(297),
              ElementsAre(HasSubstr("sequence number 297 of /devices follows 298")));
}

}  // namespace
}  // namespace haptrial::record
