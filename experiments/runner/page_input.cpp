#include "experiments/runner/page_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/utf8.h"

namespace haptrial::experiments {
namespace {

using pages::ItemKind;
using render::KeyPress;

constexpr int kNumberedSteps = 10;  // of a scale, at most; more numbers would run into each other
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

std::optional<double> number_in(std::string text) {
  std::replace(text.begin(), text.end(), ',', '.');  // of those who write decimals with a comma
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::string utf8_of(char32_t c) {
  const auto byte = [](char32_t bits) { return static_cast<char>(bits); };
  if (c < 0x80) {
    return {byte(c)};
  }
  if (c < 0x800) {
    return {byte(0xc0 | (c >> 6)), byte(0x80 | (c & 0x3f))};
  }
  if (c < 0x10000) {
    return {byte(0xe0 | (c >> 12)), byte(0x80 | ((c >> 6) & 0x3f)), byte(0x80 | (c & 0x3f))};
  }
  return {byte(0xf0 | (c >> 18)), byte(0x80 | ((c >> 12) & 0x3f)), byte(0x80 | ((c >> 6) & 0x3f)),
          byte(0x80 | (c & 0x3f))};
}

const char* kind_of(const pages::Item& item) {
  switch (item.kind) {
    case ItemKind::kRead:
      return "read";
    case ItemKind::kConsent:
      return "consent";
    case ItemKind::kChoice:
      return "choice";
    case ItemKind::kScale:
      return "scale";
    case ItemKind::kNumber:
      return "number";
    case ItemKind::kText:
      break;
  }
  return "words";
}

}  // namespace

PageInput::PageInput(const pages::Item& item, const protocols::SessionTexts& words,
                     bool may_go_back)
    : item_(item), words_(words), may_go_back_(may_go_back) {}

void PageInput::show_earlier(const PageAnswer& earlier) {
  if (chooses()) {
    const auto same = [&](const pages::ItemChoice& each) { return each.value == earlier.text; };
    const auto found = std::ranges::find_if(item_.choices, same);
    chosen_ = found == item_.choices.end() ? -1 : static_cast<int>(found - item_.choices.begin());
  } else if (item_.kind == ItemKind::kScale) {
    chosen_ = static_cast<int>(std::lround((earlier.value - item_.low) / item_.step));
  } else if (item_.kind == ItemKind::kNumber) {
    typed_ = fmt::format("{}", earlier.value);
  } else {
    typed_ = earlier.text;
  }
}

/// The answer that is chosen or typed at the moment.
std::string PageInput::given() const {
  if (item_.kind == ItemKind::kScale) {
    return chosen_ < 0 ? "" : fmt::format("{:g}", item_.low + item_.step * chosen_);
  }
  return chooses() ? (chosen_ < 0 ? "" : fmt::format("{}", chosen_ + 1)) : typed_;
}

bool PageInput::chooses() const {
  return item_.kind == ItemKind::kChoice || item_.kind == ItemKind::kConsent;
}

int PageInput::steps() const {
  return static_cast<int>(std::lround((item_.high - item_.low) / item_.step));
}

/// A window tells a digit twice: as a key and as a character.
bool PageInput::hears(const KeyPress& key) const {
  const bool types = item_.kind == ItemKind::kNumber || item_.kind == ItemKind::kText;
  const bool edits = key.key == KeyPress::kEnter || key.key == KeyPress::kBackspace;
  return types ? key.character != 0 || edits : key.character == 0;
}

bool PageInput::is_way_back(const KeyPress& key) const {
  const bool types = item_.kind == ItemKind::kNumber || item_.kind == ItemKind::kText;
  return may_go_back_ && key.key == KeyPress::kBackspace && (!types || typed_.empty());
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
  urgent_ = !changed && !answer_ && item_.kind != ItemKind::kRead;
  return changed || urgent_ != urgent || answer_;
}

/// @returns whether the key chose, moved or typed something.
bool PageInput::press_item(const KeyPress& key) {
  if (key.key == KeyPress::kEnter) {
    enter();
    return false;
  }
  if (chooses()) {
    return press_choice(key.key);
  }
  if (item_.kind == ItemKind::kScale) {
    return press_scale(key.key);
  }
  if (item_.kind == ItemKind::kRead) {
    if (key.key == KeyPress::kSpace) {
      enter();
    }
    return false;
  }
  return press_typed(key);
}

bool PageInput::press_choice(int key) {
  const int before = chosen_;
  const int last = static_cast<int>(item_.choices.size()) - 1;
  if (key >= '1' && key <= '9' && key - '1' <= last) {
    chosen_ = key - '1';
  } else if (key == KeyPress::kDown || key == KeyPress::kRight) {
    chosen_ = std::min(last, chosen_ + 1);
  } else if (key == KeyPress::kUp || key == KeyPress::kLeft) {
    chosen_ = chosen_ < 0 ? last : std::max(0, chosen_ - 1);
  }
  return chosen_ != before;
}

/// The mark appears in the middle: where it begins is no answer.
bool PageInput::press_scale(int key) {
  if (key >= '0' && key <= '9') {
    return type_mark(static_cast<char>(key));
  }
  typed_.clear();
  const int before = chosen_;
  const int move = key == KeyPress::kRight || key == KeyPress::kUp    ? 1
                   : key == KeyPress::kLeft || key == KeyPress::kDown ? -1
                                                                      : 0;
  if (move != 0) {
    chosen_ = std::clamp((chosen_ < 0 ? steps() / 2 : chosen_) + move, 0, steps());
  }
  return chosen_ != before;
}

/// The mark goes to the number that the digits so far make, if the scale has it.
bool PageInput::type_mark(char digit) {
  const auto step_of = [this](const std::string& digits) {
    return static_cast<int>(std::lround((*number_in(digits) - item_.low) / item_.step));
  };
  typed_ += digit;
  if (step_of(typed_) > steps()) {
    typed_ = digit;
  }
  const int step = step_of(typed_);
  if (step < 0 || step > steps()) {
    return false;
  }
  chosen_ = step;
  return true;
}

bool PageInput::press_typed(const KeyPress& key) {
  if (key.key == KeyPress::kBackspace && !typed_.empty()) {
    typed_.resize(whole_characters(typed_, typed_.size() - 1));
    return true;
  }
  const bool allowed =
      item_.kind == ItemKind::kText
          ? key.character >= ' ' && key.character != 0x7f
          : key.character != 0 && key.character < 0x80 &&
                std::string_view("0123456789.,-").find(static_cast<char>(key.character)) !=
                    std::string_view::npos;
  const std::string character = allowed ? utf8_of(key.character) : "";
  if (character.empty() || typed_.size() + character.size() > pages::kTextBytes) {
    return false;
  }
  typed_ += character;
  return true;
}

/// Does nothing while there is no answer that is allowed.
void PageInput::enter() {
  if (chooses()) {
    if (chosen_ >= 0) {
      give_choice(fmt::format("{}", chosen_ + 1));
    }
  } else if (item_.kind == ItemKind::kScale) {
    if (chosen_ >= 0) {
      answer_ = PageAnswer{item_.low + item_.step * chosen_, ""};
    }
  } else {
    give(typed_);
  }
}

std::string PageInput::give(const std::string& answer) {
  switch (item_.kind) {
    case ItemKind::kRead:
      answer_ = PageAnswer{kNoNumber, ""};
      return "";
    case ItemKind::kConsent:
      return give_consent(answer);
    case ItemKind::kChoice:
      return give_choice(answer);
    case ItemKind::kScale:
    case ItemKind::kNumber:
      return give_number(answer);
    case ItemKind::kText:
      break;
  }
  if (answer.size() > pages::kTextBytes || answer.find('\0') != std::string::npos) {
    return fmt::format("the answer has {} bytes; allowed: at most {}, without zero bytes",
                       answer.size(), pages::kTextBytes);
  }
  answer_ = PageAnswer{kNoNumber, answer};
  return "";
}

std::string PageInput::give_choice(const std::string& answer) {
  const auto number = number_in(answer);
  const auto count = static_cast<double>(item_.choices.size());
  if (!number || *number != std::floor(*number) || *number < 1.0 || *number > count) {
    return fmt::format("the answer is '{}'; allowed: the number of a choice, 1 to {}",
                       cut_text(answer, 40), count);
  }
  const pages::ItemChoice& choice = item_.choices[static_cast<std::size_t>(*number) - 1];
  answer_ = PageAnswer{choice.number, choice.value};
  return "";
}

std::string PageInput::give_consent(const std::string& answer) {
  const std::size_t colon = std::min(answer.find(':'), answer.size());
  const std::size_t reason = answer.find_first_not_of(": ", colon);
  const std::string problem = give_choice(answer.substr(0, colon));
  const bool agreed = answer_ && answer_->value != 0.0;
  if (agreed && reason == std::string::npos) {
    answer_.reset();
    return "the participant consents in the window; if a paper form is signed, answer with the "
           "number and the reason, as in \"1: paper form signed\"";
  }
  if (agreed) {
    answer_->reason = answer.substr(reason);
  }
  return problem;
}

std::string PageInput::give_number(const std::string& answer) {
  const auto number = number_in(answer);
  if (!number || *number < item_.low || *number > item_.high) {
    return fmt::format("the answer is '{}'; allowed: a number from {:g} to {:g}",
                       cut_text(answer, 40), item_.low, item_.high);
  }
  const double steps = item_.kind == ItemKind::kScale ? (*number - item_.low) / item_.step : 0.0;
  if (std::abs(steps - std::round(steps)) > 1e-6) {
    return fmt::format("the answer is {:g}; allowed: {:g} to {:g} in steps of {:g}", *number,
                       item_.low, item_.high, item_.step);
  }
  answer_ = PageAnswer{*number, ""};
  return "";
}

/// The small line below the page; a number's names its bounds.
std::string PageInput::hint() const {
  switch (item_.kind) {
    case ItemKind::kRead:
      return words_.go_on;
    case ItemKind::kConsent:
    case ItemKind::kChoice:
      return words_.choose;
    case ItemKind::kScale:
      return words_.move_mark;
    case ItemKind::kNumber:
      return fmt::format("{} ({:g} – {:g})", words_.type_number, item_.low, item_.high);
    case ItemKind::kText:
      break;
  }
  return words_.type_words;
}

render::TextPage PageInput::page(std::shared_ptr<const render::Image> picture) const {
  render::TextPage page;
  page.title = item_.title;
  page.body = item_.text;
  page.hint = hint() + (may_go_back_ ? "\n" + words_.go_back : "");
  page.hint_is_urgent = urgent_;
  page.picture = std::move(picture);
  page.chosen = chosen_;
  if (chooses()) {
    for (std::size_t i = 0; i < item_.choices.size(); ++i) {
      page.choices.push_back(fmt::format("{}   {}", i + 1, item_.choices[i].label));
    }
  } else if (item_.kind == ItemKind::kScale) {
    page.scale = render::PageScale{steps(), item_.low_end, item_.high_end};
    if (item_.low_end.empty()) {
      page.scale->low_end = fmt::format("{:g}", item_.low);
      page.scale->high_end = fmt::format("{:g}", item_.high);
    } else if (steps() <= kNumberedSteps) {
      for (int step = 0; step <= steps(); ++step) {
        page.scale->numbers.push_back(fmt::format("{:g}", item_.low + item_.step * step));
      }
    }
  } else if (item_.kind == ItemKind::kNumber || item_.kind == ItemKind::kText) {
    page.typed = typed_;
  }
  return page;
}

AskedItem PageInput::asked(int number) const {
  AskedItem asked;
  asked.number = number;
  asked.kind = kind_of(item_);
  asked.title = item_.title;
  asked.text = item_.text;
  asked.picture_file = item_.picture;
  for (const pages::ItemChoice& choice : item_.choices) {
    asked.choices.push_back(choice.label);
  }
  if (item_.kind == ItemKind::kScale || item_.kind == ItemKind::kNumber) {
    asked.low = item_.low;
    asked.high = item_.high;
    asked.step = item_.kind == ItemKind::kScale ? item_.step : 0.0;
    asked.low_end = item_.low_end;
    asked.high_end = item_.high_end;
  }
  asked.hint = hint();
  asked.back = may_go_back_;
  asked.given = given();
  return asked;
}

}  // namespace haptrial::experiments
