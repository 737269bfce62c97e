#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "tests/support/free_port.h"
#include "tests/support/local_socket.h"

namespace haptrial::test {

/// A pose as a tracker sends it.
struct VrpnPose {
  double time{0.0};  // by the server's clock, to a microsecond [s]
  std::array<double, 7> values{0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0};
  int sensor{0};
};

/// A VRPN server with a tracker "Arm" and a tracker "Other", which says what the test says. Each
/// client that is welcomed gets the cookie, the descriptions and one pose of each tracker.
class StandInVrpn {
 public:
  static constexpr int kArm = 3, kOther = 1;         // numbers of the trackers
  static constexpr int kPoses = 5, kVelocities = 6;  // numbers of the types

  /// @param cookie  what it sends first; empty: it says nothing at all
  explicit StandInVrpn(std::string cookie = std::string("vrpn: ver. 07.35  0\0\0\0\0\0", 24))
      : cookie_(std::move(cookie)),
        file_(open_local_socket(SOCK_STREAM, port_)),
        thread_([this] { serve(); }) {}
  ~StandInVrpn() {
    over_.store(true);
    thread_.join();
  }
  StandInVrpn(const StandInVrpn&) = delete;
  StandInVrpn& operator=(const StandInVrpn&) = delete;

  std::uint16_t port() const { return port_; }
  /// Sensor of the pose with which clients are welcomed.
  void set_sensor(int sensor) { sensor_.store(sensor); }
  /// Closes its port and its connection, or listens again.
  void set_listening(bool listening) { listening_.store(listening); }
  /// The first bytes of the client.
  std::string heard() const {
    const std::lock_guard lock(mutex_);
    return heard_;
  }

  void send(const VrpnPose& pose, int tracker = kArm, int type = kPoses) {
    send_bytes(message(pose.time, tracker, type, body_of(pose)));
  }
  void send_bytes(const std::string& bytes) {
    const std::lock_guard lock(mutex_);
    if (client_ >= 0) {
      ::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    }
  }

  static std::string body_of(const VrpnPose& pose) {
    std::string body = word(pose.sensor) + word(0);
    for (const double value : pose.values) {
      const auto bits = std::bit_cast<std::uint64_t>(value);
      body += word(static_cast<std::uint32_t>(bits >> 32)) + word(static_cast<std::uint32_t>(bits));
    }
    return body;
  }
  static std::string message(double time, int sender, int type, const std::string& body) {
    const auto micros = static_cast<std::int64_t>(time * 1e6 + 0.5);
    std::string bytes = word(24 + static_cast<std::uint32_t>(body.size())) +
                        word(static_cast<std::uint32_t>(micros / 1'000'000)) +
                        word(static_cast<std::uint32_t>(micros % 1'000'000)) + word(sender) +
                        word(type) + word(0) + body;
    bytes.resize((bytes.size() + 7) / 8 * 8);
    return bytes;
  }
  /// @param type  -1: the name is that of a sender; -2: of a type
  static std::string description(int type, int number, const std::string& name) {
    return message(0.0, number, type,
                   word(static_cast<std::uint32_t>(name.size() + 1)) + name + '\0');
  }
  static std::string word(std::uint32_t number) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) {
      bytes += static_cast<char>(number >> shift & 0xFFu);
    }
    return bytes;
  }

 private:
  void serve() {
    while (!over_.load()) {
      if (listening_.load() && file_ < 0) {
        file_ = open_local_socket(SOCK_STREAM, port_);
      }
      if (!listening_.load()) {
        file_ = close_file(file_);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      } else if (is_readable(file_, 20)) {
        talk(::accept(file_, nullptr, nullptr));
      }
    }
    close_file(file_);
  }

  static int close_file(int file) {
    if (file >= 0) {
      ::close(file);
    }
    return -1;
  }

  void talk(int client) {
    {
      const std::lock_guard lock(mutex_);
      client_ = client;
    }
    send_bytes(cookie_);
    if (!cookie_.empty()) {
      welcome();
    }
    while (!over_.load() && listening_.load()) {
      if (!is_readable(client, 20)) {
        continue;
      }
      std::array<char, 64> bytes{};
      const ssize_t count = ::recv(client, bytes.data(), bytes.size(), 0);
      if (count <= 0) {
        break;
      }
      const std::lock_guard lock(mutex_);
      heard_.append(bytes.data(), static_cast<std::size_t>(count));
    }
    const std::lock_guard lock(mutex_);
    client_ = close_file(client);
  }

  void welcome() {
    send_bytes(message(0.0, 4242, -3, std::string("127.0.0.1\0", 10)));  // its port of UDP
    send_bytes(description(-1, 0, "VRPN Control") + description(-1, kOther, "Other") +
               description(-1, kArm, "Arm") + description(-2, kPoses, "vrpn_Tracker Pos_Quat") +
               description(-2, kVelocities, "vrpn_Tracker Velocity"));
    send(VrpnPose{.sensor = sensor_.load()});
    send(VrpnPose{}, kOther);
  }

  std::uint16_t port_{free_port()};
  std::atomic<bool> over_{false};
  std::atomic<bool> listening_{true};
  std::atomic<int> sensor_{0};
  std::string cookie_;
  int file_;  // -1: its port is closed
  mutable std::mutex mutex_;
  int client_{-1};
  std::string heard_;
  std::thread thread_;
};

}  // namespace haptrial::test
