// Everything that a tick calls, together: device, envelope, pass, subject, log.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/dynamic_library.h"
#include "core/base/error.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "experiments/runner/session.h"
#include "protocols/force_training/force_definition.h"
#include "protocols/force_training/force_protocol.h"
#include "protocols/force_training/pass_pictures.h"
#include "protocols/force_training/training_pass.h"
#include "protocols/force_training/trajectory_pass.h"
#include "protocols/force_training/virtual_rig.h"
#include "protocols/interface/session_task.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/timed_session.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/stand_in.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::servo_path_test {
namespace {

class ServoPathTest : public testing::TestWithParam<const char*> {};

TEST_P(ServoPathTest, DoesNotAllocate) {
  const auto definition = protocols::load_force_definition(test::shipped_definition());
  protocols::VirtualRig rig(definition, 1);
  protocols::FrameCapture capture(10);
  protocols::SessionTask::Log log;
  protocols::SessionTask task(rig.device(), definition.envelope, log, {rig.subject(), &capture},
                              protocols::SessionTask::Leave::kNever);
  const auto stimulus = stimulus::make_stimulus(definition.trajectory, definition.force_pattern, 1);
  const std::string kind = GetParam();
  std::unique_ptr<protocols::Pass> pass;
  if (kind == "test") {
    pass = std::make_unique<protocols::TrajectoryPass>(protocols::kRecallTest, stimulus,
                                                       definition.guidance, 1);
  } else {
    pass = protocols::make_training_pass(kind, stimulus, definition.guidance, 1);
  }
  task.start(*pass, 0);
  std::uint64_t index = 0;
  const test::AllocationGuard guard;
  while (!task.idle() && index < 40000) {
    task.tick({index, static_cast<std::int64_t>(index) * 1000000, 1e-3});
    ++index;
  }
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_TRUE(task.idle()) << "the pass came to its end";
  EXPECT_EQ(log.pushed(), index);
}

INSTANTIATE_TEST_SUITE_P(Each, ServoPathTest,
                         testing::Values("haptic", "visual", "visuohaptic", "test"),
                         [](const auto& kind) { return std::string(kind.param); });

TEST(RealClockTest, AsManyRecordsAsPeriods) {
  const test::TemporaryFolder folder;
  constexpr std::uint64_t kTicks = 3000;
  const test::TimedSession session = test::run_timed_session(kTicks, folder / "S01.h5");
  const record::SessionReader reader(folder / "S01.h5");
  EXPECT_EQ(session.ticks, kTicks);
  EXPECT_EQ(session.dropped, 0u);
  EXPECT_EQ(reader.sample_count(), kTicks);
  EXPECT_EQ(record::check_session(reader).gaps, 0u);
  EXPECT_EQ(session.timing.lateness.count(), kTicks);
  EXPECT_GE(session.seconds, 2.9) << "the loop does not run ahead of the clock";
}

TEST(RealClockTest, TimesInTheFileFollowTheClock) {
  const test::TemporaryFolder folder;
  const test::TimedSession session = test::run_timed_session(500, folder / "S01.h5");
  const auto samples = record::SessionReader(folder / "S01.h5").samples(0, 500);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    EXPECT_GT(samples[i].time_ns, samples[i - 1].time_ns);
  }
  EXPECT_GE(samples.back().time_ns, 498'000'000);
  EXPECT_LT(samples.back().time_ns, static_cast<std::int64_t>(1e9 * session.seconds));
}

}  // namespace

// A device whose library takes longer for a call than a period lasts.

namespace {

using testing::HasSubstr;

const std::string kLibrary = std::string(HAPTRIAL_BINARY_DIR) + "/libstand_in_dhd.so";

TEST(OverloadTest, APassIsAbortedWithASentenceAndAnEvent) {
  const DynamicLibrary library(kLibrary, "the stand-in");
  void (*fail)(int, long){nullptr};
  void (*reset)(){nullptr};
  library.get(fail, "stand_in_fail");
  library.get(reset, "stand_in_reset");
  reset();
  fail(static_cast<int>(test::Failure::kSlowCall), 0);
  const test::TemporaryFolder folder;
  const protocols::ForceDefinition definition =
      protocols::parse_force_definition(test::shipped_text(), "shipped.toml");
  SessionRequest request =
      test::session_request(protocols::force_training(), definition, folder / "P01.h5", 0, "P01");
  request.clock = realtime::ClockKind::kReal;
  request.device = {"force-dimension", kLibrary};
  std::string said;
  request.tell = [&said](const std::string& line) { said += line + "\n"; };
  std::string error = "none";
  try {
    run_session(request);
  } catch (const RunError& thrown) {
    error = thrown.what();
  }
  reset();
  EXPECT_THAT(error, HasSubstr("the servo loop is overloaded: "));
  EXPECT_THAT(error, HasSubstr("of 1000 ticks a second"));
  EXPECT_THAT(said, HasSubstr("WARNING: "));
  const record::SessionReader reader(folder / "P01.h5.partial");
  ASSERT_EQ(reader.passes().size(), 1u);
  EXPECT_EQ(reader.passes()[0].status, record::PassStatus::kAborted);
  int events = 0;
  for (const record::EventRow& event : reader.events()) {
    events +=
        event.kind == "overruns" && event.text.find("overran their period") != std::string::npos;
  }
  EXPECT_EQ(events, 1);
}

}  // namespace
}  // namespace haptrial::experiments::servo_path_test
