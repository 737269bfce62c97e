// Channels in the status that the console's page gets, and how the page shows them.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "experiments/console/console.h"
#include "experiments/console/console_messages.h"
#include "tests/experiments/browser.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::console_channels_test {
namespace {

SessionStatus with_channels() {
  SessionStatus status;
  status.subject = "S01";
  status.state = "running";
  status.rate = 1000.0;
  ChannelStatus force{"force", true, {}};
  for (const char* name : {"fx", "fy", "fz", "tx", "ty", "tz"}) {
    force.values.push_back(
        {name, name[1] == 'x' ? -1.23456 : 1.2e-5, name[0] == 'f' ? "N" : "N·m"});
  }
  ChannelStatus eeg{"eeg", true, {}};
  for (int i = 0; i < 64; ++i) {
    eeg.values.push_back({"e" + std::to_string(i), 12.0 * i, "µV"});
  }
  status.channels = {force, eeg, {"stimuli", true, {}}, {"grip", false, {}}};
  status.channels[0].values[1].value = std::nan("");
  return status;
}

TEST(ConsoleChannelsTest, AStreamOfTextsIsNotLost) {
  const auto channels = nlohmann::json::parse(status_json(with_channels(), 0))["channels"];
  EXPECT_EQ(channels[2]["live"], true);
  EXPECT_EQ(channels[3]["live"], false);
  EXPECT_DOUBLE_EQ(channels[0]["values"][0]["value"].get<double>(), -1.23456);
  EXPECT_EQ(channels[0]["values"][0]["unit"], "N");
  EXPECT_TRUE(channels[0]["values"][1]["value"].is_null());
}

TEST(ConsoleChannelsTest, ThePageShowsEachChannelInARow) {
  const test::TemporaryFolder folder;
  SessionControl control;
  Console console(control, {});
  std::atomic<bool> ended{false};
  std::thread session([&] {
    for (const SessionStatus status = with_channels(); !ended;
         std::this_thread::sleep_for(std::chrono::milliseconds(20))) {
      control.publish(status);
    }
  });
  EXPECT_EQ(test::run_browser("channels_browser.py", {console.url(), folder.path().string()}), 0);
  ended = true;
  session.join();
  if (const char* kept = std::getenv("HAPTRIAL_KEEP_PICTURES")) {
    for (const char* picture : {"channels.png", "channels-narrow.png"}) {
      std::filesystem::copy_file(folder / picture, std::filesystem::path(kept) / picture,
                                 std::filesystem::copy_options::overwrite_existing);
    }
  }
}

}  // namespace
}  // namespace haptrial::experiments::console_channels_test
