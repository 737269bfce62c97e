#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tests/experiments/console_client.h"
#include "tests/experiments/live_command.h"

namespace haptrial::test {

/// An experimenter at the console of a running command, without a browser: asks over HTTP what the
/// page asks, and sees what it shows.
class ConsolePerson {
 public:
  /// @param url  as `haptrial run --console` prints it
  /// @throws std::runtime_error where nobody listens there
  explicit ConsolePerson(const std::string& url);

  /// @returns whether the console took it. @param request  "start", "skip", ...
  bool ask(const std::string& request) const;
  /// What the page shows now; null before the first event.
  nlohmann::json status();
  /// Whether the session comes to a state, and to a stage of a pass where one is named.
  bool sees(const std::string& state, const std::string& stage = "", double seconds = kPatience);

 private:
  std::string host_;
  int port_;
  std::string token_;
  std::unique_ptr<RawClient> events_;
  std::string heard_;
};

}  // namespace haptrial::test
