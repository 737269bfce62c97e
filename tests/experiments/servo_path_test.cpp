// Everything that a tick calls, together: device, envelope, pass, subject, log.

#include <gtest/gtest.h>

#include "protocols/force_training/frame_capture.h"
#include "protocols/force_training/recall.h"
#include "protocols/force_training/training_pass.h"
#include "protocols/force_training/virtual_rig.h"
#include "protocols/interface/session_task.h"
#include "tests/experiments/shipped.h"
#include "tests/support/allocation_guard.h"

namespace haptrial {
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
    pass = std::make_unique<protocols::RecallTest>(stimulus, definition.guidance, 1);
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

}  // namespace
}  // namespace haptrial
