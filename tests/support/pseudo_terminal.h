#pragma once

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace haptrial::test {

/// A serial line whose other end the test holds, and hears with a thread of its own.
class PseudoTerminal {
 public:
  struct Heard {
    std::uint8_t byte;
    std::int64_t time_ns;  // when it was read, on CLOCK_MONOTONIC
  };

  PseudoTerminal() {
    int slave = -1;
    std::array<char, 256> name{};
    termios raw{};
    cfmakeraw(&raw);
    if (openpty(&master_, &slave, name.data(), &raw, nullptr) != 0) {
      throw std::runtime_error("no pseudo-terminal can be opened");
    }
    name_ = name.data();
    slave_ = slave;  // stays open: a master without a slave hears a hang-up
    thread_ = std::thread([this] { listen(); });
  }
  ~PseudoTerminal() {
    stop_.store(true);
    thread_.join();
    hang_up();
  }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  const std::string& name() const { return name_; }
  std::vector<Heard> heard() const {
    const std::lock_guard lock(mutex_);
    return heard_;
  }
  std::vector<int> bytes() const {
    std::vector<int> all;
    for (const Heard& each : heard()) {
      all.push_back(each.byte);
    }
    return all;
  }
  /// The device sends these bytes.
  void send(std::string_view text) const {
    while (!text.empty()) {
      const ssize_t count = write(master_, text.data(), text.size());
      if (count <= 0) {
        throw std::runtime_error("the pseudo-terminal takes nothing");
      }
      text.remove_prefix(static_cast<std::size_t>(count));
    }
  }
  /// The device takes no bytes for a while, so that the line is full.
  void hold() const { tcflow(slave_, TCOOFF); }
  void go_on() const { tcflow(slave_, TCOON); }
  /// The device is unplugged.
  void unplug() {
    stop_.store(true);
    if (thread_.joinable()) {
      thread_.join();
    }
    thread_ = std::thread([] {});
    hang_up();
  }

  static std::int64_t now_ns() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }

 private:
  void listen() {
    std::array<std::uint8_t, 64> bytes{};
    pollfd wait{master_, POLLIN, 0};
    while (!stop_.load()) {
      if (poll(&wait, 1, 20) <= 0) {
        continue;
      }
      const ssize_t count = read(master_, bytes.data(), bytes.size());
      const std::int64_t now = now_ns();
      const std::lock_guard lock(mutex_);
      for (ssize_t i = 0; i < count; ++i) {
        heard_.push_back({bytes[static_cast<std::size_t>(i)], now});
      }
    }
  }
  void hang_up() {
    for (int* file : {&slave_, &master_}) {
      if (*file >= 0) {
        close(*file);
        *file = -1;
      }
    }
  }

  int master_{-1};
  int slave_{-1};
  std::string name_;
  std::atomic<bool> stop_{false};
  mutable std::mutex mutex_;
  std::vector<Heard> heard_;
  std::thread thread_;
};

}  // namespace haptrial::test
