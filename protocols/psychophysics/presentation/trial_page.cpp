#include "protocols/psychophysics/presentation/trial_page.h"

#include <fmt/format.h>

#include "core/questions/question_kind.h"
#include "protocols/psychophysics/presentation/trial_view.h"

namespace haptrial::protocols {
namespace {

/// How a question is answered, and its answer so far.
questions::AnswerView answer_view(const TrialQuestion& question, const TrialView& view) {
  questions::AnswerDraft draft;
  draft.chosen = view.chosen;
  draft.typed.set(view.typed.data());
  questions::AnswerView shown = question.kind->view(question, draft);
  for (std::size_t i = 0; i < question.means.size(); ++i) {
    shown.choices[i] = line_of(question, i);  // made at once, by keys of its own
  }
  return shown;
}

/// The page that tells the participant about an answer.
render::TextPage told_page(const TrialsDefinition& d, const TrialQuestion& question,
                           const TrialView& view) {
  const std::string pace = view.pace == Pace::kTooFast   ? question.fast_text
                           : view.pace == Pace::kTooSlow ? question.slow_text
                                                         : "";
  const std::string verdict = view.verdict == Verdict::kRight   ? d.feedback_right
                              : view.verdict == Verdict::kWrong ? d.feedback_wrong
                                                                : "";
  render::TextPage page;
  page.title = verdict.empty() ? pace : verdict;
  page.body = verdict.empty() ? "" : pace;
  return page;
}

render::TextPage asked_page(const TrialsDefinition& d, const TrialQuestion& question,
                            const TrialView& view) {
  render::TextPage page;
  page.title = question.text;
  page.answer = answer_view(question, view);
  page.hint = question.has_choices() ? "" : question.kind->hint(question, d.texts);
  page.hint_is_urgent = view.refused;
  return page;
}

}  // namespace

std::string line_of(const TrialQuestion& question, std::size_t choice) {
  const std::string& hint = question.means[choice].hint;
  return (hint.empty() ? "" : fmt::format("[{}]  ", hint)) + question.choices[choice].label;
}

PictureText text_of(const TrialsDefinition& definition, const TrialView& view) {
  constexpr std::int64_t kTexts = 1024;  // in one trial, at most
  PictureText text;
  text.occasion = kTexts * (view.trial + 1);
  if (view.question > 0) {
    const TrialQuestion& question = definition.questions[view.question - 1U];
    text.page = view.told() ? told_page(definition, question, view)
                            : asked_page(definition, question, view);
    text.occasion += 2 * view.question + (view.told() ? 1 : 0);
  } else if (view.number_shown) {
    text.page.title = fmt::format("{}", view.interval);
  }
  return text;
}

}  // namespace haptrial::protocols
