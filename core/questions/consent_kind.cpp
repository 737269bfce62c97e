#include "core/questions/consent_kind.h"

#include <algorithm>

#include "core/questions/kind_parts.h"

namespace haptrial::questions {
namespace {

struct ConsentWords {
  std::string accept{"I agree to take part"};
  std::string decline{"I do not agree"};
};

const Schema<ConsentWords>& consent_schema() {
  using W = ConsentWords;
  static const auto schema =
      Schema<W>()
          .shown_text("accept", &W::accept, "Words of the choice of people who take part")
          .shown_text("decline", &W::decline,
                      "Words of the choice of people who do not take part, "
                      "which ends the session");
  return schema;
}

}  // namespace

const QuestionKind& consent_kind() {
  static const ConsentKind kind;
  return kind;
}

void ConsentKind::read(Table& table, Question& question) const {
  title_schema().read(table, question);
  reading_schema().read(table, question);
  const ConsentWords words = consent_schema().read(table);
  question.choices = {{"accepted", words.accept, 1.0}, {"declined", words.decline, 0.0}};
}

Answer ConsentKind::answer(const Question& question, const AnswerDraft& draft) const {
  Answer answer = ChoiceKind::answer(question, draft);
  answer.reason = draft.typed.view();
  return answer;
}

std::string ConsentKind::parse(const Question& question, const std::string& words,
                               AnswerDraft& draft) const {
  const std::size_t colon = std::min(words.find(':'), words.size());
  const std::size_t reason = words.find_first_not_of(": ", colon);
  const std::string problem = ChoiceKind::parse(question, words.substr(0, colon), draft);
  const bool agreed = problem.empty() && draft.chosen == 0;
  if (agreed && reason == std::string::npos) {
    return "the participant consents in the window; if a paper form is signed, answer with the "
           "number and the reason, as in \"1: paper form signed\"";
  }
  if (agreed) {
    draft.typed.set(words.substr(reason));
  }
  return problem;
}

void ConsentKind::simulate(const Question&, std::optional<double>, RandomStream&,
                           AnswerDraft& draft) const noexcept {
  draft.chosen = 0;
}

}  // namespace haptrial::questions
