#include "experiments/study/session_name.h"

#include <fmt/format.h>

#include "core/record/rows/session_types.h"

namespace haptrial::experiments {

std::string session_file_name(const std::string& subject, int session, int sessions) {
  const std::size_t digits = std::to_string(sessions).size();
  return sessions > 1 ? fmt::format("{}-session-{:0{}}.h5", subject, session, digits)
                      : subject + ".h5";
}

int number_of_subject(const std::string& subject) {
  constexpr std::size_t kMostDigits = 5;
  constexpr int kMost = 10000;
  const auto letter = subject.find_last_not_of("0123456789");
  const std::string digits = subject.substr(letter == std::string::npos ? 0 : letter + 1);
  if (digits.empty() || digits.size() > kMostDigits) {
    return 0;
  }
  const int number = std::stoi(digits);
  return number <= kMost ? number : 0;
}

std::string replacement_of(const std::string& subject,
                           const std::function<bool(const std::string&)>& is_taken) {
  const std::size_t letters = subject.find_last_not_of("0123456789") + 1;
  std::string free = subject;
  for (char mark = 'b'; is_taken(free) && mark <= 'z'; ++mark) {
    free = subject.substr(0, letters) + mark + subject.substr(letters);
  }
  return free;
}

std::optional<int> recorded_number(const record::SessionInfo& info) {
  return info.participant_number != 0 && info.device != kNoDevice
             ? std::optional(static_cast<int>(info.participant_number))
             : std::nullopt;
}

int number_of_session(const record::SessionInfo& info) {
  return recorded_number(info).value_or(number_of_subject(info.subject));
}

}  // namespace haptrial::experiments
