#include "experiments/console/console.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "core/base/error.h"
#include "experiments/console/console_messages.h"
#include "experiments/server/access.h"
#include "experiments/server/listener.h"
#include "experiments/server/request_filter.h"
#include "tests/experiments/console_client.h"

namespace haptrial::experiments {
namespace {

using nlohmann::json;
using test::RawClient;
using test::RawRequest;
using test::status_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class ConsoleTest : public ::testing::Test {
 protected:
  /// Request that a page would send.
  static RawRequest good(const Console& console) {
    RawRequest request;
    request.host = "127.0.0.1:" + std::to_string(console.port());
    request.token = console.token();
    return request;
  }

  static std::string exchange(const Console& console, const std::string& request) {
    RawClient client(console.port());
    client.send(request);
    return client.receive(RawClient::kForever);
  }

  static std::string exchange(const Console& console, const RawRequest& request) {
    return exchange(console, request.text());
  }

  static RawRequest reading(const Console& console, const std::string& path) {
    RawRequest request = good(console);
    request.method = "GET";
    request.target = path + "?token=" + console.token();
    request.token.reset();
    request.body.clear();
    return request;
  }

  /// The names of the requests and the texts of the notes that the session would get.
  std::vector<std::string> messages() {
    std::vector<std::string> all;
    for (const auto& message : control_.take()) {
      all.push_back(message.is_note ? message.text : name_of(message.request));
    }
    return all;
  }

  /// Expects that a request is refused with this status, is logged once, reaches nobody, and leaves
  /// the console at work.
  void expect_refused(const Console& console, const std::string& request, int status,
                      const std::string& sentence) {
    const std::uint64_t before = console.refused();
    const std::string answer = exchange(console, request);
    EXPECT_EQ(status_of(answer), status) << request.substr(0, 300) << "\n" << answer;
    EXPECT_EQ(console.refused(), before + 1) << request.substr(0, 300);
    ASSERT_FALSE(console.refusals().empty());
    EXPECT_THAT(console.refusals().back(), HasSubstr(sentence));
    EXPECT_THAT(console.refusals().back(), HasSubstr(std::to_string(status)));
    EXPECT_THAT(messages(), IsEmpty()) << request.substr(0, 300);
    EXPECT_EQ(status_of(exchange(console, good(console))), 200) << "the console goes on";
    EXPECT_THAT(messages(), ElementsAre("pause"));
  }

  SessionControl control_;
};

TEST_F(ConsoleTest, RequestsAndNotesReachTheSessionInOrder) {
  const Console console(control_);
  std::vector<std::string> sent;
  for (const char* name :
       {"start", "pause", "repeat", "skip", "abort", "end", "emergency_stop", "clear", "start"}) {
    RawRequest request = good(console);
    request.body = json{{"request", name}}.dump();
    EXPECT_EQ(status_of(exchange(console, request)), 200);
    sent.push_back(name);
    request.target = "/note";
    const std::string note = "after \"" + std::string(name) + "\", größer\n2nd line";
    request.body = json{{"text", note}}.dump();
    EXPECT_EQ(status_of(exchange(console, request)), 200);
    sent.push_back(note);
  }
  EXPECT_EQ(messages(), sent);
  EXPECT_EQ(console.refused(), 0u);
}

TEST_F(ConsoleTest, AnEmergencyStopActsBeforeItIsAnswered) {
  std::atomic<int> stops{0};
  control_.on_emergency([&stops] { ++stops; });
  const Console console(control_);
  RawRequest request = good(console);
  request.body = R"({"request":"emergency_stop"})";
  EXPECT_EQ(status_of(exchange(console, request)), 200);
  EXPECT_EQ(stops, 1);
}

TEST_F(ConsoleTest, ThePageIsTheSourceWithItsNonceAndLoadsNothingElse) {
  const Console console(control_);
  const std::string answer = exchange(console, reading(console, "/"));
  ASSERT_EQ(status_of(answer), 200);
  const std::string mark = "script-src 'nonce-";
  const auto at = answer.find(mark);
  ASSERT_NE(at, std::string::npos);
  const std::string nonce = answer.substr(at + mark.size(), 32);
  const std::string page = answer.substr(answer.find("\r\n\r\n") + 4);
  EXPECT_EQ(page, page_with_nonce(console_page_template(), nonce));
  EXPECT_THAT(page, HasSubstr("<script nonce=\"" + nonce));
  EXPECT_THAT(page, Not(HasSubstr(console.token())));
  for (const char* elsewhere : {"http://", "https://", "src=", "@import", "url("}) {
    EXPECT_THAT(page, Not(HasSubstr(elsewhere)));
  }
  EXPECT_THAT(answer, HasSubstr("frame-ancestors 'none'"));
  EXPECT_THAT(answer, HasSubstr("Referrer-Policy: no-referrer"));
  EXPECT_THAT(answer, Not(HasSubstr("Access-Control")));
  EXPECT_THAT(answer, Not(HasSubstr("Set-Cookie")));
  const std::string second = exchange(console, reading(console, "/"));
  EXPECT_THAT(second, Not(HasSubstr(nonce))) << "a nonce is used once";
}

// Binary bytes as they are, to those who have the token, while a page asks something with a
// picture.
TEST_F(ConsoleTest, ThePictureOfAPageIsServedWhileItIsAsked) {
  const Console console(control_);
  EXPECT_EQ(status_of(exchange(console, reading(console, "/picture"))), 404);
  const std::string bytes("\x89PNG\r\n\x1a\n\0\xff\r\n\r\n more", 20);
  SessionStatus status;
  status.asked.number = 3;
  status.asked.picture = std::make_shared<std::string>(bytes);
  control_.publish(status);
  const std::string answer = exchange(console, reading(console, "/picture"));
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_THAT(answer, HasSubstr("Content-Type: image/png"));
  EXPECT_EQ(answer.substr(answer.find("\r\n\r\n") + 4), bytes);
  EXPECT_EQ(json::parse(status_json(status, 0))["asked"]["picture"], true);
  RawRequest stranger = reading(console, "/picture");
  stranger.target = "/picture?token=" + std::string(32, '0');
  EXPECT_EQ(status_of(exchange(console, stranger)), 403);
}

// What the participant sees, only to those who have the token, and only if there is a window.
TEST_F(ConsoleTest, ThePictureOfTheWindowIsServedWhileThereIsOne) {
  const Console console(control_);
  EXPECT_EQ(status_of(exchange(console, reading(console, "/mirror"))), 404);
  int asked = 0;
  control_.on_mirror([&asked] {
    ++asked;
    return "\x89PNG of the window";
  });
  const std::string answer = exchange(console, reading(console, "/mirror"));
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_THAT(answer, HasSubstr("Content-Type: image/png"));
  EXPECT_EQ(answer.substr(answer.find("\r\n\r\n") + 4), "\x89PNG of the window");
  RawRequest stranger = reading(console, "/mirror");
  stranger.target = "/mirror?token=" + std::string(32, '0');
  EXPECT_EQ(status_of(exchange(console, stranger)), 403);
  EXPECT_EQ(asked, 1) << "nobody else makes the screen copy a picture";
  control_.on_mirror([]() -> std::string { throw RunError("the screen showed no picture"); });
  EXPECT_EQ(status_of(exchange(console, reading(console, "/mirror"))), 503);
  control_.on_mirror(nullptr);
  EXPECT_EQ(status_of(exchange(console, reading(console, "/mirror"))), 404);
}

TEST_F(ConsoleTest, TheUrlOpensThePage) {
  const Console console(control_);
  const std::string start = "http://127.0.0.1:" + std::to_string(console.port());
  ASSERT_EQ(console.url(), start + "/?token=" + console.token());
  RawRequest request = reading(console, "/");
  request.target = console.url().substr(start.size());
  EXPECT_EQ(status_of(exchange(console, request)), 200);
  request.host = "localhost:" + std::to_string(console.port());
  EXPECT_EQ(status_of(exchange(console, request)), 200);
}

TEST_F(ConsoleTest, TokensAreLongAndDiffer) {
  std::set<std::string> seen;
  for (int i = 0; i < 100; ++i) {
    const std::string token = make_token();
    EXPECT_EQ(token.size(), 32u);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
    seen.insert(token);
  }
  EXPECT_EQ(seen.size(), 100u);
}

TEST_F(ConsoleTest, EventsShowTheStatusAgainAndAgain) {
  SessionStatus status;
  status.subject = "S01";
  status.state = "running";
  status.trials = 72;
  status.target_force = 1.25;
  status.position = {0.01, -0.02, 0.03};
  status.simulated = true;
  control_.publish(status);
  const Console console(control_);
  RawClient client(console.port());
  client.send(reading(console, "/events").text());
  std::string heard;
  std::vector<json> events;
  const auto hear = [&] {
    heard += client.receive(RawClient::kForever, "\n\n");
    events.clear();
    for (auto at = heard.find("data: "); at != std::string::npos;
         at = heard.find("data: ", at + 1)) {
      const auto end = heard.find("\n\n", at);
      if (end != std::string::npos) {
        events.push_back(json::parse(heard.substr(at + 6, end - at - 6)));
      }
    }
  };
  while (events.size() < 5) {
    hear();
  }
  status.target_force = 2.5;
  control_.publish(status);
  while (events.back()["target_force"] != 2.5) {
    hear();
  }
  EXPECT_EQ(status_of(heard), 200);
  EXPECT_THAT(heard, HasSubstr("Content-Type: text/event-stream"));
  EXPECT_EQ(events.front()["subject"], "S01");
  EXPECT_EQ(events.front()["state"], "running");
  EXPECT_EQ(events.front()["trials"], 72);
  EXPECT_EQ(events.front()["target_force"], 1.25);
  EXPECT_EQ(events.front()["position"], json({0.01, -0.02, 0.03}));
  EXPECT_EQ(events.front()["simulated"], true);
}

TEST_F(ConsoleTest, StatusWithOddValuesIsStillJson) {
  SessionStatus status;
  status.applied_force = std::numeric_limits<double>::quiet_NaN();
  status.position.x() = std::numeric_limits<double>::infinity();
  status.fault = "not UTF-8: \xff, a quote \" and\na line";
  const std::string line = status_json(status, 7);
  EXPECT_EQ(line.find('\n'), std::string::npos) << "an event is one line";
  const json read = json::parse(line);
  EXPECT_TRUE(read["applied_force"].is_null());
  EXPECT_TRUE(read["position"][0].is_null());
  EXPECT_EQ(read["refused"], 7);
  EXPECT_TRUE(read["left"].is_null()) << "not known yet";
}

TEST_F(ConsoleTest, TheStatusHasWhatAnExperimenterLooksFor) {
  SessionStatus status;
  status.pilot = true;
  status.elapsed = 754.0;
  status.left = 480.0;
  status.aborts = {"trial 3: the hand was too fast"};
  status.figures.emplace();
  status.figures->track = {{500.0, 1}, {460.0, 0}};
  const json read = json::parse(status_json(status, 0));
  EXPECT_EQ(read["pilot"], true);
  EXPECT_EQ(read["elapsed"], 754.0);
  EXPECT_EQ(read["left"], 480.0);
  EXPECT_EQ(read["aborts"][0], "trial 3: the hand was too fast");
  EXPECT_EQ(read["figures"]["track"][1]["level"], 460.0);
  EXPECT_EQ(read["figures"]["track"][1]["correct"], 0);
}

TEST_F(ConsoleTest, ANoteMayMarkATrialAsBad) {
  EXPECT_FALSE(parse_note(R"({"text": "moved the chair"})").bad_trial);
  const ConsoleNote bad = parse_note(R"({"text": "sneezed", "bad_trial": true})");
  EXPECT_EQ(bad.text, "sneezed");
  EXPECT_TRUE(bad.bad_trial);
  EXPECT_THROW(parse_note(R"({"text": "sneezed", "bad_trial": 1})"), InputError);
  EXPECT_THROW(parse_note(R"({"text": "sneezed", "other": true})"), InputError);
}

TEST_F(ConsoleTest, RefusesWhoLacksTheToken) {
  const Console console(control_);
  RawRequest request = good(console);
  request.token.reset();
  expect_refused(console, request.text(), 403, "the token is missing");
  request.target = "/ask?token=" + console.token();  // as a form of a foreign page could
  expect_refused(console, request.text(), 403, "the token is missing");
  request.target = "/ask";
  for (std::string token : {std::string(32, '0'), console.token().substr(0, 31),
                            console.token() + "0", std::string(4000, 'a')}) {
    request.token = token;
    expect_refused(console, request.text(), 403, "the token is wrong");
  }
  for (const char* path : {"/", "/events"}) {
    RawRequest read = reading(console, path);
    read.target = path;
    expect_refused(console, read.text(), 403, "the token is missing");
    read.target += "?token=wrong";
    expect_refused(console, read.text(), 403, "the token is wrong");
  }
}

TEST_F(ConsoleTest, RefusesOtherHostsAndPages) {
  const Console console(control_);
  const std::string port = std::to_string(console.port());
  for (const std::string& host :
       {std::string("evil.example"), "evil.example:" + port, std::string("127.0.0.1"),
        "127.0.0.1:" + port + "0", "127.0.0.1:" + port + "@evil.example", std::string()}) {
    RawRequest request = good(console);
    request.host = host;
    expect_refused(console, request.text(), 421, "the Host is not");
  }
  RawRequest none = good(console);
  none.host.reset();
  expect_refused(console, none.text(), 421, "the Host is not");
  RawRequest two = good(console);
  two.more = "Host: evil.example\r\n";
  expect_refused(console, two.text(), 421, "the Host is not");
  for (const std::string& origin :
       {std::string("http://evil.example"), std::string("null"), "https://127.0.0.1:" + port,
        "http://127.0.0.1:" + port + ".evil.example", std::string("http://127.0.0.1:1")}) {
    RawRequest request = good(console);
    request.more = "Origin: " + origin + "\r\n";
    expect_refused(console, request.text(), 403, "the Origin is another page");
  }
  for (const char* site : {"cross-site", "same-site"}) {
    RawRequest request = good(console);
    request.more = std::string("Sec-Fetch-Site: ") + site + "\r\n";
    expect_refused(console, request.text(), 403, "another site asks");
  }
  RawRequest own = good(console);
  own.more = "Origin: http://127.0.0.1:" + port + "\r\nSec-Fetch-Site: same-origin\r\n";
  EXPECT_EQ(status_of(exchange(console, own)), 200);
}

TEST_F(ConsoleTest, RefusesUnknownPathsAndMethods) {
  const Console console(control_);
  for (const char* path : {"/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "//ask", "/ask/",
                           "/ask/../ask", "/ASK", "/favicon.ico", "/ask%00"}) {
    RawRequest request = good(console);
    request.target = path;
    expect_refused(console, request.text(), 404, "no such page");
  }
  for (const char* method : {"GET", "PUT", "DELETE", "OPTIONS", "PATCH", "HEAD"}) {
    RawRequest request = good(console);
    request.method = method;
    request.body.clear();
    expect_refused(console, request.text(), 405, "POST only");
  }
  RawRequest post = good(console);
  post.target = "/events";
  expect_refused(console, post.text(), 405, "GET only");
}

TEST_F(ConsoleTest, RefusesOversizedRequests) {
  const Console console(control_);
  RawRequest request = good(console);
  request.body = R"({"request":")" + std::string(4096, 'x') + "\"}";
  expect_refused(console, request.text(), 413, "bytes; allowed: 4096");
  request.body = "{}";
  request.length = "99999999999999999999999";
  expect_refused(console, request.text(), 413, "too long");
  request.length = "-1";
  expect_refused(console, request.text(), 411, "Content-Length");
  request = good(console);
  request.more = "X-Long: " + std::string(20000, 'x') + "\r\n";
  expect_refused(console, request.text(), 431, "too large");
  request.more.clear();
  for (int i = 0; i < 5000; ++i) {
    request.more += "A: b\r\n";
  }
  expect_refused(console, request.text(), 431, "too large");
  request = good(console);
  request.target = "/" + std::string(10000, 'a');
  expect_refused(console, request.text(), 414, "malformed");
}

TEST_F(ConsoleTest, RefusesBodiesInDisguise) {
  const Console console(control_);
  RawRequest request = good(console);
  request.type = "text/plain";  // what a form of a foreign page may send unasked
  expect_refused(console, request.text(), 415, "application/json");
  request.type = "multipart/form-data; boundary=x";
  expect_refused(console, request.text(), 415, "application/json");
  request.type.reset();
  expect_refused(console, request.text(), 415, "application/json");
  request = good(console);
  request.more = "Content-Encoding: gzip\r\n";  // 4 KiB could become 4 MiB
  expect_refused(console, request.text(), 415, "application/json");
  request = good(console);
  request.more = "Transfer-Encoding: chunked\r\n";
  expect_refused(console, request.text(), 411, "Content-Length");
}

TEST_F(ConsoleTest, RefusesMalformedMessages) {
  const Console console(control_);
  for (const std::string& body :
       {std::string("{"), std::string(), std::string("nonsense"), std::string("\xff\xfe"),
        std::string(4000, '['), std::string("{\"request\":\"pa\0use\"}", 20)}) {
    RawRequest request = good(console);
    request.body = body;
    expect_refused(console, request.text(), 400, "not JSON");
  }
  for (const char* body : {"[]", "{}", "3", R"({"request":1})", R"({"request":["pause"]})",
                           R"({"request":"pause","more":1})", R"({"text":"pause"})"}) {
    RawRequest request = good(console);
    request.body = body;
    expect_refused(console, request.text(), 400, "\"request\" alone");
  }
  RawRequest request = good(console);
  request.body = R"({"request":"self_destruct"})";
  expect_refused(console, request.text(), 400, "allowed: start, pause, repeat");
  request.target = "/note";
  request.body = json{{"text", std::string(2001, 'x')}}.dump();
  expect_refused(console, request.text(), 400, "the note has 2001 bytes");
  request.body = R"({"text":" \n "})";
  expect_refused(console, request.text(), 400, "the note has 3 bytes");
}

TEST_F(ConsoleTest, RefusesWhatIsNotHttp) {
  const Console console(control_);
  for (const std::string& text :
       {std::string("nonsense\r\n\r\n"), std::string("GET\r\n\r\n"),
        std::string("GET / HTTP/9.9\r\n\r\n"), std::string("\x16\x03\x01\x02\x00\r\n\r\n", 9)}) {
    expect_refused(console, text, 400, "malformed");
  }
  RawRequest ranges = reading(console, "/");
  ranges.more = "Range: bytes=0-1";
  while (ranges.more.size() < 8000) {  // a deep recursion in the library's regular expression
    ranges.more += ",-";
  }
  ranges.more += "\r\n";
  expect_refused(console, ranges.text(), 416, "ranges are not served");
  RawRequest injected = good(console);
  injected.target = "/x\x1b[31mred";
  expect_refused(console, injected.text(), 404, "/x?[31mred");  // a log that a terminal may show
}

TEST_F(ConsoleTest, SlowClientsAreCutOff) {
  ConsoleOptions options;
  options.request_time = 0.4;
  const Console console(control_, options);
  RawClient client(console.port());
  const std::string request = good(console).text();
  // One byte every 20 ms takes much longer than the limit for the whole.
  for (std::size_t i = 0; i + 1 < request.size() && !client.closed(); ++i) {
    client.send(request.substr(i, 1));
    client.receive(0.02);
  }
  client.receive(RawClient::kForever);
  EXPECT_TRUE(client.closed());
  ASSERT_EQ(console.refused(), 1u);
  EXPECT_THAT(console.refusals().front(), HasSubstr("408"));

  RawRequest stalled = good(console);
  stalled.length = "500";  // and never sends them
  EXPECT_NE(status_of(exchange(console, stalled)), 200);
  EXPECT_EQ(console.refused(), 2u);
  EXPECT_THAT(messages(), IsEmpty());
}

TEST_F(ConsoleTest, AConnectionThatSaysNothingIsNoRefusal) {
  ConsoleOptions options;
  options.request_time = 0.2;
  const Console console(control_, options);
  RawClient silent(console.port());  // browsers open some ahead of need
  silent.receive(RawClient::kForever);
  EXPECT_TRUE(silent.closed());
  EXPECT_EQ(console.refused(), 0u);
}

TEST_F(ConsoleTest, AnEmergencyStopGetsThroughACrowd) {
  ConsoleOptions options;
  options.request_time = 60.0;  // the crowd is not cut off by time
  options.workers = 4;
  options.event_streams = 2;
  options.waiting = 8;
  const Console console(control_, options);
  std::vector<std::unique_ptr<RawClient>> crowd;
  for (int i = 0; i < 200; ++i) {
    crowd.push_back(std::make_unique<RawClient>(console.port()));
    crowd.back()->send("POST /ask HTTP/1.1\r\nHost: ");
  }
  bool through = false;
  RawRequest request = good(console);
  request.body = R"({"request":"emergency_stop"})";
  while (!through) {  // the page tries again too
    through = status_of(exchange(console, request)) == 200;
  }
  EXPECT_THAT(messages(), ElementsAre("emergency_stop"));
  EXPECT_GE(console.refused(), 1u);
}

/// Clients that connect as fast as they can, from the page's own address.
class Flood {
 public:
  Flood(int port, const std::string& says) {
    for (int i = 0; i < 4; ++i) {
      threads_.emplace_back([this, port, says] {
        std::deque<std::unique_ptr<RawClient>> open;
        while (!over_) {
          try {
            open.push_back(std::make_unique<RawClient>(port));
            open.back()->send(says);
          } catch (const std::exception&) {  // the port's queue is full
          }
          if (open.size() > 40) {
            open.pop_front();
          }
        }
      });
    }
  }
  ~Flood() {
    over_ = true;
    for (std::thread& thread : threads_) {
      thread.join();
    }
  }

