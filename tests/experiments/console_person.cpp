#include "tests/experiments/console_person.h"

#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>

#include "tests/experiments/live_command.h"

namespace haptrial::test {

using nlohmann::json;

ConsolePerson::ConsolePerson(const std::string& url) {
  std::smatch part;
  if (!std::regex_match(url, part, std::regex("http://([0-9.]+:([0-9]+))/\\?token=(\\w+)"))) {
    throw std::runtime_error("no address of a console: '" + url + "'");
  }
  host_ = part[1];
  port_ = std::stoi(part[2]);
  token_ = part[3];
  events_ = std::make_unique<RawClient>(port_);
  RawRequest request;
  request.method = "GET";
  request.target = "/events?token=" + token_;
  request.host = host_;
  request.body.clear();
  events_->send(request.text());
}

bool ConsolePerson::ask(const std::string& request) const {
  RawRequest asked;
  asked.host = host_;
  asked.token = token_;
  asked.body = json{{"request", request}}.dump();
  RawClient client(port_);
  client.send(asked.text());
  return status_of(client.receive(kPatience)) == 200;
}

json ConsolePerson::status() {
  if (!events_->closed()) {
    heard_ += events_->receive(0.2, "\n\n");
  }
  const auto end = heard_.rfind("\n\n");
  const auto from = end == std::string::npos ? end : heard_.rfind("data: {", end);
  if (from == std::string::npos) {
    return {};
  }
  heard_.erase(0, from);
  return json::parse(heard_.substr(6, end - from - 6));
}

bool ConsolePerson::sees(const std::string& state, const std::string& stage, double seconds) {
  return eventually(
      [&] {
        const json now = status();
        return !now.is_null() && now["state"] == state && (stage.empty() || now["stage"] == stage);
      },
      seconds);
}

}  // namespace haptrial::test
