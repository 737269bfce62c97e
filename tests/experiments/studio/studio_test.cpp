// The studio's server: what it answers to each request, and what it refuses.

#include "experiments/studio/studio.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "tests/experiments/command.h"
#include "tests/experiments/studio/studio_fixture.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::studio_test {
namespace {

namespace fs = std::filesystem;
using experiments::Studio;
using experiments::StudioOptions;
using nlohmann::json;
using test::body_of;
using test::RawRequest;
using test::status_of;
using test::StudioTest;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

TEST_F(StudioTest, AnotherSenderIsRefused) {
  RawRequest request = reading("/studies");
  request.host = "evil.example:80";
  expect_refused(request, 421, "the Host is not");
  request = reading("/studies");
  request.more = "Origin: http://evil.example\r\n";
  expect_refused(request, 403, "the Origin is another page");
  request = reading("/studies");
  request.more = "Sec-Fetch-Site: cross-site\r\n";
  expect_refused(request, 403, "another site asks");
  request.more.clear();
  request.target = "/studies";
  expect_refused(request, 403, "the token is missing");
  request.target = "/studies?token=" + std::string(32, '0');
  expect_refused(request, 403, "the token is wrong");
  request = posting("/save", {{"file", "mine.toml"}, {"text", ""}, {"stamp", ""}});
  request.token.reset();
  request.target += "?token=" + studio_->token();
  expect_refused(request, 403, "the token is missing");  // a form of another page could name it so
  expect_refused(reading("/nowhere"), 404, "no such page; there are /, /library, /file");
  expect_refused(reading("/save"), 405, "POST only");
  EXPECT_THAT(text(), Not(IsEmpty()));
}

TEST_F(StudioTest, ThePageLoadsNothingFromElsewhereAndNeverTheToken) {
  const std::string answer = exchange(reading("/"));
  ASSERT_EQ(status_of(answer), 200);
  EXPECT_THAT(answer, AllOf(HasSubstr("script-src 'nonce-"), HasSubstr("frame-ancestors 'none'"),
                            HasSubstr("frame-src 'self'")));
  EXPECT_THAT(body_of(answer), Not(HasSubstr(studio_->token())));
  const std::string page(experiments::studio_page_template());
  for (const char* word : {"http://", "https://", "innerHTML", "outerHTML", "insertAdjacentHTML",
                           "document.write", "PART:", "eval("}) {
    EXPECT_THAT(page, Not(HasSubstr(word)));
  }
}

TEST_F(StudioTest, NamesThatLeadOutAreRefused) {
  const test::TemporaryFolder elsewhere;
  write_text(elsewhere / "secret.toml", "secret = 1\n");
  write_text(elsewhere / "report.html", "secret\n");
  fs::create_directories(folder_ / "out");
  fs::create_symlink(elsewhere / "secret.toml", folder_ / "link.toml");
  fs::create_directory_symlink(elsewhere.path(), folder_ / "out/mine");
  write_text(folder_ / ".hidden.toml", "x = 1\n");
  write_text(folder_ / "-x.toml", "x = 1\n");
  const std::string above = "../" + elsewhere.path().filename().string() + "/secret.toml";
  for (const std::string& path : {std::string("/text"), std::string("/study"), std::string("/file"),
                                  std::string("/sessions"), std::string("/info")}) {
    for (const std::string& name :
         {above, "out/../" + above, (elsewhere / "secret.toml").string(),
          std::string("/etc/passwd"), std::string("%2e%2e/x.toml"), std::string(".hidden.toml"),
          std::string("-x.toml"), std::string("a%00b.toml"), std::string("a%0ab.toml"),
          std::string()}) {
      expect_refused(reading(path, "file=" + name), 400, "allowed: names within the folder");
    }
    expect_refused(reading(path, "file=link.toml"), 400, "leads out of the folder");
    expect_refused(reading(path, "file=nothing.toml"), 400, "nothing.toml: No such file");
    expect_refused(reading(path), 400, "the address lacks file=");
  }
  expect_refused(reading("/file", "file=out/mine/report.html"), 400, "leads out of the folder");
  EXPECT_THAT(get("/sessions", "file=mine.toml")["folders"], IsEmpty());
  const json body{{"file", "link.toml"}, {"text", "x"}, {"stamp", ""}};
  expect_refused(posting("/save", body), 400, "leads out of the folder");
  expect_refused(posting("/validate", body), 400, "leads out of the folder");
  expect_refused(posting("/analyze", {{"file", "mine.toml"}, {"folder", "out/mine"}}), 400,
                 "leads out of the folder");
  EXPECT_EQ(file_text(elsewhere / "secret.toml"), "secret = 1\n");
}

TEST_F(StudioTest, WordsThatAreOptionsOrPathsAreRefused) {
  for (const char* name : {"--help", "../x", "a/b", "", "a b", "x.toml", "<b>"}) {
    expect_refused(posting("/new", {{"name", name}, {"from", "first_experiment"}}), 400,
                   "not a plain word");
    expect_refused(posting("/new", {{"name", "x"}, {"from", name}}), 400, "not a plain word");
  }
  expect_refused(reading("/schema", "protocol=--json-schema"), 400, "not a plain word");
  expect_refused(reading("/file", "file=mine.toml"), 400, "reports, figures and tables alone");
  expect_refused(posting("/rehearse", {{"file", "mine.toml"}, {"subjects", 0}}), 400,
                 "whole number from 1 to 10000");
  expect_refused(posting("/rehearse", {{"file", "mine.toml"}, {"subjects", "2"}}), 400,
                 "whole number from 1 to 10000");
  expect_refused(posting("/cancel", {{"job", 7}}), 400, "there is no job 7");
  expect_refused(posting("/new", json::array()), 400, "not a JSON object");
  expect_refused(posting("/new", {{"name", 3}, {"from", "first_experiment"}}), 400,
                 "lacks the text \"name\"");
  expect_refused(reading("/library", "name=../../../etc/passwd"), 404, "libjs-codemirror");
}

TEST_F(StudioTest, StudiesOfTheFolderHaveTheirState) {
  EXPECT_THAT(get("/studies")["files"], ElementsAre("mine.toml"));
  const json ready = get("/study", "file=mine.toml");
  EXPECT_EQ(ready["command"], "haptrial validate mine.toml");
  EXPECT_TRUE(ready["valid"]);
  EXPECT_THAT(ready["remarks"], IsEmpty());
  EXPECT_EQ(ready["report"], "none");
  EXPECT_EQ(ready["roster"]["command"], "haptrial roster mine.toml out/mine");
  EXPECT_EQ(ready["roster"]["groups"][0]["planned"], 6);
  EXPECT_EQ(ready["roster"]["next"][0]["subject"], "P01");
  write_text(folder_ / "draft.toml", "[experiment]\nprotocol = \"trials\"\nname = 3\n");
  write_text(folder_ / "mine.texts.de.toml", "");                                    // no study
  write_text(folder_ / "lab.toml", "[room]\ncontact = \"experimenter on duty\"\n");  // nor this
  EXPECT_THAT(get("/studies")["files"], ElementsAre("draft.toml", "mine.toml"));
  EXPECT_FALSE(get("/study", "file=draft.toml")["valid"]);
}

TEST_F(StudioTest, AScriptInANameIsAName) {
  const std::string name = "<img src=x onerror=alert(1)>'\";&.toml";
  fs::copy(folder_ / "mine.toml", folder_ / name);
  EXPECT_THAT(get("/studies")["files"], ElementsAre(name, "mine.toml"));
  const json state = get("/study", "file=%3Cimg%20src%3Dx%20onerror%3Dalert(1)%3E'%22%3B%26.toml");
  EXPECT_TRUE(state["valid"]);
  EXPECT_EQ(state["command"], "haptrial validate '<img src=x onerror=alert(1)>'\\''\";&.toml'");
}

TEST_F(StudioTest, MistakesHaveTheirLines) {
  std::string wrong = text();
  wrong.replace(wrong.find("participants = 6"), 16, "participants = -6");
  const json checked = post("/validate", {{"file", "mine.toml"}, {"text", wrong}});
  EXPECT_FALSE(checked["valid"]);
  ASSERT_THAT(checked["remarks"], SizeIs(1));
  EXPECT_EQ(checked["remarks"][0]["line"], 7);
  EXPECT_EQ(checked["remarks"][0]["text"],
            "design.participants is -6; allowed: a whole number from 1 to 100000");
  EXPECT_THAT(text(), HasSubstr("participants = 6")) << "a check saves nothing";
  EXPECT_TRUE(post("/validate", {{"file", "mine.toml"}, {"text", text()}})["valid"]);
  for (const auto& entry : fs::directory_iterator(folder_.path())) {
    EXPECT_EQ(entry.path().filename(), "mine.toml") << "nothing is left beside it";
  }
}

TEST_F(StudioTest, TextsInOtherLanguagesAreCheckedWithTheDraft) {
  const fs::path german = folder_ / "mine.texts.de.toml";
  write_text(german,
             "[response]\nquestion = \"Hat es gezogen?\"\nchoices.yes.label = \"Ja\"\n"
             "choices.nein.label = \"Nein\"\n");
  const std::string sentence =
      "mine.texts.de.toml: response.choices.nein.label is no text that participants of this "
      "definition read; did you mean response.choices.yes.label?";
  const json draft = post("/validate", {{"file", "mine.toml"}, {"text", text()}});
  const json saved = get("/study", "file=mine.toml");
  for (const json& checked : {draft, saved}) {
    EXPECT_FALSE(checked["valid"]);
    ASSERT_THAT(checked["remarks"], SizeIs(1)) << checked["remarks"];
    EXPECT_TRUE(checked["remarks"][0]["mistake"]);
    EXPECT_EQ(checked["remarks"][0]["text"], sentence);
  }
  EXPECT_THAT(
      test::run_command("cd '" + folder_.path().string() + "' && haptrial validate mine.toml")
          .output,
      IsEmpty())
      << "nothing of it is called valid";
  write_text(german, "[response]\nquestion = \"Hat es gezogen?\"\nchoices.yes.label = \"Ja\"\n");
  const json missing = post("/validate", {{"file", "mine.toml"}, {"text", text()}});
  EXPECT_TRUE(missing["valid"]);
  ASSERT_THAT(missing["remarks"], SizeIs(1)) << missing["remarks"];
  EXPECT_FALSE(missing["remarks"][0]["mistake"]);
  EXPECT_EQ(missing["remarks"][0]["text"],
            "mine.texts.de.toml: response.choices.no.label is missing; it is shown as the "
            "definition has it");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 2)
      << "nothing is left beside them";
}

