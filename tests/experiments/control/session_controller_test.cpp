#include "experiments/control/session_controller.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace haptrial::experiments {
namespace {

using testing::ElementsAre;

TEST(SessionControllerTest, AStopIsRecordedOnceAlsoWhileAFaultStands) {
  SessionControl control;
  std::vector<std::string> events;
  SessionController controller(
      &control, {.break_off = [] {},
                 .clear_fault = [] {},
                 .event = [&](const std::string& kind,
                              const std::string& text) { events.push_back(kind + " " + text); }});
  controller.requests().stopped = true;  // by a fault
  control.ask(Request::kEmergencyStop, RequestSource::kTerminal);
  control.ask(Request::kEmergencyStop, RequestSource::kWindow);
  control.ask(Request::kClear, RequestSource::kConsole);
  controller.take_messages();
  EXPECT_THAT(events, ElementsAre("emergency_stop by the terminal", "clear by the console"));
  EXPECT_FALSE(controller.requests().stopped);
  control.ask(Request::kEmergencyStop, RequestSource::kWindow);
  controller.take_messages();
  EXPECT_EQ(events.back(), "emergency_stop by the window");
  EXPECT_TRUE(controller.requests().stopped);
}

}  // namespace
}  // namespace haptrial::experiments
