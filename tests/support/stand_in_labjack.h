#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "tests/support/free_port.h"
#include "tests/support/local_socket.h"

namespace haptrial::test {

/// A LabJack T7 that answers readings of its analogue inputs over Modbus TCP, and makes the
/// mistakes that the test asks for. One connection at a time.
class StandInLabJack {
 public:
  /// The way in which it spoils its next answer.
  enum class Mistake : std::uint8_t {
    kNone,
    kTwice,    // the answer comes twice
    kRubbish,  // bytes that are no answer
    kShort,    // an answer of another length than it says
    kHangUp,   // it closes the connection
    kSilence,  // no answer, as long as this is set
  };

  StandInLabJack() : file_(open_local_socket(SOCK_STREAM, port_)), thread_([this] { serve(); }) {}
  ~StandInLabJack() {
    over_.store(true);
    thread_.join();
  }
  StandInLabJack(const StandInLabJack&) = delete;
  StandInLabJack& operator=(const StandInLabJack&) = delete;

  std::uint16_t port() const { return port_; }
  void set_voltage(int input, float voltage) {
    const std::lock_guard lock(mutex_);
    voltages_[input] = voltage;
  }
  /// From now on readings of an input at or above this one are refused with the exception 2.
  void set_inputs(int count) { inputs_.store(count); }
  void set_mistake(Mistake mistake) { mistake_.store(mistake); }
  /// Called before and after each reading of the inputs, in the stand-in's thread, while request
  /// and answer are on their way.
  void set_clock(std::function<void()> before, std::function<void()> after) {
    const std::lock_guard lock(mutex_);
    before_ = std::move(before);
    after_ = std::move(after);
  }
  int requests() const { return requests_.load(); }
  /// Closes its port, or listens there again.
  void set_listening(bool listening) { listening_.store(listening); }

 private:
  void serve() {
    while (!over_.load()) {
      if (!listening_.load()) {
        close_port();
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        continue;
      }
      if (file_ < 0) {
        file_ = open_local_socket(SOCK_STREAM, port_);
      }
      if (is_readable(file_, 20)) {
        const int client = ::accept(file_, nullptr, nullptr);
        talk(client);
        ::close(client);
      }
    }
    close_port();
  }

  void close_port() {
    if (file_ >= 0) {
      ::close(file_);
      file_ = -1;
    }
  }

  void talk(int client) {
    std::string heard;
    while (!over_.load() && listening_.load()) {
      if (!is_readable(client, 20)) {
        continue;
      }
      std::array<char, 64> bytes{};
      const ssize_t count = ::recv(client, bytes.data(), bytes.size(), 0);
      if (count <= 0) {
        return;
      }
      heard.append(bytes.data(), static_cast<std::size_t>(count));
      for (; heard.size() >= 12; heard.erase(0, 12)) {
        ++requests_;
        if (!answer(client, heard.substr(0, 12))) {
          return;
        }
      }
    }
  }

  static int word(const std::string& bytes, std::size_t at) {
    return static_cast<unsigned char>(bytes[at]) << 8 | static_cast<unsigned char>(bytes[at + 1]);
  }

  /// @returns whether the connection stays
  bool answer(int client, const std::string& request) {
    const Mistake mistake = mistake_.load();
    if (mistake == Mistake::kSilence) {
      return true;
    }
    mistake_.store(Mistake::kNone);
    if (mistake == Mistake::kHangUp) {
      return false;
    }
    std::string bytes = answer_to(request);
    if (mistake == Mistake::kRubbish) {
      bytes = "this is no Modbus at all";
    } else if (mistake == Mistake::kTwice) {
      bytes += bytes;
    } else if (mistake == Mistake::kShort) {
      bytes[8] = static_cast<char>(bytes[8] - 4);
    }
    ::send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    return true;
  }

  std::string answer_to(const std::string& request) {
    const int first = word(request, 8) / 2;
    const int count = word(request, 10) / 2;
    std::string bytes = request.substr(0, 4);  // transaction and protocol
    if (word(request, 2) != 0 || word(request, 4) != 6 || request[7] != 3 ||
        first + count > inputs_.load()) {
      return bytes + std::string("\0\3\1\x83\2", 5);
    }
    const auto [before, after] = [this] {
      const std::lock_guard lock(mutex_);
      return std::pair(before_, after_);
    }();
    if (before) {
      before();
    }
    const std::string values = values_of(first, count);
    if (after) {
      after();
    }
    bytes += '\0';
    bytes += static_cast<char>(3 + values.size());
    bytes += std::string("\1\3", 2);
    bytes += static_cast<char>(values.size());
    return bytes + values;
  }

  std::string values_of(int first, int count) {
    const std::lock_guard lock(mutex_);
    std::string values;
    for (int i = first; i < first + count; ++i) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, &voltages_[i], sizeof(bits));
      bits = htonl(bits);
      values.append(reinterpret_cast<const char*>(&bits), sizeof(bits));
    }
    return values;
  }

  std::uint16_t port_{free_port()};
  int file_;  // -1: its port is closed
  std::atomic<bool> over_{false};
  std::atomic<bool> listening_{true};
  std::atomic<int> inputs_{14};
  std::atomic<int> requests_{0};
  std::atomic<Mistake> mistake_{Mistake::kNone};
  std::mutex mutex_;
  std::map<int, float> voltages_;
  std::function<void()> before_;
  std::function<void()> after_;
  std::thread thread_;
};

}  // namespace haptrial::test