 private:
  std::atomic<bool> over_{false};
  std::vector<std::thread> threads_;
};

TEST_F(ConsoleTest, AFloodDoesNotHoldUpAnEmergencyStop) {
  for (const char* says :
       {"", "POST /ask HTTP/1.1\r\nHost: ", "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"}) {
    const Console console(control_);
    RawRequest request = good(console);
    request.body = R"({"request":"emergency_stop"})";
    const Flood flood(console.port(), says);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    for (int i = 0; i < 50; ++i) {
      EXPECT_EQ(status_of(exchange(console, request)), 200) << "at the first try";
    }
  }
}

TEST_F(ConsoleTest, WhoShowsTheTokenIsServedWhenEverybodyElseIsStuck) {
  ConsoleOptions options;
  options.request_time = 60.0;
  options.workers = 1;
  options.waiting = 1;
  const Console console(control_, options);
  std::vector<std::unique_ptr<RawClient>> stuck;
  for (int i = 0; i < 5; ++i) {
    stuck.push_back(std::make_unique<RawClient>(console.port()));
    stuck.back()->send("POST /ask HTTP/1.1\r\nHost: ");
  }
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(status_of(exchange(console, good(console))), 200);
  }
}

TEST(ShowsTokenTest, InTheHeaderOrTheAddressOnly) {
  const std::string token = "0123456789abcdef";
  EXPECT_TRUE(shows_token("POST /ask HTTP/1.1\r\nX-Haptrial-Token: " + token + "\r\n", token));
  EXPECT_TRUE(shows_token("POST /ask HTTP/1.1\r\nx-haptrial-token:" + token, token));
  EXPECT_TRUE(shows_token("GET /?token=" + token + " HTTP/1.1", token));
  EXPECT_TRUE(shows_token("GET /?token=wrong&token=" + token, token));
  EXPECT_FALSE(shows_token("GET /?token=0123456789abcdee HTTP/1.1", token));
  EXPECT_FALSE(shows_token("GET /?token=0123", token));
  EXPECT_FALSE(shows_token("token", token));
  EXPECT_FALSE(shows_token("", token));
}

