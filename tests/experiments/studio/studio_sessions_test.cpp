// Sessions with participants from the studio, and what a crowd or a hostile file can do to it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "core/base/file_text.h"
#include "experiments/studio/session_files.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/studio/studio_fixture.h"
#include "tests/support/wait.h"

namespace haptrial::studio_sessions_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::body_of;
using test::RawClient;
using test::RawRequest;
using test::status_of;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

class StudioSessionsTest : public test::StudioTest {
 protected:
  json choice(const json& more = json::object()) const {
    json all{{"file", "mine.toml"}, {"devices", {"virtual"}}};
    all.update(more);
    return all;
  }
  /// Starts a session and waits for its console. @returns the console's address
  std::string console_of(const json& asked) const {
    post("/begin", asked);
    std::string url;
    test::wait_until([&] {
      const json session = get("/session");
      url = session["console"];
      return !url.empty() || session["state"] != "running";
    });
    EXPECT_FALSE(url.empty()) << get("/session")["output"];
    return url;
  }
  json session_ended() const {
    json session;
    test::wait_until([&] {
      session = get("/session");
      return session["state"] != "running";
    });
    return session;
  }
  json next() const { return get("/study", "file=mine.toml")["roster"]["next"]; }
};

TEST_F(StudioSessionsTest, TheChecklistIsThatOfStart) {
  const json found = post("/checklist", choice());
  EXPECT_EQ(found["command"],
            "haptrial start mine.toml --device virtual --console --out out/mine --check");
  EXPECT_EQ(found["run"], "haptrial run mine.toml --device virtual --console --out out/mine");
  EXPECT_EQ(found["participant"], "P01");
  EXPECT_TRUE(found["ready"]);
  EXPECT_EQ(found["checks"][0]["what"], "participant");
  const json broken = post("/checklist", choice({{"session", 7}}));
  EXPECT_FALSE(broken["ready"]);
  EXPECT_THAT(broken["checks"][0]["found"].get<std::string>(), HasSubstr("--session is 7"));
  const json refused = post("/checklist", choice({{"devices", {"mouse"}}}));
  EXPECT_THAT(refused["failure"].get<std::string>(), HasSubstr("add --window"));
  EXPECT_FALSE(fs::exists(folder_ / "out/mine/P01.h5.partial")) << "a checklist records nothing";
}

TEST_F(StudioSessionsTest, IsEndedAndResumedAndEveryViewIsUpToDate) {
  EXPECT_TRUE(get("/session")["job"].is_null());
  {
    test::ConsolePerson experimenter(console_of(choice({{"subject", "P01"}})));
    ASSERT_TRUE(experimenter.ask("start"));
    ASSERT_TRUE(experimenter.sees("running"));
  }
  expect_refused(posting("/begin", choice({{"subject", "P02"}})), 503,
                 "a session is running already");
  post("/cancel", {{"job", get("/session")["job"]}});
  json session = session_ended();
  EXPECT_EQ(session["state"], "cancelled");
  EXPECT_EQ(session["console"], "") << "the console has gone";
  EXPECT_THAT(session["output"].get<std::string>(), HasSubstr("continue with --resume"));
  const json unfinished = get("/study", "file=mine.toml")["roster"]["participants"];
  ASSERT_THAT(unfinished, SizeIs(1));
  EXPECT_EQ(unfinished[0]["sessions"][0]["state"], "unfinished");
  EXPECT_EQ(get("/study", "file=mine.toml")["last_event"]["file"], "out/mine/P01.h5.partial");
  EXPECT_EQ(get("/study", "file=mine.toml")["sessions"], 0) << "none is finished";

  test::ConsolePerson again(console_of(choice({{"subject", "P01"}, {"resume", true}})));
  ASSERT_TRUE(again.sees("instructions"));
  ASSERT_TRUE(again.ask("end"));
  session = session_ended();
  EXPECT_EQ(session["state"], "done") << session["output"];
  EXPECT_TRUE(fs::exists(folder_ / "out/mine/P01.h5"));
  EXPECT_EQ(next()[0]["subject"], "P02");
  EXPECT_EQ(get("/sessions", "file=mine.toml")["folders"][0]["sessions"][0]["name"], "P01.h5");
  EXPECT_EQ(get("/study", "file=mine.toml")["report"], "none");
}

TEST_F(StudioSessionsTest, ASessionThatEndsWithTheStudioKeepsItsFile) {
  {
    test::ConsolePerson experimenter(console_of(choice({{"subject", "P01"}})));
    ASSERT_TRUE(experimenter.ask("start"));
    ASSERT_TRUE(experimenter.sees("running"));
  }
  studio_.reset();
  const test::CommandResult info =
      test::run_command("haptrial info '" + (folder_ / "out/mine/P01.h5.partial").string() + "'");
  EXPECT_THAT(info.output, HasSubstr("intact: every tick is recorded"));
  EXPECT_THAT(info.output, HasSubstr("interrupted"));
}

