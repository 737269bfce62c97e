#include "core/base/definition/translations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::translations_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kDefinition = R"([response]
question = "Did it pull?"
choices = [{ value = "yes", label = "Yes" }, { value = "no" }]
)";

/// Reads the definition as a reader does. @returns question, labels of yes and no
std::vector<std::string> read(Table& root) {
  Table response = root.table("response");
  std::vector<std::string> texts{response.shown_text("question")};
  for (Table& choice : response.tables("choices")) {
    const std::string value = choice.text("value");
    choice.name_entry(value);
    texts.push_back(choice.shown_text("label", value));
  }
  root.finish();
  return texts;
}

Translations load(const std::string& text) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "texts.ar.toml") << text;
  return load_translations(folder / "texts.ar.toml", "ar");
}

TEST(TranslationsTest, ReplaceTextsByTheirKeysAndTheRestByTheirWords) {
  Translations translations =
      load("[response]\nquestion = \"هل سحب؟\"\nchoices.yes.label = \"نعم\"\n");
  translations.by_text["no"] = "لا";
  Table root = Table::parse(kDefinition, "study.toml");
  root.translate(translations);
  EXPECT_THAT(read(root), ElementsAre("هل سحب؟", "نعم", "لا"));
  EXPECT_EQ(root.source(), kDefinition) << "a language is no part of the definition";
  EXPECT_THAT(missing_translations(translations, root.shown_texts()), ElementsAre());
  EXPECT_THAT(unknown_translations(translations, root.shown_texts()), ElementsAre());
}

TEST(TranslationsTest, WithoutThemTextsAreAsTheyStand) {
  Table root = Table::parse(kDefinition, "study.toml");
  EXPECT_THAT(read(root), ElementsAre("Did it pull?", "Yes", "no"));
  ASSERT_EQ(root.shown_texts().size(), 3u);
  EXPECT_EQ(root.shown_texts()[2].key, "response.choices.no.label");
}

TEST(TranslationsTest, MissingAndUnknownKeysAreNamedWithTheFile) {
  const Translations translations = load("[response]\nqestion = \"हाँ\"\n");
  Table root = Table::parse(kDefinition, "study.toml");
  root.translate(translations);
  EXPECT_EQ(read(root).front(), "Did it pull?") << "shown as it stands";
  const auto unknown = unknown_translations(translations, root.shown_texts());
  ASSERT_EQ(unknown.size(), 1u);
  EXPECT_THAT(unknown.front(), HasSubstr("texts.ar.toml: response.qestion is no text"));
  EXPECT_THAT(unknown.front(), HasSubstr("did you mean response.question?"));
  const auto missing = missing_translations(translations, root.shown_texts());
  ASSERT_EQ(missing.size(), 3u);
  EXPECT_THAT(missing.front(), HasSubstr("texts.ar.toml: response.question is missing"));
}

TEST(TranslationsTest, WordsInBracesMustStandForSomethingInTextsWithPlaceholders) {
  Translations translations = load("[response]\nquestion = \"{time} {temps}\"\n");
  Table root =
      Table::parse("[response]\nquestion = \"{time} left {\"\nplain = \"a {b}\"\n", "s.toml");
  const auto read_texts = [](Table& from) {
    Table response = from.table("response");
    response.shown_text("question");
    response.note_placeholders("question", {"{time}"});
    response.shown_text("plain");
  };
  read_texts(root);
  EXPECT_THAT(unknown_placeholders({}, root.shown_texts(), "s.toml"),
              ElementsAre("s.toml: response.question has {, which stands for nothing; allowed: "
                          "{time}"))
      << "a text without placeholders may have braces";
  root.translate(translations);
  read_texts(root);
  const auto unknown = unknown_placeholders(translations, root.shown_texts(), "s.toml");
  ASSERT_EQ(unknown.size(), 1u);
  EXPECT_THAT(unknown.front(), HasSubstr("texts.ar.toml: response.question has {temps}, which"));
}

TEST(TranslationsTest, OnlyTextsAreTranslations) {
  for (const char* wrong : {"rate = 1000\n", "[response]\nquestion = \"\"\n", "x = [\"a\"]\n"}) {
    EXPECT_THROW(load(wrong), InputError) << wrong;
  }
}

}  // namespace
}  // namespace haptrial::translations_test
