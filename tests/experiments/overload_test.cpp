// A device whose library takes longer for a call than a period lasts.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/dynamic_library.h"
#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "experiments/runner/session.h"
#include "protocols/force_training/force_definition.h"
#include "protocols/force_training/force_protocol.h"
#include "tests/experiments/shipped.h"
#include "tests/support/stand_in.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::overload_test {
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
  SessionRequest request;
  request.protocol = &protocols::force_training();
  request.definition = &definition;
  request.subject = "P01";
  request.clock = realtime::ClockKind::kReal;
  request.device = {"force-dimension", kLibrary};
  request.file = folder / "P01.h5";
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
}  // namespace haptrial::experiments::overload_test
