// Pages of a definition: what is answered by keys, on the console and by virtual participants.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/questions/question_kinds.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/answer_rows.h"
#include "experiments/control/session_control.h"
#include "experiments/runner/page_input.h"
#include "experiments/runner/session.h"
#include "experiments/runner/session_pages.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"
#include "experiments/study/study_files.h"
#include "protocols/definition/languages.h"
#include "protocols/interface/recorded_definition.h"
#include "tests/experiments/command.h"
#include "tests/experiments/session_runs.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using questions::Answer;
using questions::Question;
using questions::QuestionKind;
using record::AnswerRow;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kPages = R"(
[pages]
before = ["welcome", "agree", "hand"]
after = ["load", "you"]
[pages.welcome]
title = "Welcome"
text = "A study of touch."
[pages.agree]
kind = "consent"
text = "Do you take part?"
[pages.hand]
kind = "edinburgh"
[pages.load]
kind = "nasa_tlx"
weighted = true
[pages.you]
kind = "questions"
[[pages.you.items]]
name = "age"
question = "How old are you?"
number = [18, 99]
[[pages.you.items]]
name = "else"
question = "Anything else?"
words = true
)";

fs::path write_definition(const fs::path& folder, const std::string& pages = kPages) {
  std::ifstream in(HAPTRIAL_SOURCE_DIR "/experiments/first_experiment.toml");
  const std::string text(std::istreambuf_iterator<char>(in), {});
  std::ofstream(folder / "study.toml") << text << pages;
  return folder / "study.toml";
}

SessionRequest request_for(const Experiment& experiment, const fs::path& file) {
  SessionRequest request = test::session_request(experiment, file, 7);
  request.definition_folder = file.parent_path();
  request.max_trials = 2;
  return request;
}

Question item_of(const QuestionKind& kind) {
  Question item;
  item.name = "x";
  item.kind = &kind;
  item.text = "?";
  item.choices = {{"a", "A", 1.0}, {"b", "B", 2.0}};
  item.high = 100.0;
  item.step = 5.0;
  return item;
}

TEST(PageInputTest, KeysAndTheConsoleGiveTheSameAnswers) {
  const protocols::SessionTexts words;
  const Question choice = item_of(questions::choice_kind());
  PageInput keys(choice, words);
  EXPECT_TRUE(keys.press({'9'})) << "there is no ninth, and the hint says so";
  EXPECT_TRUE(keys.page(nullptr).hint_is_urgent);
  keys.press({KeyPress::kEnter});
  EXPECT_FALSE(keys.answer()) << "nothing is chosen";
  EXPECT_TRUE(keys.press({'2'}));
  keys.press({KeyPress::kEnter});
  ASSERT_TRUE(keys.answer());
  PageInput console(choice, words);
  EXPECT_THAT(console.give("3"), HasSubstr("allowed: the number of a choice, 1 to 2"));
  EXPECT_FALSE(console.answer());
  EXPECT_EQ(console.give("2"), "");
  EXPECT_EQ(keys.answer()->text, "b");
  EXPECT_EQ(console.answer()->text, "b");
  EXPECT_EQ(console.answer()->value, 2.0);
}