TEST_F(StudioTest, AnEditOfTheFormIsOneOfTheTextAlone) {
  const std::string before = text();
  const json stated = post("/keys", {{"file", "mine.toml"}, {"text", before}});
  EXPECT_EQ(stated["command"], "haptrial set mine.toml --list");
  const auto of = [&](const char* key) {
    return *std::ranges::find_if(stated["keys"],
                                 [&](const json& each) { return each["key"] == key; });
  };
  EXPECT_EQ(of("design.participants")["value"], "6");
  EXPECT_EQ(of("design.participants")["line"], 7);
  EXPECT_TRUE(of("design")["table"]);
  const auto edit = [&](const char* key, const char* kind, const char* value) {
    return post(
        "/set",
        {{"file", "mine.toml"}, {"text", before}, {"key", key}, {"edit", kind}, {"value", value}});
  };
  std::string wanted = before;
  wanted.replace(wanted.find("participants = 6"), 16, "participants = -6");
  const json changed = edit("design.participants", "value", "-6");
  EXPECT_EQ(changed["text"], wanted) << "mistakes may be written; validate says them";
  EXPECT_EQ(changed["command"], "haptrial set mine.toml -- design.participants -6");
  EXPECT_EQ(edit("design.participants", "remove", "")["command"],
            "haptrial set mine.toml --remove design.participants");
  EXPECT_EQ(text(), before) << "nothing is saved";
  EXPECT_THAT(edit("--output=x.toml", "value", "1")["text"], HasSubstr("['--output=x']"))
      << "a key is never an option";
  EXPECT_FALSE(fs::exists(folder_ / "x.toml"));
  expect_refused(posting("/set", {{"file", "mine.toml"},
                                  {"text", before},
                                  {"key", "design.participants"},
                                  {"edit", "value"},
                                  {"value", "1\nx = 2"}}),
                 400, "one value");
  expect_refused(posting("/set", {{"file", "mine.toml"},
                                  {"text", before},
                                  {"key", "design.participants"},
                                  {"edit", "set"},
                                  {"value", 5}}),
                 400, "lacks the text \"value\"");
  expect_refused(posting("/keys", {{"file", "mine.toml"}, {"text", "a = \n"}}), 400, "mine.toml");
}

