#include "protocols/definition/screen_options.h"

#include <fmt/format.h>

#include "core/base/definition/schema.h"
#include "protocols/definition/window_keys.h"

namespace haptrial::protocols {
namespace {

constexpr std::size_t kLongestText = 4000;  // [bytes]; more would not be legible on a screen

void read_mistake_key(Table& table, const std::string& key, ScreenOptions& options) {
  const std::string name = table.text(key);
  const auto code = name == "backspace" ? std::optional<int>(kBackspaceKey) : key_code(name);
  if (!code || *code == kSpaceKey || *code == kEnterKey) {
    table.reject(key, fmt::format("'{}'", name),
                 "backspace, A to Z, 0 to 9, left, right, up, down");
    return;
  }
  options.mistake_key = *code;
}

}  // namespace

const Schema<ScreenOptions>& screen_schema() {
  using O = ScreenOptions;
  constexpr long kMostMonitors = 16;
  static const auto schema =
      Schema<O>()
          .text("title", &O::title, "Title of the participant's window")
          .flag("full_screen", &O::full_screen,
                "Whether the participant's window fills the monitor")
          .integer("monitor", &O::monitor, 0, kMostMonitors - 1,
                   "Monitor of the participant's window, from 0, the primary one")
          .flag("refresh_lock", &O::refresh_lock, "Whether pictures wait for the monitor's refresh")
          .flag("participant_steers", &O::participant_steers,
                "Whether keys of the participant's window start, pause, repeat, skip and clear")
          .custom("mistake_key",
                  "Key by which participants say that their last answer was a mistake",
                  read_mistake_key)
          .otherwise("none")
          .choice("photodiode", &O::photodiode,
                  {{"off", Photodiode::kOff},
                   {"frames", Photodiode::kEveryFrame},
                   {"run", Photodiode::kRun},
                   {"onset", Photodiode::kOnset}},
                  "Square in a corner for a photodiode: it changes with each picture, is white "
                  "while a trial runs, or is white after onsets")
          .number("photodiode_time", &O::photodiode_time, {0.0, 10.0, true}, "s",
                  "Time for which the photodiode's square stays white after an onset");
  return schema;
}

const Schema<SessionTexts>& text_schema() {
  using T = SessionTexts;
  static const auto schema = [] {
    Schema<T> texts;
    const auto add = [&texts](const char* key, std::string T::*member, const char* description) {
      texts.shown_text(key, member, kLongestText, description);
    };
    const auto require = [&](const char* key, std::string T::*member, const char* description) {
      add(key, member, description);
      texts.required();
    };
    require("instructions", &T::instructions,
            "Text before the first trial; the first line of every text is its title");
    require("practice", &T::practice, "Text before practice");
    require("rest", &T::rest, "Text during a break");
    require("thanks", &T::thanks, "Text after the last trial");
    add("stopped", &T::stopped, "Text after a fault or an emergency stop");
    add("paused", &T::paused, "Text while the experimenter pauses the session");
    add("preparing", &T::preparing, "Text while a bone is built, before its first picture");
    add("recovering", &T::recovering, "Text while the force stays off after an aborted pass");
    add("limit", &T::limit, "Last paragraph of the instructions of a force study");
    add("begin", &T::begin, "Small line below a text that the experimenter ends");
    add("begin_alone", &T::begin_alone,
        "Small line below a text that ends with a key in a session without an experimenter");
    add("go_on", &T::go_on, "Small line below a page that is only read");
    add("choose", &T::choose, "Small line below a question with choices");
    add("move_mark", &T::move_mark, "Small line below a scale");
    add("place_mark", &T::place_mark, "Small line below a scale that the hand answers");
    add("click_mark", &T::click_mark, "Small line below a scale that the mouse answers");
    add("counts", &T::counts, "Text between practice and the first trial that counts");
    add("take_again", &T::take_again, "Text at the end of a break");
    add("type_number", &T::type_number, "Small line below a question for a number");
    add("type_words", &T::type_words, "Small line below a question for words");
    add("go_back", &T::go_back, "Second small line below a page that follows another one");
    add("answered", &T::answered,
        "Text after several questions, while answers may still be changed");
    add("mistake_noted", &T::mistake_noted,
        "Words over the picture for a moment after the key `mistake_key` of [screen]");
    add("declined", &T::declined, "Text for a participant who does not consent");
    return texts;
  }();
  return schema;
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