TEST(PageInputTest, DigitsMoveTheMarkAndAKeyThatDoesNothingIsSaid) {
  const protocols::SessionTexts words;
  Question scale = item_of(questions::scale_kind());
  scale.low = 1.0;
  scale.high = 7.0;
  scale.step = 1.0;
  scale.low_end = "not at all";
  scale.high_end = "very";
  PageInput tired(scale, words);
  EXPECT_TRUE(tired.press({KeyPress::kEnter})) << "the hint becomes urgent";
  EXPECT_TRUE(tired.page(nullptr).hint_is_urgent);
  EXPECT_TRUE(tired.press({'4'}));
  EXPECT_FALSE(tired.page(nullptr).hint_is_urgent);
  EXPECT_EQ(tired.page(nullptr).answer.chosen, 3);
  EXPECT_EQ(tired.page(nullptr).answer.scale->numbers,
            (std::vector<std::string>{"1", "2", "3", "4", "5", "6", "7"}));
  tired.press({KeyPress::kEnter});
  ASSERT_TRUE(tired.answer());
  EXPECT_EQ(tired.answer()->value, 4.0);

  scale.low = 0.0;
  scale.high = 100.0;
  scale.step = 5.0;
  PageInput load(scale, words);
  for (const char digit : {'8', '5'}) {
    load.press({digit});
  }
  EXPECT_EQ(load.page(nullptr).answer.chosen, 17);
  EXPECT_EQ(load.page(nullptr).answer.scale->numbers.at(17), "85") << "said, though not drawn";

  Question age = item_of(questions::number_kind());
  age.low = 18.0;
  age.high = 99.0;
  PageInput years(age, words);
  for (const char digit : {'1', '5', '0'}) {
    years.press({0, static_cast<char32_t>(digit)});
  }
  years.press({KeyPress::kEnter});
  EXPECT_FALSE(years.answer());
  EXPECT_TRUE(years.page(nullptr).hint_is_urgent);
  EXPECT_EQ(years.page(nullptr).hint, "Type a number, then press Enter (18 – 99)");
}

TEST(PageInputTest, AnExperimenterConsentsOnlyWithAReason) {
  const protocols::SessionTexts words;
  Question consent = item_of(questions::consent_kind());
  consent.choices = {{"accepted", "I agree", 1.0}, {"declined", "I do not", 0.0}};
  PageInput console(consent, words);
  EXPECT_THAT(console.give("1"), HasSubstr("paper form"));
  EXPECT_THAT(console.give("1: "), HasSubstr("paper form"));
  EXPECT_FALSE(console.answer());
  EXPECT_EQ(console.give("1: paper form signed"), "");
  EXPECT_EQ(console.answer()->text, "accepted");
  EXPECT_EQ(console.answer()->reason, "paper form signed");
  PageInput refusal(consent, words);
  EXPECT_EQ(refusal.give("2"), "") << "to decline needs no reason";
  EXPECT_EQ(refusal.answer()->text, "declined");
  PageInput window(consent, words);
  window.press({'1'});
  window.press({KeyPress::kEnter});
  ASSERT_TRUE(window.answer()) << "it is the participant's";
  EXPECT_EQ(window.answer()->reason, "");
}

TEST(PageInputTest, AMarkMovesInStepsAndStopsAtTheEnds) {
  const protocols::SessionTexts words;
  const Question scale = item_of(questions::scale_kind());
  PageInput input(scale, words);
  input.press({KeyPress::kEnter});
  EXPECT_FALSE(input.answer()) << "the mark has no place before it is moved";
  for (int i = 0; i < 30; ++i) {
    input.press({KeyPress::kRight});
  }
  input.press({KeyPress::kLeft});
  input.press({KeyPress::kEnter});
  ASSERT_TRUE(input.answer());
  EXPECT_EQ(input.answer()->value, 95.0);
  PageInput console(scale, words);
  EXPECT_THAT(console.give("93"), HasSubstr("in steps of 5"));
  EXPECT_THAT(console.give("105"), HasSubstr("a number from 0 to 100"));
}

TEST(PageInputTest, WordsOfAnyScriptAreTyped) {
  const protocols::SessionTexts words;
  const Question text = item_of(questions::words_kind());
  PageInput input(text, words);
  for (const char32_t c : std::u32string(U"नहीं!é")) {
    input.press({KeyPress::kOther, c});
  }
  input.press({KeyPress::kBackspace});
  input.press({KeyPress::kEnter});
  ASSERT_TRUE(input.answer());
  EXPECT_EQ(input.answer()->text, "नहीं!");
  const Question number = item_of(questions::number_kind());
  PageInput typed(number, words);
  for (const char32_t c : std::u32string(U"4x2,5")) {
    typed.press({KeyPress::kOther, c});
  }
  typed.press({KeyPress::kEnter});
  ASSERT_TRUE(typed.answer());
  EXPECT_EQ(typed.answer()->value, 42.5);
}

