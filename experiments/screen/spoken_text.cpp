#include "experiments/screen/spoken_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/base/utf8.h"

namespace haptrial::experiments {
namespace {

using Kind = SpeechChange::Kind;

/// Without signs that are only looked at, such as the tick before "Correct" (U+2700 to U+27BF), and
/// with one space for several.
std::string pronounceable(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    const std::size_t bytes =
        std::clamp<std::size_t>(character_bytes(text.front()), 1, text.size());
    const std::string_view character = text.substr(0, bytes);
    const bool sign = character >= "\xe2\x9c\x80" && character <= "\xe2\x9e\xbf";
    const bool space = character == " " || character == "\n";
    if (space && !plain.empty() && plain.back() != ' ') {
      plain += ' ';
    } else if (!space && !sign) {
      plain += character;
    }
    text.remove_prefix(bytes);
  }
  plain.erase(plain.find_last_not_of(' ') + 1);
  return plain;
}

/// A choice as it is drawn, "[1]  The first" or "1   The first", with a colon after its key.
std::string spoken_choice(const std::string& line) {
  if (line.starts_with('[')) {
    const std::size_t end = line.find(']');
    return end == std::string::npos ? line
                                    : fmt::format("{}: {}", line.substr(1, end - 1),
                                                  pronounceable(line.substr(end + 1)));
  }
  const std::size_t gap = line.find("  ");
  return gap == std::string::npos
             ? line
             : fmt::format("{}: {}", line.substr(0, gap), pronounceable(line.substr(gap)));
}

/// Adds a sentence; each line of a text is one at least.
void add_sentence(std::string& words, const std::string& text) {
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = pronounceable(std::string_view(text).substr(begin, end - begin));
    if (!line.empty()) {
      words += words.empty() ? "" : " ";
      words += line;
      words += std::string_view(".!?:;,").find(line.back()) == std::string_view::npos ? "." : "";
    }
    begin = end + 1;
  }
}

std::string ends_of(const questions::ScaleView& scale) {
  return scale.numbers.empty() || scale.numbers.front() == scale.low_end
             ? fmt::format("{} – {}", scale.low_end, scale.high_end)
             : fmt::format("{}: {}. {}: {}", scale.numbers.front(), scale.low_end,
                           scale.numbers.back(), scale.high_end);
}

/// The choice, or the place of the mark; empty: none yet.
std::string chosen_in(const questions::AnswerView& answer) {
  if (answer.chosen < 0) {
    return "";
  }
  const auto place = static_cast<std::size_t>(answer.chosen);
  if (place < answer.choices.size()) {
    return spoken_choice(answer.choices[place]);
  }
  if (answer.scale && place < answer.scale->numbers.size()) {
    return answer.scale->numbers[place];
  }
  return answer.scale ? fmt::format("{} / {}", answer.chosen, answer.scale->steps) : "";
}

/// Whether the participant is to do something about the page.
bool asks(const render::TextPage& page) {
  const questions::AnswerView& answer = page.answer;
  return !page.hint.empty() || !answer.choices.empty() || answer.scale || answer.typed;
}

bool is_same_scale(const std::optional<questions::ScaleView>& a,
                   const std::optional<questions::ScaleView>& b) {
  return a.has_value() == b.has_value() &&
         (!a || (a->steps == b->steps && a->low_end == b->low_end && a->high_end == b->high_end));
}

/// Whether two pages ask the same, whatever is answered so far.
bool is_same_text(const render::TextPage& a, const render::TextPage& b) {
  return a.title == b.title && a.body == b.body && a.hint == b.hint && a.progress == b.progress &&
         a.answer.choices == b.answer.choices && is_same_scale(a.answer.scale, b.answer.scale) &&
         a.answer.typed.has_value() == b.answer.typed.has_value();
}

/// Typed characters that came last; after a character was taken back, those that are left.
std::string typed_between(const std::string& before, const std::string& now,
                          const std::string& hint) {
  if (now.size() > before.size() && now.starts_with(before)) {
    return now.substr(before.size());
  }
  return now.empty() ? hint : now;
}

}  // namespace

std::string words_of(const render::TextPage& page, const std::string& seconds) {
  const questions::AnswerView& answer = page.answer;
  std::string words;
  add_sentence(words, page.title);
  add_sentence(words, page.body);
  if (page.countdown) {
    add_sentence(words, fmt::format("{:.0f} {}", std::ceil(*page.countdown), seconds));
  }
  for (const std::string& choice : answer.choices) {
    add_sentence(words, spoken_choice(choice));
  }
  if (answer.scale) {
    add_sentence(words, ends_of(*answer.scale));
  }
  add_sentence(words, page.hint);
  add_sentence(words, page.progress);
  add_sentence(words, chosen_in(answer));
  add_sentence(words, answer.typed.value_or(""));
  return words;
}

SpeechChange speech_between(const protocols::PictureText& before, const protocols::PictureText& now,
                            const std::string& seconds) {
  const render::TextPage &was = before.page, &is = now.page;
  if (before.occasion != now.occasion || !is_same_text(was, is)) {
    std::string words = words_of(is, seconds);
    if (!words.empty()) {
      return {Kind::kSay, std::move(words)};
    }
    return {asks(was) ? Kind::kCut : Kind::kForget};
  }
  if (was.answer.typed != is.answer.typed) {
    return {Kind::kSay, typed_between(*was.answer.typed, *is.answer.typed, is.hint)};
  }
  if (was.answer.chosen != is.answer.chosen) {
    return {Kind::kSay, chosen_in(is.answer)};
  }
  if (is.hint_is_urgent && !was.hint_is_urgent) {
    return {Kind::kSay, pronounceable(is.hint)};
  }
  return {};
}

}  // namespace haptrial::experiments