TEST_F(ConsoleTest, ParallelRequestsAllArrive) {
  const Console console(control_);
  std::atomic<int> accepted{0};
  std::vector<std::thread> clients;
  for (int i = 0; i < 8; ++i) {
    clients.emplace_back([&] {
      for (int k = 0; k < 25; ++k) {
        accepted += status_of(exchange(console, good(console))) == 200 ? 1 : 0;
      }
    });
  }
  for (std::thread& client : clients) {
    client.join();
  }
  EXPECT_EQ(accepted, 200);
  EXPECT_EQ(messages().size(), 200u);
}

TEST_F(ConsoleTest, PagesAreCountedAndMakeRoomWhenTheyClose) {
  ConsoleOptions options;
  options.event_streams = 2;
  const Console console(control_, options);
  const std::string request = reading(console, "/events").text();
  RawClient first(console.port());
  first.send(request);
  EXPECT_THAT(first.receive(RawClient::kForever, "data: "), HasSubstr("data: "));
  {
    RawClient second(console.port());
    second.send(request);
    EXPECT_THAT(second.receive(RawClient::kForever, "data: "), HasSubstr("data: "));
    EXPECT_EQ(status_of(exchange(console, request)), 503);
    EXPECT_EQ(console.refused(), 1u);
  }
  std::string heard;
  while (heard.find("data: ") == std::string::npos) {
    RawClient third(console.port());
    third.send(request);
    heard = third.receive(RawClient::kForever, "data: ");
  }
}

