#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "experiments/control/session_control.h"

namespace haptrial::experiments {

/// The status as one line of JSON; a number that is not finite becomes null, text that is not UTF-8
/// is mended. @param refused  requests that the console has turned away.
std::string status_json(const SessionStatus& status, std::uint64_t refused);

/// {"request": "pause"}; the names are start, pause, repeat, skip, abort, end, emergency_stop,
/// clear, take_lead, hand_over.
/// @throws InputError
Request parse_request(const std::string& json);

struct ConsoleNote {
  std::string text;
  bool bad_trial{false};  // the text says why a trial is bad
};

/// {"text": "..."}, 1 to 2000 bytes, or {"text": "...", "bad_trial": true}.
/// @throws InputError
ConsoleNote parse_note(const std::string& json);

/// {"number": 3, "text": "..."}: an answer to what a page asks.
/// @throws InputError
std::pair<int, std::string> parse_answer(const std::string& json);

/// "pause"
const char* name_of(Request request) noexcept;

/// console.html as it stands in the source; built in.
std::string_view console_page_template();

}  // namespace haptrial::experiments
