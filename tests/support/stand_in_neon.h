#pragma once

#include <fmt/format.h>
#include <httplib.h>

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace haptrial::test {

/// The phone of a Pupil Labs Neon: its interface over HTTP, as far as channels use it.
class StandInNeon {
 public:
  struct State {
    int battery{93};
    std::string battery_state{"OK"};
    long long memory{101'001'773'056};  // free [bytes]
    bool gaze_connected{true};
    bool recording{false};
    long long recorded_ns{0};
  };

  /// @param port  of this machine; 0: a free one
  explicit StandInNeon(int port = 0) {
    server_.set_keep_alive_timeout(1);
    server_.Get("/api/status", [this](const httplib::Request&, httplib::Response& response) {
      const std::lock_guard lock(mutex_);
      if (asked_) {
        asked_();
      }
      response.status = status_;
      response.set_content(garbage_.empty() ? answer() : garbage_, "application/json");
    });
    for (const std::string path : {"recording:start", "recording:stop_and_save"}) {
      server_.Post(
          "/api/" + path, [this, path](const httplib::Request&, httplib::Response& response) {
            const std::lock_guard lock(mutex_);
            posts_.push_back(path);
            const bool start = path == "recording:start";
            response.status = start && state_.recording ? 500 : 200;
            response.set_content(response.status == 200
                                     ? R"({"message": "Success", "result": {"id": "r-1"}})"
                                     : R"({"message": "Already recording", "result": null})",
                                 "application/json");
            state_.recording = start;
          });
    }
    server_.Post("/api/event",
                 [this](const httplib::Request& request, httplib::Response& response) {
                   const std::lock_guard lock(mutex_);
                   events_.push_back(request.body);
                   response.status = status_;
                   response.set_content(R"({"message": "Success"})", "application/json");
                 });
    port_ = port == 0 ? server_.bind_to_any_port("127.0.0.1") : port;
    if (port != 0 && !server_.bind_to_port("127.0.0.1", port)) {
      throw std::runtime_error("the port is taken");
    }
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    while (!server_.is_running()) {
      std::this_thread::yield();
    }
  }
  ~StandInNeon() {
    server_.stop();
    thread_.join();
  }
  StandInNeon(const StandInNeon&) = delete;
  StandInNeon& operator=(const StandInNeon&) = delete;

  int port() const { return port_; }
  /// Changes the state under a lock.
  void change(const std::function<void(State&)>& change) {
    const std::lock_guard lock(mutex_);
    change(state_);
  }
  /// Called within each question for the state, before the answer is made.
  void when_asked(std::function<void()> asked) {
    const std::lock_guard lock(mutex_);
    asked_ = std::move(asked);
  }
  /// Answers with this text; empty: with the state again.
  void answer_with(const std::string& garbage, int status = 200) {
    const std::lock_guard lock(mutex_);
    garbage_ = garbage;
    status_ = status;
  }
  /// The bodies of the events so far.
  std::vector<std::string> events() const {
    const std::lock_guard lock(mutex_);
    return events_;
  }
  std::vector<std::string> posts() const {
    const std::lock_guard lock(mutex_);
    return posts_;
  }
  /// For when_asked(), which already has the lock.
  State& state() { return state_; }

 private:
  std::string answer() const {
    std::string parts = fmt::format(
        R"({{"model": "Phone", "data": {{"battery_level": {}, "battery_state": "{}", "memory": {},
            "memory_state": "OK", "device_name": "Neon", "time_echo_port": 12321}}}},
        {{"model": "Hardware", "data": {{"version": "2.0", "module_serial": "m-1"}}}},
        {{"model": "Sensor", "data": {{"sensor": "gaze", "conn_type": "DIRECT", "connected": {},
            "stream_error": false, "protocol": "rtsp"}}}})",
        state_.battery, state_.battery_state, state_.memory, state_.gaze_connected);
    if (state_.recording) {
      parts += fmt::format(R"(, {{"model": "Recording", "data": {{"id": "r-1", "action": "START",
            "message": "", "rec_duration_ns": {}}}}})",
                           state_.recorded_ns);
    }
    return fmt::format(R"({{"message": "Success", "result": [{}]}})", parts);
  }

  httplib::Server server_;
  int port_{0};
  mutable std::mutex mutex_;  // of what follows
  State state_;
  std::function<void()> asked_;
  std::string garbage_;
  int status_{200};
  std::vector<std::string> posts_;
  std::vector<std::string> events_;
  std::thread thread_;
};

}  // namespace haptrial::test
