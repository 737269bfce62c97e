#include "tests/experiments/console_person.h"

#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>

#include "tests/support/wait.h"

namespace haptrial::test {

using nlohmann::json;

ConsolePerson::ConsolePerson(const std::string& url) : seen_(std::make_unique<json>()) {
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

bool ConsolePerson::ask(const std::string& request) {
  status();  // what came before does not count
  RawRequest asked;
  asked.host = host_;
  asked.token = token_;
  asked.body = json{{"request", request}}.dump();
  RawClient client(port_);
  client.send(asked.text());
  return status_of(client.receive(RawClient::kForever)) == 200;
}

void ConsolePerson::hear() {
  if (!events_->closed()) {
    heard_ += events_->receive(0.1);  // the console sends more than ten events a second
  }
}

bool ConsolePerson::next() {
  const auto from = heard_.find("data: {");
  const auto end = heard_.find("\n\n", from);
  if (from == std::string::npos || end == std::string::npos) {
    return false;
  }
  *seen_ = json::parse(heard_.substr(from + 6, end - from - 6));
  heard_.erase(0, end);
  return true;
}

bool ConsolePerson::comes_to(const std::string& state, const std::string& stage) {
  while (next()) {
    if (seen()["state"] == state && (stage.empty() || seen()["stage"] == stage)) {
      return true;
    }
  }
  return false;
}

json ConsolePerson::status() {
  hear();
  while (next()) {
  }
  return seen();
}

const json& ConsolePerson::seen() const { return *seen_; }

bool ConsolePerson::sees(const std::string& state, const std::string& stage) {
  bool found = false;
  wait_until([&] {
    hear();
    found = comes_to(state, stage);
    return found || events_->closed();
  });
  return found;
}

bool ConsolePerson::sees_within(double seconds, const std::string& state) {
  return happens_within(seconds, [&] {
    hear();
    return comes_to(state, "");
  });
}

}  // namespace haptrial::test
