// The copy of the console that only looks.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "core/base/error.h"
#include "experiments/console/console.h"
#include "tests/experiments/console_client.h"

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
}  // namespace haptrial::experiments::console_watch_test
