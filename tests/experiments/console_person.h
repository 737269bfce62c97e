#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tests/experiments/console_client.h"

namespace haptrial::test {

/// An experimenter at the console of a running command, without a browser: asks over HTTP what the
/// page asks, and sees what it shows.
class ConsolePerson {
 public:
  /// @param url  as `haptrial run --console` prints it
  /// @throws std::runtime_error where nobody listens there
  explicit ConsolePerson(const std::string& url);

  /// @returns whether the console took it. @param request  "start", "skip", ...
  bool ask(const std::string& request);
  /// Status that the page shows now; null before the first event.
  nlohmann::json status();
  /// Waits until the page shows a state, and a stage of a pass if one is named. States that came
  /// since the last request or status() count, however short they were.
  /// @returns false if the session ended before; else seen() is what the page showed.
  bool sees(const std::string& state, const std::string& stage = "");
  const nlohmann::json& seen() const;
  /// Watches for a state that must not come. @returns whether the page showed it in these seconds
  bool sees_within(double seconds, const std::string& state);

 private:
  void hear();  // reads what comes within a moment
  bool next();  // moves on to the next event that was heard; false if there is none
  bool comes_to(const std::string& state, const std::string& stage);  // in what was heard

  std::string host_;
  int port_;
  std::string token_;
  std::unique_ptr<RawClient> events_;
  std::string heard_;
  std::unique_ptr<nlohmann::json> seen_;
};

}  // namespace haptrial::test