TEST_F(StudioTest, ChangesSinceTheNewestSessionAreNamed) {
  EXPECT_THAT(post("/validate", {{"file", "mine.toml"}, {"text", text()}})["since"], IsEmpty());
  ASSERT_EQ(test::run_command("cd '" + folder_.path().string() +
                              "' && haptrial dry-run mine.toml --subjects 1 --out out/mine")
                .status,
            0);
  const auto since = [&](const std::string& from, const std::string& to) {
    std::string changed = text();
    changed.replace(changed.find(from), from.size(), to);
    return post("/validate", {{"file", "mine.toml"}, {"text", changed}});
  };
  const json same = since("# The", "# This");
  EXPECT_EQ(same["command"], "haptrial validate mine.toml --since out/mine");
  EXPECT_THAT(same["since"],
              ElementsAre("since out/mine/S01.h5: only comments and layout have changed"));
  EXPECT_THAT(since("participants = 6", "participants = 8")["since"],
              ElementsAre("since out/mine/S01.h5, may change within a study: "
                          "design.participants was 6, is 8"));
  EXPECT_THAT(since("time = 1.0", "time = 2.0")["since"],
              ElementsAre(HasSubstr(", another study: stages")));
}

TEST_F(StudioTest, APilotIsNoSessionOfTheStudy) {
  const auto run = [&](const std::string& arguments) {
    const auto done =
        test::run_command("cd '" + folder_.path().string() + "' && haptrial run " +
                          "mine.toml --device virtual --trials 1 --out out/mine " + arguments);
    EXPECT_EQ(done.status, 0) << done.errors;
  };
  run("--subject T01 --pilot --set procedure.repetitions=1");
  write_text(folder_ / "out/mine/torn.h5", "no session");
  const json alone = post("/validate", {{"file", "mine.toml"}, {"text", text()}});
  EXPECT_TRUE(alone["valid"]) << alone["output"];
  EXPECT_THAT(alone["since"], IsEmpty());
  run("--subject P01");
  run("--subject T02 --pilot --set procedure.repetitions=1");
  EXPECT_THAT(post("/validate", {{"file", "mine.toml"}, {"text", text()}})["since"],
              ElementsAre("since out/mine/P01.h5: nothing has changed"));
}

