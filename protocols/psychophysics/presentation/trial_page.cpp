#include "protocols/psychophysics/presentation/trial_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/questions/question_kind.h"
#include "protocols/psychophysics/presentation/trial_view.h"

namespace haptrial::protocols {
namespace {

/// How a question is answered, and its answer so far.
questions::AnswerView answer_view(const TrialsDefinition& d, const TrialQuestion& question,
                                  const TrialView& view) {
  questions::AnswerDraft draft;
  draft.chosen = view.chosen;
  draft.typed.set(view.typed.data());
  questions::AnswerView shown = question.kind->view(question, draft);
  if (shown.scale && question.mark.by != MarkedBy::kKeys) {
    shown.scale->length = question.mark.length / d.view.width;
  }
  for (std::size_t i = 0; i < question.means.size(); ++i) {
    shown.choices[i] = line_of(question, i);  // made at once, by keys of its own
  }
  return shown;
}

std::string verdict_of(const TrialsDefinition& d, const TrialView& view) {
  return view.verdict == Verdict::kRight   ? d.feedback_right
         : view.verdict == Verdict::kWrong ? d.feedback_wrong
                                           : "";
}

/// The page that tells the participant about an answer.
render::TextPage told_page(const TrialsDefinition& d, const TrialQuestion& question,
                           const TrialView& view) {
  const std::string pace = view.pace == Pace::kTooFast   ? question.fast_text
                           : view.pace == Pace::kTooSlow ? question.slow_text
                                                         : "";
  const std::string verdict = verdict_of(d, view);
  render::TextPage page;
  page.title = verdict.empty() ? pace : verdict;
  page.body = verdict.empty() ? "" : pace;
  return page;
}

std::string hint_of(const TrialsDefinition& d, const TrialQuestion& question) {
  return question.has_choices()                 ? ""
         : question.mark.by == MarkedBy::kHand  ? d.texts.place_mark
         : question.mark.by == MarkedBy::kMouse ? d.texts.click_mark
                                                : question.kind->hint(question, d.texts);
}

/// The page that tells what was measured.
render::TextPage result_page(const TrialsDefinition& d, const TrialView& view) {
  render::TextPage page;
  page.title = verdict_of(d, view);
  for (std::size_t i = 0; i < std::min(d.measures.size(), kMostMeasures); ++i) {
    if (std::isfinite(view.measured[i])) {
      page.body += (page.body.empty() ? "" : "\n") +
                   told_value(d.measures[i], static_cast<double>(view.measured[i]));
    }
  }
  return page;
}

render::TextPage asked_page(const TrialsDefinition& d, const TrialQuestion& question,
                            const TrialView& view) {
  render::TextPage page;
  page.title = question.text;
  page.answer = answer_view(d, question, view);
  page.hint = hint_of(d, question);
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
  } else if (view.results) {
    text.page = result_page(definition, view);
    text.occasion += kTexts - 1;
  } else if (view.number_shown) {
    text.page.title = fmt::format("{}", view.interval);
  }
  return text;
}

}  // namespace haptrial::protocols