TEST_F(StudioSessionsTest, WordsThatNoSessionHasAreRefused) {
  for (const auto& [key, value] :
       std::vector<std::pair<const char*, json>>{{"subject", "--help"},
                                                 {"subject", "../P01"},
                                                 {"devices", {"replay:x.h5"}},
                                                 {"devices", {"--library=x.so"}},
                                                 {"consent", "--out=/tmp"},
                                                 {"consent", "a\nb"},
                                                 {"handedness", "none"},
                                                 {"language", "-de"},
                                                 {"watch", "evil.example"},
                                                 {"watch", "--remote"}}) {
    for (const char* path : {"/checklist", "/begin", "/card"}) {
      expect_refused(posting(path, choice({{key, value}})), 400, "allowed: ");
    }
  }
  for (const json& devices :
       {json{1}, json("virtual"), json{{"a", "virtual"}}, json{"a", "b", "c", "d", "e"}}) {
    expect_refused(posting("/begin", choice({{"devices", devices}})), 400, "are not up to 4 names");
  }
  expect_refused(posting("/begin", choice({{"file", "../mine.toml"}})), 400, "within the folder");
  expect_refused(posting("/device_test", {{"device", "--certificate"}, {"seconds", 1}}), 400,
                 "the name of one");
  expect_refused(
      posting("/hand_over", {{"file", "mine.toml"}, {"folder", "out"}, {"format", "csv"}}), 400,
      "not a folder of sessions");
  EXPECT_THAT(get("/jobs")["jobs"], IsEmpty());
  EXPECT_FALSE(fs::exists(folder_ / "out/mine"));
}

TEST(StudioSessionWordsTest, OnlyAddressesOfThisProgramAreLinks) {
  const std::string token(32, 'a');
  const experiments::SessionAddresses none = experiments::addresses_in(
      "console: javascript:alert(1)\nconsole: http://evil.example:80/?token=" + token +
      "\nconsole: http://127.0.0.1:80/?token=" + token +
      "\"><b>\nwatch: http://evil.example:1/?token=" + token + "\n");
  EXPECT_EQ(none.console, "");
  EXPECT_EQ(none.watch, "");
  const std::string console = "http://127.0.0.1:80/?token=" + token;
  const std::string watch = "http://192.168.1.20:81/?token=" + token;
  const experiments::SessionAddresses both =
      experiments::addresses_in("a\nconsole: " + console + "\nwatch: " + watch + "\nb");
  EXPECT_EQ(both.console, console);
  EXPECT_EQ(both.watch, watch);
}

TEST_F(StudioSessionsTest, TheEmergencyCardIsAFileBesideTheSessions) {
  const json made = post("/card", choice());
  EXPECT_EQ(made["command"],
            "haptrial start mine.toml --device virtual --console --out out/mine --card "
            "out/mine-card-001.html");
  const std::string card = exchange(reading("/file", "file=out/mine-card-001.html"));
  EXPECT_THAT(card, HasSubstr("Emergency card: mine"));
  EXPECT_THAT(card, AllOf(HasSubstr("Press EMERGENCY STOP on the experimenter&#39;s page"),
                          HasSubstr("Press Ctrl-C in the terminal in which haptrial runs"),
                          Not(HasSubstr("Escape in the terminal"))))
      << "a session of the studio reads no terminal";
  EXPECT_EQ(post("/card", choice())["file"], "out/mine-card-002.html");
}

TEST_F(StudioSessionsTest, DevicesAndTheirTestsAreThoseOfTheCommands) {
  const json found = get("/devices");
  EXPECT_EQ(found["command"], "haptrial devices");
  EXPECT_EQ(found["rows"][0][0], "virtual");
  EXPECT_EQ(found["rows"][0][1], "ready");
  const json test = post("/device_test", {{"device", "virtual"}, {"seconds", 1}});
  EXPECT_EQ(test["command"], "haptrial device-test virtual --seconds 1");
  ended(test["job"]);
  EXPECT_THAT(get("/job", "job=1")["output"].get<std::string>(), HasSubstr("ticks"));
}