TEST_F(StudioTest, AWithdrawalIsListedBeforeItIsDone) {
  ASSERT_EQ(test::run_command("cd '" + folder_.path().string() +
                              "' && haptrial dry-run mine.toml --subjects 2 --out out/mine")
                .status,
            0);
  const json asking{{"file", "mine.toml"}, {"subject", "S01"}, {"sure", false}};
  const json listed = post("/withdraw", asking);
  EXPECT_EQ(listed["command"], "haptrial withdraw out/mine S01");
  EXPECT_THAT(std::string(listed["output"]), HasSubstr("would delete out/mine/S01.h5"));
  EXPECT_TRUE(fs::exists(folder_ / "out/mine/S01.h5"));
  json sure = asking;
  sure["sure"] = true;
  post("/withdraw", sure);
  EXPECT_FALSE(fs::exists(folder_ / "out/mine/S01.h5"));
  EXPECT_TRUE(fs::exists(folder_ / "out/mine/S02.h5"));
  expect_refused(posting("/withdraw", sure), 400, "S01 has no session file");
  sure["subject"] = "--also";
  expect_refused(posting("/withdraw", sure), 400, "does not begin with -");
}

TEST_F(StudioTest, FoldersOfADefinitionWhoseNameContinuesAreThatOnes) {
  for (const char* name :
       {"mine", "mine-001", "mine-rehearsal-002", "mine-csv-001", "mine-001-bids-001",
        "mine-rehearsal-002-csv-001", "mine-2", "mine-2-csv-001", "mine-rehearsal", "mine-003",
        "mine-003-rehearsal-001", "mine-003-bids-001", "mines", "mine-power-001"}) {
    fs::create_directories(folder_ / "out" / name);
  }
  fs::copy(folder_ / "mine.toml", folder_ / "mine-2.toml");
  fs::copy(folder_ / "mine.toml", folder_ / "mine-003.toml");
  const auto names = [&](const std::string& file, const char* kind) {
    std::vector<std::string> all;
    const json view = get("/sessions", "file=" + file);
    for (const json& each : view.at(kind)) {
      all.push_back(each["folder"]);
    }
    return all;
  };
  EXPECT_THAT(names("mine.toml", "folders"),
              ElementsAre("out/mine", "out/mine-001", "out/mine-rehearsal-002"));
  EXPECT_THAT(
      names("mine.toml", "exports"),
      ElementsAre("out/mine-001-bids-001", "out/mine-csv-001", "out/mine-rehearsal-002-csv-001"));
  EXPECT_THAT(names("mine-2.toml", "folders"), ElementsAre("out/mine-2"));
  EXPECT_THAT(names("mine-2.toml", "exports"), ElementsAre("out/mine-2-csv-001"));
  EXPECT_THAT(names("mine-003.toml", "folders"),
              ElementsAre("out/mine-003", "out/mine-003-rehearsal-001"));
  EXPECT_THAT(names("mine-003.toml", "exports"), ElementsAre("out/mine-003-bids-001"));
}

