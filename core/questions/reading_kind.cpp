#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "core/questions/kind_parts.h"
#include "core/questions/question_kinds.h"

namespace haptrial::questions {
namespace {

const Schema<Question>& video_schema() {
  static const auto schema =
      Schema<Question>()
          .text("video", &Question::video,
                "Video in the place of a picture, a file relative to the definition, which plays "
                "once before the page can be left")
          .otherwise("none");
  return schema;
}

/// A text that is read and gone on from: nothing is asked, and nothing is recorded.
class ReadingKind final : public QuestionKind {
 public:
  std::string word() const override { return "read"; }
  QuestionTraits traits() const noexcept override {
    return {.asks = false, .scored = false, .in_trials = false};
  }
  std::string key() const override { return ""; }
  std::vector<int> heard_keys(const Question&) const override { return {}; }
  bool is_complete(const Question&, const AnswerDraft&) const noexcept override { return true; }
  Answer answer(const Question&, const AnswerDraft&) const override { return {}; }
  AnswerDraft draft_of(const Question&, const Answer&) const override { return {}; }
  std::string parse(const Question&, const std::string&, AnswerDraft&) const override { return ""; }
  std::string written(const Question&, const AnswerDraft&) const override { return ""; }
  AnswerView view(const Question&, const AnswerDraft&) const override { return {}; }
  std::string hint(const Question&, const HintTexts& texts) const override { return texts.go_on; }
  void simulate(const Question&, std::optional<double>, RandomStream&,
                AnswerDraft&) const noexcept override {}

  void read(Table& table, Question& question) const override {
    title_schema().read(table, question);
    reading_schema().read(table, question);
    video_schema().read(table, question);
    if (!question.video.empty() && !question.picture.empty()) {
      table.reject("video", fmt::format("\"{}\" beside a picture", question.video),
                   "a video or a picture");
    }
  }

  KeyEffect press(const Question&, const KeyPress& key, AnswerDraft&) const noexcept override {
    return key.key == KeyPress::kSpace ? KeyEffect::kGiven : KeyEffect::kNothing;
  }
};

}  // namespace

const QuestionKind& reading_kind() {
  static const ReadingKind kind;
  return kind;
}

}  // namespace haptrial::questions