TEST_F(StudioSessionsTest, DevicesAndChannelsAreReadWithoutForceOrFile) {
  const json device = post("/read_device", {{"device", "virtual"}, {"seconds", 1}});
  EXPECT_EQ(device["command"], "haptrial device-test virtual --read --seconds 1");
  EXPECT_EQ(ended(device["job"])["state"], "done");
  EXPECT_THAT(get("/job", "job=1")["output"].get<std::string>(),
              AllOf(HasSubstr("without force"), HasSubstr(" mm   buttons none")));
  const json channels = post("/read_channels", {{"file", "mine.toml"}, {"seconds", 1}});
  EXPECT_EQ(channels["command"], "haptrial record mine.toml --seconds 1");
  EXPECT_EQ(ended(channels["job"])["state"], "failed");
  EXPECT_THAT(get("/job", "job=2")["output"].get<std::string>(),
              HasSubstr("mine.toml: has no channels"));
  expect_refused(posting("/read_device", {{"device", "--read"}, {"seconds", 1}}), 400,
                 "the name of one");
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(StudioSessionsTest, SessionsAreWrittenForOtherPrograms) {
  const json started = post("/rehearse", {{"file", "mine.toml"}, {"subjects", 1}});
  ASSERT_EQ(ended(started["job"])["state"], "done");
  const json body{{"file", "mine.toml"}, {"folder", "out/mine-rehearsal-001"}, {"format", "csv"}};
  const json made = post("/hand_over", body);
  EXPECT_EQ(made["command"],
            "haptrial export --csv out/mine-rehearsal-001-csv-001 out/mine-rehearsal-001");
  ASSERT_EQ(ended(made["job"])["state"], "done");
  const json held = get("/sessions", "file=mine.toml");
  EXPECT_THAT(held["folders"], SizeIs(1)) << "an export is no folder of sessions";
  EXPECT_EQ(held["exports"][0]["folder"], "out/mine-rehearsal-001-csv-001");
  EXPECT_THAT(held["exports"][0]["files"], Not(IsEmpty()));
  json other = body;
  other["format"] = "xls";
  expect_refused(posting("/hand_over", other), 400, "allowed: csv, bids, pdf");
}

TEST_F(StudioSessionsTest, AScriptInAFileStaysAFile) {
  fs::create_directories(folder_ / "out/mine");
  const std::string script = "<script>parent.hit = 1; fetch('http://evil.example')</script>";
  write_text(folder_ / "out/mine/report.html", script);
  write_text(folder_ / "out/mine/figure.svg",
             "<svg xmlns='http://www.w3.org/2000/svg'>" + script + "</svg>");
  for (const char* name : {"report.html", "figure.svg"}) {
    const std::string shown = exchange(reading("/file", std::string("file=out/mine/") + name));
    EXPECT_THAT(
        shown, AllOf(HasSubstr("Content-Security-Policy: sandbox allow-popups; default-src 'none'"),
                     Not(HasSubstr("allow-scripts")), Not(HasSubstr(studio_->token()))));
  }
  const std::string name = "<img src=x onerror=alert(1)>.h5";
  write_text(folder_ / "out/mine" / name, "no session");
  EXPECT_EQ(get("/sessions", "file=mine.toml")["folders"][0]["sessions"][0]["name"], name);
}

/// Memory of this process that lies in RAM [bytes].
std::size_t resident_memory() {
  std::ifstream in("/proc/self/statm");
  std::size_t all = 0, resident = 0;
  in >> all >> resident;
  return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

TEST_F(StudioSessionsTest, AHundredPagesAtOnceAreAllAnsweredInBoundedMemory) {
  constexpr int kPages = 100;
  constexpr std::size_t kMostGrowth = 300'000'000;  // [bytes]
  const std::size_t before = resident_memory();
  std::vector<std::array<int, 3>> states(kPages);
  std::vector<std::thread> pages;
  for (auto& state : states) {
    pages.emplace_back([this, &state] {
      state = {status_of(exchange(reading("/"))), status_of(exchange(reading("/studies"))),
               status_of(exchange(reading("/study", "file=mine.toml")))};
    });
  }
  for (std::thread& page : pages) {
    page.join();
  }
  EXPECT_THAT(states, testing::Each(ElementsAre(200, 200, 200)));
  EXPECT_LT(resident_memory() - std::min(before, resident_memory()), kMostGrowth);
  EXPECT_EQ(studio_->refused(), 0u);
}

TEST_F(StudioSessionsTest, SilentClientsKeepNobodyWaiting) {
  std::vector<std::unique_ptr<RawClient>> silent;
  for (int i = 0; i < 300; ++i) {
    silent.push_back(std::make_unique<RawClient>(studio_->port()));
    silent.back()->send(i % 2 == 0 ? "" : "GET /studies?token=");
  }
  EXPECT_THAT(get("/studies")["files"], ElementsAre("mine.toml"));
}

}  // namespace
}  // namespace haptrial::studio_sessions_test