TEST_F(StudioTest, APreviewIsOfTheTextAsItIsWritten) {
  std::string other = text();
  const std::string name = "name = \"";
  other.insert(other.find(name) + name.size(), "seen_before_");
  const json asked{{"file", "mine.toml"}, {"text", other}, {"trial", 2}};
  const json made = post("/preview", asked);
  EXPECT_EQ(made["command"], "haptrial show mine.toml --trial 2 --no-virtual-trial");
  const std::string page = std::to_string(made["page"].get<int>());
  const std::string shown = exchange(reading("/preview_page", "page=" + page));
  EXPECT_THAT(shown, AllOf(HasSubstr("seen_before_"), HasSubstr("mine.toml, trial 2"),
                           Not(HasSubstr("draft-"))));
  EXPECT_THAT(shown,
              HasSubstr("Content-Security-Policy: sandbox allow-scripts; script-src 'nonce-"));
  EXPECT_THAT(shown, Not(HasSubstr("allow-same-origin"))) << "the page reaches nothing";
  EXPECT_THAT(shown, HasSubstr("default-src 'none'"));
  EXPECT_THAT(shown, Not(HasSubstr("nonce=\"NONCE\"")));
  expect_refused(reading("/preview_page", "page=" + page), 400, "was shown before");
  expect_refused(reading("/preview_page", "page=../../x"), 400, "is not a whole number");

  json wrong = asked;
  wrong["text"] = "# nothing\n";
  const json refused = post("/preview", wrong);
  EXPECT_FALSE(refused.contains("page"));
  EXPECT_THAT(refused["failure"].get<std::string>(), HasSubstr("mine.toml"));
  for (const auto& entry : fs::directory_iterator(folder_.path())) {
    EXPECT_EQ(entry.path().filename(), "mine.toml") << "nothing is left beside it";
  }
}

TEST_F(StudioTest, OneCommandMakesAllPreviews) {
  json asked{{"file", "mine.toml"}, {"text", text()}, {"trial", 1}, {"virtual", true}};
  EXPECT_TRUE(post("/preview", asked).contains("page"));
  asked["text"] = "# nothing\n";
  EXPECT_THAT(post("/preview", asked)["failure"].get<std::string>(),
              HasSubstr("haptrial: mine.toml: the definition is empty"));
  asked["text"] = text();
  EXPECT_TRUE(post("/preview", asked).contains("page")) << "a mistake ends nothing";
}

