// The copy of the console that only looks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <thread>

#include "core/base/error.h"
#include "experiments/console/console.h"
#include "experiments/console/console_messages.h"
#include "tests/experiments/browser.h"
#include "tests/experiments/console_client.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::console_watch_test {
namespace {

using test::RawClient;
using test::RawRequest;
using test::status_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class ConsoleWatchTest : public testing::Test {
 protected:
  ConsoleWatchTest() {
    const std::regex form("http://127\\.0\\.0\\.1:([0-9]+)/\\?token=([0-9a-f]{32})");
    const std::string url = console_.watch_url();
    std::smatch parts;
    EXPECT_TRUE(std::regex_match(url, parts, form)) << url;
    port_ = std::stoi(parts.str(1));
    token_ = parts.str(2);
  }
  static ConsoleOptions watched() {
    ConsoleOptions options;
    options.watch_address = "127.0.0.1";
    return options;
  }
  static std::string asked(int port, const std::string& token, const std::string& path,
                           const std::string& until = "") {
    RawRequest request;
    request.method = "GET";
    request.host = "127.0.0.1:" + std::to_string(port);
    request.target = path + "?token=" + token;
    request.body.clear();
    RawClient client(port);
    client.send(request.text());
    return client.receive(RawClient::kForever, until);
  }
  std::string posted(int port, const std::string& token, const std::string& path,
                     const std::string& body) const {
    RawRequest request;
    request.host = "127.0.0.1:" + std::to_string(port);
    request.target = path;
    request.token = token;
    request.body = body;
    RawClient client(port);
    client.send(request.text());
    return client.receive(RawClient::kForever);
  }

  SessionControl control_;
  Console console_{control_, watched()};
  int port_{0};
  std::string token_;
};

TEST_F(ConsoleWatchTest, ShowsTheSessionAndNothingToPress) {
  EXPECT_THAT(asked(port_, token_, "/"), HasSubstr("<html lang=\"en\" data-watch>"));
  EXPECT_THAT(asked(port_, token_, "/events", "\n\n"), HasSubstr("\"state\""));
  EXPECT_THAT(asked(console_.port(), console_.token(), "/"), Not(HasSubstr("data-watch>")));
}

TEST_F(ConsoleWatchTest, ThePageSaysWhetherATerminalStopsTheForce) {
  ConsoleOptions options;
  options.terminal = true;
  const Console other(control_, options);
  EXPECT_THAT(asked(other.port(), other.token(), "/"),
              HasSubstr("<html lang=\"en\" data-terminal>"));
  EXPECT_THAT(asked(console_.port(), console_.token(), "/"), Not(HasSubstr("data-terminal>")));
}

TEST_F(ConsoleWatchTest, TakesNothing) {
  EXPECT_EQ(status_of(posted(port_, token_, "/ask", R"({"request":"emergency_stop"})")), 404);
  EXPECT_EQ(status_of(posted(port_, token_, "/note", R"({"text":"x"})")), 404);
  EXPECT_EQ(status_of(posted(port_, token_, "/answer", R"({"number":1,"text":"1"})")), 404);
  EXPECT_EQ(status_of(posted(port_, token_, "/events", "{}")), 405);
  EXPECT_EQ(status_of(asked(port_, token_, "/mirror")), 404);
  EXPECT_THAT(control_.take(), IsEmpty());
}

TEST_F(ConsoleWatchTest, ATokenOpensItsOwnServerAlone) {
  EXPECT_NE(token_, console_.token());
  EXPECT_EQ(status_of(asked(port_, console_.token(), "/events")), 403);
  EXPECT_EQ(status_of(asked(console_.port(), token_, "/events")), 403);
  EXPECT_EQ(status_of(posted(console_.port(), token_, "/ask", R"({"request":"end"})")), 403);
  EXPECT_EQ(status_of(asked(port_, "", "/")), 403);
  EXPECT_THAT(control_.take(), IsEmpty());
}

TEST(ConsoleWatchAddressTest, IsOfOneInterfaceAndNotThereByDefault) {
  SessionControl control;
  EXPECT_EQ(Console(control).watch_url(), "");
  for (const char* address : {"0.0.0.0", "::", "localhost", "evil.example"}) {
    ConsoleOptions options;
    options.watch_address = address;
    EXPECT_THROW(Console(control, options), InputError) << address;
  }
}

}  // namespace

// Channels in the status that the console's page gets, and how the page shows them.

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
}  // namespace haptrial::experiments::console_watch_test