TEST_F(ConsoleTest, EndsAtOnceWithClientsConnected) {
  ConsoleOptions options;
  options.request_time = 60.0;  // not by cutting them off
  auto console = std::make_unique<Console>(control_, options);
  RawClient page(console->port());
  page.send(reading(*console, "/events").text());
  EXPECT_THAT(page.receive(RawClient::kForever, "data: "), HasSubstr("data: "));
  RawClient slow(console->port());
  slow.send("POST /as");
  RawClient silent(console->port());
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  console.reset();
  page.receive(RawClient::kForever);
  EXPECT_TRUE(page.closed());
}

TEST_F(ConsoleTest, RefusalsAreToldUpToALimitAndCountedBeyond) {
  std::mutex mutex;
  std::vector<std::string> told;
  ConsoleOptions options;
  options.on_refusal = [&](const std::string& sentence) {
    const std::lock_guard lock(mutex);
    told.push_back(sentence);
  };
  const Console console(control_, options);
  RawRequest request = good(console);
  request.token = "wrong";
  const int many = static_cast<int>(RefusalLog::kKept) + 50;
  for (int i = 0; i < many; ++i) {
    exchange(console, request);
  }
  EXPECT_EQ(console.refused(), static_cast<std::uint64_t>(many));
  EXPECT_EQ(console.refusals().size(), RefusalLog::kKept);
  const std::lock_guard lock(mutex);
  EXPECT_EQ(told, console.refusals());
  EXPECT_THAT(told.front(), HasSubstr("POST /ask: 403: the token is wrong"));
}

