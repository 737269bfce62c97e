// The words that are said of a picture and of the next one.

#include "experiments/screen/spoken_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/base/error.h"
#include "core/questions/question_kinds.h"
#include "experiments/runner/page_input.h"
#include "experiments/screen/speech_library.h"
#include "experiments/studies/experiment.h"
#include "protocols/definition/languages.h"
#include "protocols/definition/speech_options.h"
#include "protocols/psychophysics/presentation/trial_page.h"
#include "protocols/psychophysics/presentation/trial_view.h"
#include "tests/experiments/shipped.h"

namespace haptrial::experiments::spoken_text_test {
namespace {

using Kind = SpeechChange::Kind;
using protocols::PictureText;
using questions::Question;

const std::string kSeconds = "seconds";

Question question(const questions::QuestionKind& kind, const std::string& text) {
  Question item;
  item.kind = &kind;
  item.text = text;
  return item;
}

Question tired() {
  Question item = question(questions::scale_kind(), "How tired are you?");
  item.low = 0.0;
  item.high = 100.0;
  item.step = 5.0;
  item.low_end = "not at all";
  item.high_end = "very";
  return item;
}

protocols::SessionTexts german() {
  const auto words = protocols::program_words("de");
  protocols::SessionTexts texts;
  for (std::string* text : {&texts.go_on, &texts.choose, &texts.move_mark, &texts.type_number,
                            &texts.type_words, &texts.rest}) {
    const auto found = words.find(*text);
    *text = found == words.end() ? *text : found->second;
  }
  return texts;
}

/// A question that is answered key by key; says what is heard.
class Answering {
 public:
  explicit Answering(const Question& item, protocols::SessionTexts texts = {})
      : texts_(std::move(texts)), item_(item), input_(item_, texts_) {}
  std::string all() const { return words_of(input_.page(nullptr), kSeconds); }
  std::string after(const KeyPress& key) {
    const PictureText before{input_.page(nullptr)};
    input_.press(key);
    return speech_between(before, {input_.page(nullptr)}, kSeconds).text;
  }
  std::string after_typing(char32_t character) { return after({KeyPress::kOther, character}); }

