#include "experiments/runner/page_input.h"

#include "core/questions/question_kind.h"

namespace haptrial::experiments {

using questions::KeyEffect;

PageInput::PageInput(const questions::Question& item, const protocols::SessionTexts& words,
                     bool may_go_back)
    : item_(item), kind_(*item.kind), words_(words), may_go_back_(may_go_back) {}

void PageInput::show_earlier(const questions::Answer& earlier) {
  draft_ = kind_.draft_of(item_, earlier);
}

/// A window tells a digit twice: as a key and as a character.
bool PageInput::hears(const KeyPress& key) const {
  const bool edits = key.key == KeyPress::kEnter || key.key == KeyPress::kBackspace;
  return kind_.traits().types ? key.character != 0 || edits : key.character == 0;
}

bool PageInput::is_way_back(const KeyPress& key) const {
  return may_go_back_ && key.key == KeyPress::kBackspace &&
         (!kind_.traits().types || draft_.typed.empty());
}

bool PageInput::press(const KeyPress& key) {
  if (!hears(key)) {
    return false;
  }
  goes_back_ = is_way_back(key);
  if (goes_back_) {
    return true;
  }
  const bool urgent = std::exchange(urgent_, false);
  const bool changed = press_item(key);
  urgent_ = !changed && !answer_ && kind_.traits().asks;
  return changed || urgent_ != urgent || answer_;
}

/// @returns whether the key changed the answer that is being given
bool PageInput::press_item(const KeyPress& key) {
  const KeyEffect effect =
      key.key == KeyPress::kEnter ? KeyEffect::kGiven : kind_.press(item_, key, draft_);
  if (effect == KeyEffect::kGiven) {
    enter();
  }
  return effect == KeyEffect::kChanged;
}

/// Does nothing while there is no answer that is allowed.
void PageInput::enter() {
  if (kind_.is_complete(item_, draft_)) {
    answer_ = kind_.answer(item_, draft_);
  }
}

std::string PageInput::give(const std::string& answer) {
  questions::AnswerDraft draft;
  const std::string problem = kind_.parse(item_, answer, draft);
  if (problem.empty()) {
    answer_ = kind_.answer(item_, draft);
  }
  return problem;
}

render::TextPage PageInput::page(std::shared_ptr<const render::Image> picture) const {
  render::TextPage page;
  page.title = item_.title;
  page.body = item_.text;
  page.hint = kind_.hint(item_, words_) + (may_go_back_ ? "\n" + words_.go_back : "");
  page.hint_is_urgent = urgent_;
  page.picture = std::move(picture);
  page.answer = kind_.view(item_, draft_);
  return page;
}

AskedItem PageInput::asked(int number) const {
  const questions::QuestionTraits traits = kind_.traits();
  AskedItem asked;
  asked.number = number;
  asked.kind = kind_.word();
  asked.asks = traits.asks;
  asked.consents = traits.consents;
  asked.title = item_.title;
  asked.text = item_.text;
  asked.picture_file = item_.picture;
  for (const questions::Choice& choice : item_.choices) {
    asked.choices.push_back(choice.label);
  }
  asked.low = item_.low;
  asked.high = item_.high;
  asked.step = item_.step;
  asked.low_end = item_.low_end;
  asked.high_end = item_.high_end;
  asked.hint = kind_.hint(item_, words_);
  asked.back = may_go_back_;
  asked.given = kind_.written(item_, draft_);
  return asked;
}

}  // namespace haptrial::experiments
