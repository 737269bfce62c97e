#pragma once

#include <optional>
#include <string>

#include "core/pages/page.h"
#include "core/render/flat/text_screen.h"
#include "core/render/gl/window.h"
#include "experiments/control/asked_item.h"
#include "protocols/definition/screen_options.h"

namespace haptrial::experiments {

/// An answer to an item of a page, as the session file has it.
struct PageAnswer {
  double value{0.0};  // NaN: it is no number
  std::string text;
  std::string reason{};  // of an experimenter who consents in the participant's place
};

/// How one item is answered, wherever: by single keys of the participant's window, or in one go
/// from the console or the terminal. Any one thread.
///
/// Keys: digits and arrows choose and move the mark of a scale, characters are typed, Enter gives
/// the answer; Backspace goes back where nothing is typed. A key that does nothing makes the hint
/// urgent.
class PageInput {
 public:
  /// Both outlive the input. @param may_go_back  there is an item before this one
  PageInput(const pages::Item& item, const protocols::SessionTexts& words,
            bool may_go_back = false);
  /// Shows an answer that was given before, for the participant to keep or to change.
  void show_earlier(const PageAnswer& earlier);

  /// A key of the participant's window. @returns whether what is shown has changed
  bool press(const render::KeyPress& key);
  /// A whole answer: of choices the number of one, from 1; of scales and numbers a number; any
  /// text; of what is read anything. Consent is the participant's: an experimenter agrees only with
  /// a reason, "1: paper form signed". @returns a sentence if it is not allowed; else empty
  std::string give(const std::string& answer);

  /// Whether the participant asked for the item before.
  bool goes_back() const { return goes_back_; }
  /// The answer, once it was given.
  const std::optional<PageAnswer>& answer() const { return answer_; }
  /// The page as the participant sees it. @param picture  of the item, or null
  render::TextPage page(std::shared_ptr<const render::Image> picture) const;
  /// The item as the others see it, but for the picture's bytes. @param number  of the question
  AskedItem asked(int number) const;

 private:
  bool chooses() const;
  bool hears(const render::KeyPress& key) const;
  bool press_item(const render::KeyPress& key);
  bool press_choice(int key);
  bool type_mark(char digit);
  bool press_scale(int key);
  bool press_typed(const render::KeyPress& key);
  bool is_way_back(const render::KeyPress& key) const;
  std::string given() const;
  void enter();
  int steps() const;
  std::string give_choice(const std::string& answer);
  std::string give_number(const std::string& answer);
  std::string give_consent(const std::string& answer);
  std::string hint() const;

  const pages::Item& item_;
  const protocols::SessionTexts& words_;
  bool may_go_back_;
  bool goes_back_{false};
  int chosen_{-1};  // choice, or step of a scale
  std::string typed_;
  bool urgent_{false};  // the last key did nothing
  std::optional<PageAnswer> answer_;
};

}  // namespace haptrial::experiments