TEST_F(ConsoleTest, OtherAddressesNeedTheFlag) {
  ConsoleOptions options;
  for (const char* address : {"192.0.2.1", "8.8.8.8", "2001:db8::1"}) {
    options.address = address;
    options.allow_remote = false;
    EXPECT_THROW(Console(control_, options), InputError) << address;
  }
  for (const char* address : {"0.0.0.0", "::", "", "localhost", "example.org", "127.0.0.1/8"}) {
    options.address = address;
    options.allow_remote = true;
    EXPECT_THROW(Console(control_, options), InputError) << address;
  }
  options.address = "192.0.2.1";  // documentation's network: allowed, but nobody has it
  EXPECT_THROW(Console(control_, options), RunError);
  options.address = "127.0.0.2";
  options.allow_remote = false;
  const Console other(control_, options);
  EXPECT_THAT(other.url(), HasSubstr("http://127.0.0.2:"));
}

TEST_F(ConsoleTest, HostsAreSpeltAsBrowsersSpellThem) {
  EXPECT_THAT(server_hosts("127.0.0.1", true, 80), ElementsAre("127.0.0.1:80", "localhost:80"));
  EXPECT_THAT(server_hosts("0:0::0001", true, 80), ElementsAre("[::1]:80", "localhost:80"));
  EXPECT_THAT(server_hosts("2001:DB8::a", false, 8080), ElementsAre("[2001:db8::a]:8080"));
  EXPECT_TRUE(check_server_address("::1", false));
  EXPECT_TRUE(check_server_address("127.255.0.1", false));
  EXPECT_FALSE(check_server_address("2001:db8::a", true));
}

TEST_F(ConsoleTest, ATakenPortIsAnError) {
  const Console first(control_);
  ConsoleOptions options;
  options.port = first.port();
  EXPECT_THROW(Console(control_, options), RunError);
  options.port = 70000;
  EXPECT_THROW(Console(control_, options), InputError);
}

}  // namespace
}  // namespace haptrial::experiments