TEST_F(StudioTest, ATrialIsTriedByLines) {
  const json asked{{"file", "mine.toml"}, {"text", text()}, {"trial", 1}};
  const json begun = post("/try", asked);
  EXPECT_EQ(begun["command"], "haptrial show mine.toml --trial 1 --try");
  EXPECT_EQ(begun["device"], "haptrial run mine.toml --pilot --device mouse --window");
  const int number = begun["try"];
  EXPECT_GE(begun["head"]["stages"].size(), 1u);
  const json moved =
      post("/try_move", {{"try", number}, {"lines", {"stage 1", "to 0.1 0 0 0", "to 0.2 0 0 0"}}});
  ASSERT_EQ(moved["lines"].size(), 3u);
  EXPECT_EQ(moved["lines"][0], "stage 1");
  EXPECT_THAT(moved["lines"][2].get<std::string>(), testing::StartsWith("0.2 "));
  expect_refused(posting("/try_move", {{"try", number}, {"lines", {"a\nb"}}}), 400, "lines");
  expect_refused(posting("/try_move", {{"try", 99}, {"lines", {"to 1 0 0 0"}}}), 400,
                 "no command with this number answers");
  post("/try_end", {{"try", number}});
  expect_refused(posting("/try_move", {{"try", number}, {"lines", {"to 1 0 0 0"}}}), 400,
                 "no command with this number answers");
  json wrong = asked;
  wrong["trial"] = 100'000;
  const json refused = post("/try", wrong);
  EXPECT_FALSE(refused.contains("try"));
  EXPECT_THAT(refused["failure"].get<std::string>(), HasSubstr("--trial is 100000"));
}

TEST_F(StudioTest, ADefinitionOfAMegabyteIsCheckedAndSaved) {
  const std::string large = text() + "# " + std::string(1'000'000, 'x') + "\n";
  EXPECT_TRUE(post("/validate", {{"file", "mine.toml"}, {"text", large}})["valid"]);
  const std::string stamp = get("/text", "file=mine.toml")["stamp"];
  post("/save", {{"file", "mine.toml"}, {"text", large}, {"stamp", stamp}});
  EXPECT_EQ(text(), large);
  const std::string larger(2'000'001, 'x');
  expect_refused(posting("/validate", {{"file", "mine.toml"}, {"text", larger}}), 400,
                 "has 2000001 bytes; allowed: 2000000");
  RawRequest huge = posting("/validate", json::object());
  huge.length = "4000001";
  expect_refused(huge, 413, "the body has 4000001 bytes; allowed: 4000000");
}

TEST_F(StudioTest, SavesOnlyOverWhatWasRead) {
  const json read = get("/text", "file=mine.toml");
  EXPECT_EQ(read["text"], text());
  const json saved =
      post("/save", {{"file", "mine.toml"}, {"text", "# first\n"}, {"stamp", read["stamp"]}});
  EXPECT_EQ(text(), "# first\n");
  write_text(folder_ / "mine.toml", "# by another\n");
  expect_refused(
      posting("/save", {{"file", "mine.toml"}, {"text", "x"}, {"stamp", saved["stamp"]}}), 400,
      "was changed by another program");
  EXPECT_EQ(text(), "# by another\n");
  write_text(folder_ / "mine.toml", "# \xff\n");
  expect_refused(reading("/text", "file=mine.toml"), 400, "not a text in UTF-8");
}