TEST(PageInputTest, BackspaceGoesBackWhereNothingIsTyped) {
  const protocols::SessionTexts words;
  const KeyPress back{KeyPress::kBackspace};
  const Question choice = item_of(questions::choice_kind());
  PageInput first(choice, words);
  first.press(back);
  EXPECT_FALSE(first.goes_back()) << "nothing is before it";
  PageInput second(choice, words, true);
  EXPECT_THAT(second.page(nullptr).hint, HasSubstr(words.go_back));
  second.press(back);
  EXPECT_TRUE(second.goes_back());
  const Question text = item_of(questions::words_kind());
  PageInput typed(text, words, true);
  typed.press({KeyPress::kOther, U'x'});
  typed.press(back);
  EXPECT_FALSE(typed.goes_back()) << "it takes the x away";
  EXPECT_EQ(typed.page(nullptr).answer.typed, "");
  typed.press(back);
  EXPECT_TRUE(typed.goes_back());
}

TEST(PageInputTest, AnEarlierAnswerIsShownAndKeptByEnter) {
  const protocols::SessionTexts words;
  const auto kept = [&](const Question& item, const Answer& earlier) {
    PageInput input(item, words, true);
    input.show_earlier(earlier);
    PageInput console(item, words, true);
    EXPECT_EQ(console.give(input.asked(1).given), "") << "what the console shows is an answer";
    EXPECT_EQ(console.answer()->text, earlier.text);
    input.press({KeyPress::kEnter});
    return input.answer().value_or(Answer{-1.0, "none"});
  };
  EXPECT_EQ(kept(item_of(questions::choice_kind()), {2.0, "b"}).text, "b");
  EXPECT_EQ(kept(item_of(questions::scale_kind()), {35.0, ""}).value, 35.0);
  EXPECT_EQ(kept(item_of(questions::number_kind()), {42.5, ""}).value, 42.5);
  EXPECT_EQ(kept(item_of(questions::words_kind()), {std::nan(""), "é!"}).text, "é!");
}

TEST(SessionPagesTest, VirtualParticipantsAnswerEveryPage) {
  const test::TemporaryFolder folder;
  const Experiment experiment = load_experiment(write_definition(folder.path()));
  run_session(request_for(experiment, folder / "S01.h5"));
  const record::SessionReader file(folder / "S01.h5");
  EXPECT_TRUE(record::check_session(file, known_tables()).ok);
  const auto rows = file.rows<AnswerRow>();
  ASSERT_EQ(rows.size(), 1u + 10u + 21u + 2u);
  EXPECT_EQ(rows.front().text, "accepted");
  EXPECT_EQ(rows.front().when, record::PageTime::kBefore);
  EXPECT_EQ(rows.back().text, "SIMULATED");
  EXPECT_EQ(rows.back().when, record::PageTime::kAfter);
  const Question& age = experiment.definition->pages.page("you").items.front();
  EXPECT_GE(rows[rows.size() - 2].value, age.low);
  EXPECT_LE(rows[rows.size() - 2].value, age.high);
  for (const AnswerRow& row : rows) {
    EXPECT_EQ(row.source, record::AnsweredAt::kVirtual) << row.item;
  }
  EXPECT_GE(file.passes().size(), 2u);
}

/// A participant's answers, given as the console gives them. @returns how many
class AtTheConsole {
 public:
  AtTheConsole(SessionControl& control, int until) : control_(control), until_(until) {
    thread_ = std::thread([this] { work(); });
  }
  ~AtTheConsole() {
    stop_ = true;
    thread_.join();
  }

