#include "protocols/definition/screen_options.h"

#include <fmt/format.h>

#include "core/base/definition/table.h"

namespace haptrial::protocols {
namespace {

constexpr std::size_t kLongestText = 4000;  // [bytes]; more would not be legible on a screen

std::string read_text(Table& table, std::string_view key, std::string_view otherwise = "") {
  const std::string text =
      otherwise.empty() ? table.shown_text(key) : table.shown_text(key, otherwise);
  if (text.size() > kLongestText) {
    table.reject(key, fmt::format("{} bytes long", text.size()),
                 fmt::format("at most {} bytes", kLongestText));
  }
  return text;
}

Photodiode read_photodiode(Table& table) {
  const std::string when = table.choice("photodiode", {"off", "frames", "run", "onset"});
  if (when == "frames") {
    return Photodiode::kEveryFrame;
  }
  return when == "run" ? Photodiode::kRun : when == "onset" ? Photodiode::kOnset : Photodiode::kOff;
}

}  // namespace

ScreenOptions read_screen_options(Table& table) {
  ScreenOptions options;
  if (table.has("title")) {
    options.title = table.text("title");
  }
  if (table.has("full_screen")) {
    options.full_screen = table.boolean("full_screen");
  }
  if (table.has("monitor")) {
    constexpr long kMostMonitors = 16;
    options.monitor = static_cast<int>(table.integer("monitor", 0, kMostMonitors - 1));
  }
  if (table.has("refresh_lock")) {
    options.refresh_lock = table.boolean("refresh_lock");
  }
  if (table.has("participant_steers")) {
    options.participant_steers = table.boolean("participant_steers");
  }
  if (table.has("photodiode")) {
    options.photodiode = read_photodiode(table);
  }
  if (table.has("photodiode_time")) {
    options.photodiode_time = table.number("photodiode_time", {0.0, 10.0, true}, "s");
  }
  return options;
}

SessionTexts read_session_texts(Table& table) {
  SessionTexts texts;
  texts.instructions = read_text(table, "instructions");
  texts.practice = read_text(table, "practice");
  texts.rest = read_text(table, "rest");
  texts.thanks = read_text(table, "thanks");
  const auto read_if_there = [&table](std::string_view key, std::string& text) {
    table.otherwise(key, text);
    text = read_text(table, key, text);
  };
  read_if_there("stopped", texts.stopped);
  read_if_there("paused", texts.paused);
  read_if_there("preparing", texts.preparing);
  read_if_there("recovering", texts.recovering);
  read_if_there("limit", texts.limit);
  read_if_there("begin", texts.begin);
  read_if_there("begin_alone", texts.begin_alone);
  read_if_there("go_on", texts.go_on);
  read_if_there("choose", texts.choose);
  read_if_there("move_mark", texts.move_mark);
  read_if_there("counts", texts.counts);
  read_if_there("take_again", texts.take_again);
  read_if_there("type_number", texts.type_number);
  read_if_there("type_words", texts.type_words);
  read_if_there("declined", texts.declined);
  return texts;
}

render::TextPage page_of(const std::string& text, const std::string& hint) {
  render::TextPage page;
  const std::size_t end = text.find('\n');
  page.title = text.substr(0, end);
  if (end != std::string::npos) {
    const std::size_t body = text.find_first_not_of("\r\n", end);
    page.body = body == std::string::npos ? "" : text.substr(body);
    page.body.erase(page.body.find_last_not_of("\r\n ") + 1);
  }
  page.hint = hint;
  return page;
}

}  // namespace haptrial::protocols
