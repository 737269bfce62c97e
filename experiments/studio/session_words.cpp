#include "experiments/studio/session_words.h"

#include <fmt/format.h>

#include <regex>
#include <sstream>

#include "core/base/error.h"
#include "experiments/studio/study_folder.h"

namespace haptrial::experiments {
namespace {

/// @param pattern  of the values that are allowed  @param allowed  the same in words
void add_value(CommandWords& words, const char* option, const std::string& value,
               const char* pattern, const char* allowed) {
  if (value.empty()) {
    return;
  }
  if (!std::regex_match(value, std::regex(pattern))) {
    throw InputError(fmt::format("{} is not what it can be; allowed: {}", option + 2, allowed));
  }
  words.insert(words.end(), {option, value});
}

std::string first_match(const std::string& output, const std::regex& line) {
  std::istringstream lines(output);
  for (std::string each; std::getline(lines, each);) {
    if (std::smatch parts; std::regex_match(each, parts, line)) {
      return parts.str(1);
    }
  }
  return "";
}

}  // namespace

CommandWords session_words(const std::string& command, const SessionChoice& choice) {
  constexpr const char* kPlain = "up to 64 letters A to Z, digits, '_' and '-'";
  constexpr const char* kPlainPattern = "[A-Za-z0-9_][A-Za-z0-9_-]{0,63}";
  CommandWords words{command, choice.file};
  add_value(words, "--subject", choice.subject, kPlainPattern, kPlain);
  if (choice.session > 0) {
    words.insert(words.end(), {"--session", std::to_string(choice.session)});
  }
  for (const std::string& device : choice.devices) {
    add_value(words, "--device", device, kPlainPattern, kPlain);
  }
  add_value(words, "--language", choice.language, kPlainPattern, kPlain);
  add_value(words, "--handedness", choice.handedness, "left|right|both", "left, right, both");
  add_value(words, "--consent", choice.consent, "[A-Za-z0-9][A-Za-z0-9 .:_-]{0,63}",
            "up to 64 letters A to Z, digits, spaces, '.', ':', '_' and '-', such as a date");
  add_value(words, "--watch", choice.watch, "[0-9A-Fa-f][0-9A-Fa-f.:]{1,44}",
            "the numeric address of a network interface of this computer");
  for (const auto& [option, given] :
       {std::pair{"--window", choice.window}, std::pair{"--resume", choice.resume},
        std::pair{"--pilot", choice.pilot}}) {
    if (given) {
      words.emplace_back(option);
    }
  }
  words.insert(words.end(), {"--console", "--out", StudyFolder::sessions_of(choice.file)});
  return words;
}

SessionAddresses addresses_in(const std::string& output) {
  static const std::regex kConsole(R"(console: (http://127\.0\.0\.1:[0-9]+/\?token=[0-9a-f]{32}))");
  static const std::regex kWatch(
      R"(watch: (http://(?:[0-9.]+|\[[0-9a-f:]+\]):[0-9]+/\?token=[0-9a-f]{32}))");
  return {first_match(output, kConsole), first_match(output, kWatch)};
}

}  // namespace haptrial::experiments