/// Each of two pages that save at once believes that nobody else has changed the text.
TEST_F(StudioTest, TwoPagesThatSaveAtOnceAreNotBothToldThatTheirTextIsSaved) {
  const std::string filling(500'000, '#');
  for (int turn = 0; turn < 20; ++turn) {
    const json stamp = get("/text", "file=mine.toml")["stamp"];
    std::array<int, 2> states{};
    std::vector<std::thread> pages;
    for (std::size_t page = 0; page < states.size(); ++page) {
      pages.emplace_back([&, page] {
        const std::string own = "# " + std::to_string(2 * turn + static_cast<int>(page)) + "\n";
        states[page] = status_of(exchange(
            posting("/save", {{"file", "mine.toml"}, {"text", own + filling}, {"stamp", stamp}})));
      });
    }
    for (std::thread& page : pages) {
      page.join();
    }
    std::ranges::sort(states);
    EXPECT_THAT(states, ElementsAre(200, 400));
  }
}

TEST_F(StudioTest, ANewStudyComesFromTheGallery) {
  const json examples = get("/examples");
  EXPECT_EQ(examples["command"], "haptrial examples");
  const auto lists = [&](const std::string& name) {
    return std::ranges::any_of(examples["rows"], [&](const json& row) { return row[0] == name; });
  };
  EXPECT_TRUE(lists("first_experiment"));
  EXPECT_TRUE(lists("force_training"));
  const json made = post("/new", {{"name", "walls"}, {"from", "wall_detection"}});
  EXPECT_EQ(made["command"], "haptrial new walls.toml --from wall_detection");
  EXPECT_EQ(made["file"], "walls.toml");
  EXPECT_TRUE(get("/study", "file=walls.toml")["valid"]);
  expect_refused(posting("/new", {{"name", "walls"}, {"from", "wall_detection"}}), 400,
                 "exists already");
}

TEST_F(StudioTest, KeysAndTheMachineAreThoseOfTheCommands) {
  const json schema = get("/schema", "protocol=trials");
  EXPECT_EQ(schema["command"], "haptrial keys --json-schema trials");
  EXPECT_THAT(schema["schema"]["properties"]["design"]["properties"]["participants"]["description"],
              HasSubstr("articipants"));
  const json machine = get("/machine");
  EXPECT_EQ(machine["command"], "haptrial doctor");
  EXPECT_TRUE(std::ranges::any_of(
      machine["rows"], [](const json& row) { return row[0] == "virtual" && row[1] == "ready"; }));
  EXPECT_THAT(machine["verdict"], HasSubstr("can"));
}

TEST_F(StudioTest, ARehearsalAndItsReport) {
  const json started = post("/rehearse", {{"file", "mine.toml"}, {"subjects", 2}, {"setup", 15}});
  EXPECT_EQ(started["command"],
            "haptrial dry-run mine.toml --subjects 2 --out out/mine-rehearsal-001 --setup 15");
  const json done = ended(started["job"]);
  EXPECT_EQ(done["state"], "done");
  EXPECT_EQ(done["written"], 2);
  EXPECT_THAT(std::string(get("/job", "job=1")["output"]),
              AllOf(HasSubstr("2 sessions, "), HasSubstr("in the lab with 15 minutes between")));
  json folder = get("/sessions", "file=mine.toml")["folders"][0];
  EXPECT_EQ(folder["folder"], "out/mine-rehearsal-001");
  EXPECT_TRUE(folder["rehearsal"]);
  EXPECT_EQ(folder["sessions"][0]["name"], "S01.h5");
  EXPECT_FALSE(folder["report"]);
  const json info = get("/info", "file=out/mine-rehearsal-001/S01.h5");
  EXPECT_THAT(std::string(info["output"]), HasSubstr("subject     S01 (simulated)"));
  EXPECT_TRUE(info["complete"]);

  const json analysis =
      post("/analyze", {{"file", "mine.toml"}, {"folder", "out/mine-rehearsal-001"}});
  EXPECT_EQ(analysis["command"], "haptrial analyze out/mine-rehearsal-001");
  EXPECT_EQ(ended(analysis["job"])["state"], "done");
  folder = get("/sessions", "file=mine.toml")["folders"][0];
  EXPECT_TRUE(folder["report"]);
  EXPECT_FALSE(folder["report_is_old"]);
  const std::string report = exchange(reading("/file", "file=out/mine-rehearsal-001/report.html"));
  EXPECT_EQ(body_of(report), file_text(folder_ / "out/mine-rehearsal-001/report.html"));
  EXPECT_THAT(report, AllOf(HasSubstr("Content-Security-Policy: sandbox"),
                            HasSubstr("X-Frame-Options: SAMEORIGIN"), Not(HasSubstr("DENY")),
                            Not(HasSubstr("attachment"))));
  EXPECT_THAT(exchange(reading("/file", "file=out/mine-rehearsal-001/trials.csv&download=1")),
              HasSubstr("Content-Disposition: attachment; filename=\"trials.csv\""));
  fs::last_write_time(folder_ / "out/mine-rehearsal-001/S01.h5",
                      fs::file_time_type::clock::now() + std::chrono::hours(1));
  EXPECT_TRUE(get("/sessions", "file=mine.toml")["folders"][0]["report_is_old"]);
}

TEST_F(StudioTest, AReportFromBeforeAnExclusionIsOld) {
  const std::string in_folder = "cd '" + folder_.path().string() + "' && haptrial ";
  ASSERT_EQ(test::run_command(in_folder + "dry-run mine.toml --subjects 3 --out out/mine && " +
                              "haptrial analyze out/mine")
                .status,
            0);
  EXPECT_EQ(get("/study", "file=mine.toml")["report"], "current");
  ASSERT_EQ(test::run_command(in_folder + "roster mine.toml out/mine --exclude S03 --because late")
                .status,
            0);
  EXPECT_EQ(get("/study", "file=mine.toml")["report"], "old");
  EXPECT_TRUE(get("/sessions", "file=mine.toml")["folders"][0]["report_is_old"]);
  ASSERT_EQ(test::run_command(in_folder + "analyze out/mine").status, 0);
  EXPECT_EQ(get("/study", "file=mine.toml")["report"], "current");
  fs::rename(folder_ / "out/mine/excluded/S03.h5", folder_ / "out/mine/S03.h5");
  EXPECT_EQ(get("/study", "file=mine.toml")["report"], "old") << "a session came back";
}

/// A copy from another computer of the lab keeps the time of its original.
TEST_F(StudioTest, AReportWithoutASessionThatWasCopiedHereIsOld) {
  const std::string in_folder = "cd '" + folder_.path().string() + "' && haptrial ";
  ASSERT_EQ(test::run_command(in_folder + "dry-run mine.toml --subjects 2 --out elsewhere && "
                                          "mkdir -p out/mine && cp -p elsewhere/S01.h5 out/mine && "
                                          "haptrial analyze out/mine")
                .status,
            0);
  EXPECT_EQ(get("/study", "file=mine.toml")["report"], "current");
  ASSERT_EQ(
      test::run_command("cd '" + folder_.path().string() + "' && cp -p elsewhere/S02.h5 out/mine")
          .status,
      0);
  EXPECT_EQ(get("/study", "file=mine.toml")["report"], "old");
  EXPECT_TRUE(get("/sessions", "file=mine.toml")["folders"][0]["report_is_old"]);
}

TEST_F(StudioTest, APowerAnalysisIsAJob) {
  const json started = post("/power", {{"file", "mine.toml"}});
  EXPECT_EQ(started["command"], "haptrial power simulate mine.toml --out out/mine-power-001");
  EXPECT_EQ(ended(started["job"])["state"], "failed");
  EXPECT_THAT(std::string(get("/job", "job=1")["output"]), HasSubstr("has no table [power]"));
}

TEST_F(StudioTest, APlanIsWrittenBesideItsDefinition) {
  const json started = post("/plan", {{"file", "mine.toml"}});
  EXPECT_EQ(started["command"], "haptrial plan mine.toml");
  EXPECT_EQ(ended(started["job"])["state"], "done");
  EXPECT_TRUE(fs::exists(folder_ / "mine.plan.html"));
}

TEST_F(StudioTest, HomeCountsWhoIsDone) {
  const test::CommandResult run =
      test::run_command("cd '" + folder_.path().string() +
                        "' && haptrial dry-run mine.toml --subjects 2 --out out/mine");
  ASSERT_EQ(run.status, 0) << run.errors;
  const json state = get("/study", "file=mine.toml");
  EXPECT_EQ(state["sessions"], 2);
  EXPECT_EQ(state["roster"]["groups"][0]["finished"], 2);
  EXPECT_EQ(state["roster"]["next"][0]["subject"], "S03");
  EXPECT_FALSE(state.contains("last_event"));
}

TEST_F(StudioTest, AJobCanBeCancelled) {
  const json started = post("/rehearse", {{"file", "mine.toml"}, {"subjects", 10'000}});
  EXPECT_EQ(get("/jobs")["jobs"][0]["state"], "running");
  post("/cancel", {{"job", started["job"]}});
  EXPECT_EQ(ended(started["job"])["state"], "cancelled");
}

TEST_F(StudioTest, WhatRunsEndsWithTheStudio) {
  post("/rehearse", {{"file", "mine.toml"}, {"subjects", 10'000}});
  studio_.reset();  // comes back, and nothing writes any more
  fs::remove_all(folder_ / "out");
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(StudioTest, AJobThatFailsSaysWhy) {
  write_text(folder_ / "mine.toml", "[experiment]\n");
  const json started = post("/rehearse", {{"file", "mine.toml"}, {"subjects", 1}});
  const json failed = ended(started["job"]);
  EXPECT_EQ(failed["state"], "failed");
  EXPECT_EQ(failed["status"], 2);
  EXPECT_THAT(std::string(get("/job", "job=1")["output"]), HasSubstr("haptrial: mine.toml"));
}

TEST(StudioFolderTest, MustBeAFolder) {
  StudioOptions options;
  options.folder = "/nowhere/at/all";
  EXPECT_THROW(Studio{options}, InputError);
}

}  // namespace
}  // namespace haptrial::studio_test
