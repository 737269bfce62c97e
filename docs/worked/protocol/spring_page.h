#pragma once

#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "protocols/interface/auxiliary_page.h"

/// An assistant's page beside the console: shows the trial, and sets for how long each spring of
/// the following ones is felt, {"interval": 1.5} [s].
class SpringPage final : public haptrial::protocols::AuxiliaryPage {
 public:
  std::string_view name() const override { return "springs"; }
  std::string_view title() const override { return "assistant"; }
  std::string_view html() const override {
    return R"(<!doctype html><meta charset="utf-8"><title>Springs</title>
<p id="now"></p><p>Felt for <input id="interval" type="number" step="0.1"> s</p>
<script nonce="NONCE">
const token = new URLSearchParams(location.search).get("token");
const events = new EventSource("/springs/events?token=" + token);
const now = document.getElementById("now"), interval = document.getElementById("interval");
events.onmessage = (event) => { now.textContent = event.data; };
interval.onchange = () => fetch("/springs/ask", {
  method: "POST", body: JSON.stringify({interval: Number(interval.value)}),
  headers: {"Content-Type": "application/json", "X-Haptrial-Token": token}});
</script>)";
  }
  Events events() override {
    return [this] {
      const std::lock_guard lock(mutex_);
      return nlohmann::json{{"trial", trial_}, {"difference", difference_}}.dump();
    };
  }
  void ask(const std::string& json) override {
    const auto body = nlohmann::json::parse(json, nullptr, false);
    const bool number = body.is_object() && body.size() == 1 && body.contains("interval") &&
                        body["interval"].is_number();
    const double interval = number ? body["interval"].get<double>() : 0.0;
    if (!(interval >= 0.2 && interval <= 10.0)) {
      throw haptrial::InputError("the body must be {\"interval\": SECONDS}, 0.2 to 10");
    }
    const std::lock_guard lock(mutex_);
    interval_ = interval;
  }

  // The session's side.
  void show(int trial, double difference) {
    const std::lock_guard lock(mutex_);
    trial_ = trial;
    difference_ = difference;
  }
  std::optional<double> interval() const {
    const std::lock_guard lock(mutex_);
    return interval_;
  }

 private:
  mutable std::mutex mutex_;
  int trial_{0};
  double difference_{0.0};          // [N/m]
  std::optional<double> interval_;  // that was asked for [s]
};