 private:
  void work() {
    int answered = 0;
    while (!stop_) {
      const SessionStatus status = control_.status();
      if (status.asked.number > answered) {
        answered = status.asked.number;
        if (answered > until_) {
          control_.ask(Request::kAbort);
          return;
        }
        control_.answer(answered, answer_to(status.asked));
      } else if (status.asked.number == 0 && status.state == "instructions") {
        control_.ask(Request::kStart);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  static std::string answer_to(const AskedItem& asked) {
    return asked.kind == "consent"  ? "1: paper form signed"
           : asked.kind == "choice" ? "1"
           : asked.kind == "words"  ? "no"
                                    : "50";
  }

  SessionControl& control_;
  int until_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

SessionRequest live_request(const Experiment& experiment, const fs::path& file,
                            SessionControl& control) {
  SessionRequest request = request_for(experiment, file);
  request.clock = realtime::ClockKind::kReal;
  request.device = {"virtual", "", 0};
  request.control = &control;
  return request;
}

TEST(SessionPagesTest, WhatWasAnsweredIsNotAskedAgainAfterAResume) {
  const test::TemporaryFolder folder;
  const Experiment experiment = load_experiment(write_definition(folder.path()));
  const fs::path file = folder / "S01.h5";
  SessionControl control;
  SessionRequest request = live_request(experiment, file, control);
  request.max_trials = 1;
  {
    const AtTheConsole person(control, 5);  // the text, consent, three activities; then stops
    EXPECT_TRUE(run_session(request).stopped);
  }
  const auto first = record::SessionReader(file.string() + ".partial").rows<AnswerRow>();
  ASSERT_EQ(first.size(), 4u);
  SessionControl again;
  request.control = &again;
  request.resume = true;
  {
    const AtTheConsole person(again, 1000);
    EXPECT_FALSE(run_session(request).stopped);
  }
  const auto rows = record::SessionReader(file).rows<AnswerRow>();
  ASSERT_EQ(rows.size(), 1u + 10u + 21u + 2u) << "each item once";
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(rows[i].item, first[i].item);
    EXPECT_EQ(rows[i].time_ns, first[i].time_ns) << "as it was answered the first time";
  }
  EXPECT_EQ(rows[1].source, record::AnsweredAt::kConsole);
  const auto events = record::SessionReader(file).events();
  EXPECT_TRUE(std::ranges::any_of(events, [](const record::EventRow& event) {
    return event.kind == "consent_by_experimenter" && event.text == "paper form signed";
  }));
  const ProtocolOf protocol = [&](const record::SessionInfo&) -> const protocols::Protocol& {
    return experiment.study->protocol();
  };
  const auto remarks = study_files(folder.path(), Pilots::kLeftOut, protocol).remarks;
  EXPECT_THAT(remarks, testing::Contains(HasSubstr("Consent was entered by the experimenter")));
}

/// Answers two questions, goes back from the last look to the first one, changes it, and goes on.
class ChangesTheMind {
 public:
  explicit ChangesTheMind(SessionControl& control)
      : control_(control), thread_([this] { work(); }) {}
  ~ChangesTheMind() {
    stop_ = true;
    thread_.join();
  }
  std::vector<std::string> seen() const { return seen_; }

 private:
  void work() {
    int last = 0;
    const std::vector<std::function<void(int)>> moves{
        [&](int asked) { control_.answer(asked, "81"); },
        [&](int asked) { control_.answer(asked, "tall"); },
        [&](int) { control_.ask(Request::kBack); },
        [&](int) { control_.ask(Request::kBack); },
        [&](int asked) { control_.answer(asked, "18"); },
        [&](int asked) { control_.answer(asked, "tall"); },
        [&](int asked) { control_.answer(asked, ""); },
        [&](int) { control_.ask(Request::kAbort); }};
    while (!stop_ && seen_.size() < moves.size()) {
      const SessionStatus status = control_.status();
      const bool over = status.asked.number == 0 && status.state == "instructions";
      if (status.asked.number > last || over) {
        last = status.asked.number;
        seen_.push_back((status.asked.back ? "back, " : "") + status.asked.kind + ": " +
                        status.asked.given);
        moves[seen_.size() - 1](last);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

  SessionControl& control_;
  std::vector<std::string> seen_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

TEST(SessionPagesTest, WhoGoesBackChangesAnAnswerAndTheFileSaysSo) {
  const test::TemporaryFolder folder;
  const Experiment experiment = load_experiment(write_definition(folder.path(), R"(
[pages]
before = ["age", "more"]
[pages.age]
kind = "questions"
[[pages.age.items]]
name = "years"
question = "How old are you?"
number = [18, 99]
[pages.more]
kind = "questions"
[[pages.more.items]]
name = "size"
question = "How tall are you?"
words = true
)"));
  SessionControl control;
  std::vector<std::string> seen;
  {
    const ChangesTheMind person(control);
    EXPECT_TRUE(run_session(live_request(experiment, folder / "S01.h5", control)).stopped);
    seen = person.seen();
  }
  EXPECT_THAT(seen, ElementsAre("number: ", "back, words: ", "back, read: ", "back, words: tall",
                                "number: 81", "back, words: tall", "back, read: ", ": "));
  const auto [rows, events] = [&] {
    const record::SessionReader file(folder / "S01.h5.partial");
    return std::pair(file.rows<AnswerRow>(), file.events());
  }();
  ASSERT_EQ(rows.size(), 3u) << "an answer that is given again as it was has no row";
  EXPECT_EQ(rows[0].value, 81.0);
  EXPECT_EQ(rows[1].text, "tall");
  EXPECT_EQ(rows[2].value, 18.0);
  EXPECT_EQ(rows[2].item, "years");
  EXPECT_THAT(record::standing_answers(rows), ElementsAre(false, true, true));
  std::vector<std::string> changes;
  for (const record::EventRow& event : events) {
    if (event.kind == "answer_changed") {
      changes.push_back(event.text);
    }
  }
  EXPECT_THAT(changes, ElementsAre("age.years"));
  // A resumed session asks nothing again, and the analysis sees the last answer.
  SessionControl again;
  SessionRequest request = live_request(experiment, folder / "S01.h5", again);
  request.resume = true;
  request.max_trials = 1;
  {
    const AtTheConsole person(again, 0);
    EXPECT_FALSE(run_session(request).stopped);
  }
  EXPECT_EQ(record::SessionReader(folder / "S01.h5").rows<AnswerRow>().size(), 3u);
  const test::CommandResult exported = test::run_command(
      "haptrial export '" + folder.path().string() + "' --csv '" + (folder / "csv").string() + "'");
  ASSERT_EQ(exported.status, 0) << exported.errors;
  const std::string table = file_text(folder / "csv/answers.csv");
  EXPECT_THAT(table, HasSubstr(",18,"));
  EXPECT_THAT(table, testing::Not(HasSubstr(",81,")));
}

TEST(SessionPagesTest, ThePictureOfAPageReachesTheConsole) {
  const test::TemporaryFolder folder;
  fs::copy_file(HAPTRIAL_SOURCE_DIR "/docs/algorithms/drilled-floor.png", folder / "grip.png");
  const Experiment experiment = load_experiment(write_definition(folder.path(), R"(
[pages]
before = ["welcome"]
[pages.welcome]
text = "Hold it like this."
picture = "grip.png"
)"));
  SessionControl control;
  const SessionRequest request = live_request(experiment, folder / "S01.h5", control);
  AskedItem asked;
  std::atomic<bool> done{false};
  std::thread person([&] {
    while (!done && asked.number == 0) {
      asked = control.status().asked;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    control.ask(Request::kAbort);
  });
  EXPECT_TRUE(run_session(request).stopped);
  done = true;
  person.join();
  EXPECT_EQ(asked.picture_file, "grip.png");
  ASSERT_TRUE(asked.picture);
  EXPECT_EQ(*asked.picture, file_text(folder / "grip.png"));
}

TEST(SessionPagesTest, WhoDeclinesIsPresentedNothing) {
  const test::TemporaryFolder folder;
  const Experiment experiment = load_experiment(write_definition(folder.path()));
  SessionControl control;
  SessionRequest request = live_request(experiment, folder / "S01.h5", control);
  std::atomic<bool> done{false};
  std::thread person([&] {
    int answered = 0;
    while (!done) {
      const SessionStatus status = control.status();
      if (status.asked.number > answered) {
        answered = status.asked.number;
        control.answer(answered, status.asked.kind == "consent" ? "2" : "");
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  });
  const SessionSummary summary = run_session(request);
  done = true;
  person.join();
  EXPECT_FALSE(summary.stopped);
  EXPECT_THAT(summary.notices, testing::Contains(HasSubstr("did not agree to take part")));
  const record::SessionReader file(folder / "S01.h5");
  EXPECT_TRUE(file.passes().empty());
  const auto rows = file.rows<AnswerRow>();
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows.front().text, "declined");
  const auto events = file.events();
  EXPECT_TRUE(std::any_of(events.begin(), events.end(),
                          [](const auto& event) { return event.kind == "consent_declined"; }));
}

TEST(LanguagesTest, GermanIsComplete) {
  const test::TemporaryFolder folder;
  const fs::path file = write_definition(folder.path(), R"(
[pages]
before = ["hand"]
after = ["load"]
[pages.hand]
kind = "edinburgh"
[pages.load]
kind = "nasa_tlx"
weighted = true
)");
  fs::copy_file(HAPTRIAL_SOURCE_DIR "/experiments/first_experiment.texts.de.toml",
                folder / "study.texts.de.toml");
  const Experiment german = load_experiment(file, "de");
  EXPECT_THAT(german.untranslated, ElementsAre());
  EXPECT_EQ(german.definition->texts.rest, "Zeit für eine Pause\nLassen Sie den Griff los.");
  EXPECT_EQ(german.definition->texts.stopped,
            "Angehalten\nDie Kräfte sind abgeschaltet. Bitte warten Sie auf die Versuchsleitung.");
  const Experiment english = load_experiment(file);
  EXPECT_EQ(english.definition->text, german.definition->text) << "the same study";
  EXPECT_THAT(protocols::languages_of(file), ElementsAre("de"));
}

TEST(LanguagesTest, ALanguageIsRecorded) {
  const test::TemporaryFolder folder;
  const fs::path file = write_definition(folder.path());
  std::ofstream(folder / "texts.ar.toml") << "[texts]\nrest = \"وقت الراحة\"\n";
  const Experiment arabic = load_experiment(file, "ar");
  EXPECT_EQ(arabic.definition->texts.rest, "وقت الراحة");
  EXPECT_FALSE(arabic.untranslated.empty());
  run_session(request_for(arabic, folder / "S01.h5"));
  const auto events = record::SessionReader(folder / "S01.h5").events();
  EXPECT_TRUE(std::any_of(events.begin(), events.end(), [](const auto& event) {
    return event.kind == "language" && event.text == "ar";
  }));
  EXPECT_THROW(load_experiment(file, "hi"), InputError);
  fs::remove(folder / "texts.ar.toml");
  const record::SessionReader reader(folder / "S01.h5");
  Table root = protocols::recorded_definition(reader, 1);
  EXPECT_EQ(arabic.study->protocol().read(root, "S01.h5", nullptr)->texts.rest, "وقت الراحة");
  const test::CommandResult replay =
      test::run_command("haptrial replay '" + (folder / "S01.h5").string() +
                        "' --trial 1 --fps 1 --frames '" + (folder / "frames").string() + "'");
  EXPECT_EQ(replay.status, 0) << replay.errors;
  EXPECT_THAT(replay.output, Not(HasSubstr("words:")));
}

TEST(SessionPagesTest, ReportsTellSessionsOfAParticipantApart) {
  const test::TemporaryFolder folder;
  std::string text = file_text(HAPTRIAL_SOURCE_DIR "/experiments/first_experiment.toml");
  text.insert(text.find("[design]\n") + 9, "sessions = 2\n");
  text += "[pages]\nafter = [\"load\"]\n[pages.load]\nkind = \"nasa_tlx\"\n";
  std::ofstream(folder / "study.toml") << text;
  const std::string out = (folder / "out").string();
  const test::CommandResult result =
      test::run_command("haptrial dry-run " + (folder / "study.toml").string() +
                        " --subjects 2 --trials 2 --out " + out + " && haptrial analyze " + out);
  ASSERT_EQ(result.status, 0) << result.errors;
  const std::string report = file_text(fs::path(out) / "report.md");
  EXPECT_THAT(report, HasSubstr("| load | session 1, after | raw | – | 2 |"));
  EXPECT_THAT(report, HasSubstr("| load | session 2, after | raw | – | 2 |"));
}

}  // namespace
}  // namespace haptrial::experiments
