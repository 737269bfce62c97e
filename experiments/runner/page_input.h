#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/key_press.h"
#include "core/questions/question.h"
#include "core/render/flat/text_screen.h"
#include "core/render/gl/window.h"
#include "experiments/control/session_control.h"
#include "protocols/definition/screen_options.h"

namespace haptrial::experiments {

/// How one item of a page is answered, wherever: by single keys of the participant's window, or in
/// one go from the console or the terminal. Any one thread.
///
/// Keys do to the answer what its kind of question says; Enter gives it, and Backspace goes back
/// if nothing is typed. A key that does nothing makes the hint urgent.
class PageInput {
 public:
  /// Both outlive the input. @param may_go_back  there is an item before this one
  PageInput(const questions::Question& item, const protocols::SessionTexts& words,
            bool may_go_back = false);
  /// Shows an answer that was given before, for the participant to keep or to change.
  void show_earlier(const questions::Answer& earlier);

  /// A key of the participant's window. @returns whether what is shown has changed
  bool press(const KeyPress& key);
  /// A whole answer in words, as QuestionKind::parse() takes it.
  /// @returns a sentence if it is not allowed; else empty
  std::string give(const std::string& answer);

  /// Whether the participant asked for the item before.
  bool goes_back() const { return goes_back_; }
  /// The answer, once it was given.
  const std::optional<questions::Answer>& answer() const { return answer_; }
  /// The page as the participant sees it. @param picture  of the item, or null
  render::TextPage page(std::shared_ptr<const render::Image> picture) const;
  /// The item as the others see it, but for the picture's bytes. @param number  of the question
  AskedItem asked(int number) const;

 private:
  bool hears(const KeyPress& key) const;
  bool press_item(const KeyPress& key);
  bool is_way_back(const KeyPress& key) const;
  void enter();

  const questions::Question& item_;
  const questions::QuestionKind& kind_;
  const protocols::SessionTexts& words_;
  bool may_go_back_;
  bool goes_back_{false};
  questions::AnswerDraft draft_;
  bool urgent_{false};  // the last key did nothing
  std::optional<questions::Answer> answer_;
};

/// The keys of the participant's window on their way to a page: from the screen's thread to the
/// session's. While no page is open they are nobody's here.
class PageKeys {
 public:
  /// Screen's thread. @returns whether a page takes the key; Escape is never a page's
  bool take(const render::KeyPress& key) {
    const std::lock_guard lock(mutex_);
    if (!open_ || key.key == render::KeyPress::kEscape) {
      return false;
    }
    keys_.push_back(key);
    return true;
  }
  /// Session's thread.
  void set_open(bool open) {
    const std::lock_guard lock(mutex_);
    open_ = open;
    keys_.clear();
  }
  std::vector<render::KeyPress> pressed() {
    const std::lock_guard lock(mutex_);
    return std::exchange(keys_, {});
  }

 private:
  std::mutex mutex_;
  bool open_{false};
  std::vector<render::KeyPress> keys_;
};

}  // namespace haptrial::experiments