 private:
  protocols::SessionTexts texts_;
  Question item_;
  PageInput input_;
};

TEST(SpokenTextTest, AChoiceIsSaidWithItsKeysAndWhenItIsChosen) {
  Question item = question(questions::choice_kind(), "Which was softer?");
  item.choices = {{"a", "The first"}, {"b", "The second"}};
  Answering english(item);
  EXPECT_EQ(english.all(),
            "Which was softer? 1: The first. 2: The second. Choose with a number key or the "
            "arrows, then press Enter.");
  EXPECT_EQ(english.after({'2'}), "2: The second");
  EXPECT_EQ(english.after({KeyPress::kUp}), "1: The first");
  EXPECT_EQ(Answering(item, german()).all(),
            "Which was softer? 1: The first. 2: The second. Wählen Sie mit einer Zifferntaste "
            "oder den Pfeiltasten, dann die Eingabetaste.");
}

TEST(SpokenTextTest, AScaleSaysWhereItsMarkIs) {
  Answering scale(tired());
  EXPECT_EQ(scale.all(),
            "How tired are you? 0: not at all. 100: very. Move the mark with the arrow keys or "
            "type a number, then press Enter.");
  EXPECT_EQ(scale.after({KeyPress::kRight}), "55");
  EXPECT_EQ(scale.after({KeyPress::kLeft}), "50");
  EXPECT_EQ(scale.after({'9'}), "10") << "the nearest step";
  Question bare = tired();
  bare.low_end = bare.high_end = "";
  EXPECT_THAT(Answering(bare).all(), testing::HasSubstr("How tired are you? 0 – 100."));
}

TEST(SpokenTextTest, TypedCharactersAreEchoed) {
  Question item = question(questions::number_kind(), "How old?");
  item.low = 1.0;
  item.high = 99.0;
  Answering number(item);
  EXPECT_EQ(number.all(), "How old? Type a number, then press Enter (1 – 99).");
  EXPECT_EQ(number.after_typing(U'3'), "3");
  EXPECT_EQ(number.after_typing(U'7'), "7");
  EXPECT_EQ(number.after({KeyPress::kBackspace}), "3") << "what is left";
  Answering words(question(questions::words_kind(), "What was it like?"));
  EXPECT_EQ(words.after_typing(U'ö'), "ö");
  EXPECT_EQ(words.after({KeyPress::kBackspace}), "Type your answer, then press Enter");
}

TEST(SpokenTextTest, ConsentAndATextToRead) {
  Question consent = question(questions::consent_kind(), "Do you take part?");
  consent.choices = {{"accepted", "I agree"}, {"declined", "I do not agree"}};
  EXPECT_THAT(Answering(consent).all(),
              testing::HasSubstr("Do you take part? 1: I agree. 2: I do not agree."));
  Question reading = question(questions::reading_kind(), "Hold the handle\nlike a pen.");
  reading.title = "Welcome";
  EXPECT_EQ(Answering(reading).all(),
            "Welcome. Hold the handle. like a pen. Press Enter to go on.");
}

TEST(SpokenTextTest, AKeyThatDoesNothingBringsTheHint) {
  Answering scale(tired());
  EXPECT_EQ(scale.after({KeyPress::kSpace}),
            "Move the mark with the arrow keys or type a number, then press Enter");
}

TEST(SpokenTextTest, NothingIsSaidTwice) {
  PictureText asked;
  asked.page.title = "Did it pull?";
  asked.page.answer.choices = {"[1]  yes", "[2]  no"};
  EXPECT_EQ(speech_between({}, asked, kSeconds).text, "Did it pull? 1: yes. 2: no.");
  EXPECT_EQ(speech_between(asked, asked, kSeconds).kind, Kind::kNone);
  PictureText again = asked;
  again.occasion = 2;  // the next trial's
  EXPECT_EQ(speech_between(asked, again, kSeconds).kind, Kind::kSay);
  EXPECT_EQ(speech_between(asked, {}, kSeconds).kind, Kind::kCut) << "it is answered";
}

TEST(SpokenTextTest, FeedbackIsSaidToItsEndAndWithoutItsSign) {
  PictureText told;
  told.page.title = "✓ Richtig";
  EXPECT_EQ(speech_between({}, told, kSeconds).text, "Richtig.");
  EXPECT_EQ(speech_between(told, {}, kSeconds).kind, Kind::kForget);
}

TEST(SpokenTextTest, ABreakSaysHowLongItLastsOnce) {
  PictureText rest{protocols::page_of("Time for a rest\nLet go of the handle.")};
  rest.page.countdown = 60.0;
  EXPECT_EQ(words_of(rest.page, "Sekunden"), "Time for a rest. Let go of the handle. 60 Sekunden.");
  PictureText later = rest;
  later.page.countdown = 42.5;
  EXPECT_EQ(speech_between(rest, later, kSeconds).kind, Kind::kNone);
  EXPECT_EQ(words_of(later.page, kSeconds), "Time for a rest. Let go of the handle. 43 seconds.");
}

TEST(SpokenTextTest, ATrialSaysWhatItsPictureHas) {
  const Experiment experiment = load_experiment(
      (test::shipped_definition().parent_path() / "stiffness_discrimination.toml").string());
  const auto& d = dynamic_cast<const protocols::TrialsDefinition&>(*experiment.definition);
  protocols::TrialView view;
  view.interval = 2;
  view.number_shown = true;
  EXPECT_EQ(words_of(text_of(d, view).page, kSeconds), "2.");
  view.number_shown = false;
  EXPECT_EQ(words_of(text_of(d, view).page, kSeconds), "");
  view.question = 1;
  EXPECT_EQ(words_of(text_of(d, view).page, kSeconds),
            "Which spring was stiffer? 1: The first. 2: The second.");
  const PictureText asked = text_of(d, view);
  view.verdict = protocols::Verdict::kWrong;
  EXPECT_EQ(speech_between(asked, text_of(d, view), kSeconds).text, "Wrong.");
  EXPECT_FALSE(protocols::speech_of(d).spoken);
}

std::vector<std::string> warnings_of_spoken(const std::string& name) {
  std::string text = test::read_text(test::shipped_definition().parent_path() / (name + ".toml"));
  const std::string display = "[display]\n";
  const std::size_t at = text.find(display);
  text = at == std::string::npos ? text + "[display]\nspoken = true\n"
                                 : text.insert(at + display.size(), "spoken = true\n");
  return parse_experiment(text, name + ".toml").definition->warnings();
}

TEST(SpokenTextTest, StagesThatOnlyEyesCanDoAreNamed) {
  using testing::Contains;
  using testing::HasSubstr;
  EXPECT_THAT(warnings_of_spoken("curl_field"),
              Contains(HasSubstr("the stage \"reach\" shows target")));
  EXPECT_THAT(warnings_of_spoken("stiffness_discrimination"), Not(Contains(HasSubstr("shows"))));
  EXPECT_THAT(warnings_of_spoken("first_experiment"), Not(Contains(HasSubstr("shows"))));
}

TEST(SpokenTextTest, NoiseThatMasksThroughoutIsRefused) {
  const std::string text =
      test::read_text(test::shipped_definition().parent_path() / "first_experiment.toml") +
      "[display]\nspoken = true\n[sounds.masking]\nlevel = -30.0\n";
  EXPECT_TRUE(
      protocols::speech_of(*parse_experiment(text + "stages = [\"feel\"]\n", "a.toml").definition)
          .spoken);
  try {
    parse_experiment(text, "a.toml");
    FAIL() << "nothing would be heard";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("add stages to [sounds.masking]"));
  }
}

// The real library, which gives samples in both languages.
TEST(SpeechLibraryTest, SpeaksEnglishAndGerman) {
  std::vector<std::vector<float>> spoken;
  for (const char* voice : {"en", "de"}) {
    SpeechLibrary library(voice);
    spoken.push_back(library.samples("Kind, 1: Hand."));
    const auto loud = [](float sample) { return std::abs(sample) > 0.05F; };
    EXPECT_GT(std::ranges::count_if(spoken.back(), loud), 4800) << voice;
    EXPECT_TRUE(std::ranges::all_of(spoken.back(), [](float s) { return std::abs(s) <= 1.0F; }));
    EXPECT_GT(library.samples("ö").size(), 4800u) << "a character by its name";
    EXPECT_TRUE(library.samples("").empty());
  }
  EXPECT_NE(spoken[0], spoken[1]) << "the voices differ";
  EXPECT_THROW(SpeechLibrary("no such voice"), InputError);
}

}  // namespace
}  // namespace haptrial::experiments::spoken_text_test
