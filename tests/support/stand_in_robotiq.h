#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/pseudo_terminal.h"

namespace haptrial::test {

/// Checksum of Modbus RTU by its other form: bits from the highest down, reflected at both ends.
inline std::string modbus_checksum(const std::string& bytes) {
  const auto reflected = [](unsigned value, int bits) {
    unsigned result = 0;
    for (int i = 0; i < bits; ++i) {
      result |= (value >> i & 1u) << (bits - 1 - i);
    }
    return result;
  };
  unsigned rest = 0xFFFF;
  for (const char byte : bytes) {
    rest ^= reflected(static_cast<unsigned char>(byte), 8) << 8;
    for (int bit = 0; bit < 8; ++bit) {
      rest = ((rest & 0x8000u) != 0 ? rest << 1 ^ 0x8005u : rest << 1) & 0xFFFFu;
    }
  }
  const unsigned sum = reflected(rest, 16);
  return {static_cast<char>(sum & 0xFF), static_cast<char>(sum >> 8)};
}

/// A frame of six counts: hundredths of a newton, thousandths of a newton metre.
inline std::string robotiq_frame(const std::array<std::int16_t, 6>& counts) {
  std::string bytes("\x20\x4E");
  for (const std::int16_t count : counts) {
    const auto word = static_cast<std::uint16_t>(count);
    bytes += static_cast<char>(word & 0xFF);
    bytes += static_cast<char>(word >> 8);
  }
  return bytes + modbus_checksum(bytes);
}

/// A force-torque sensor FT 300 on a serial line: it answers the request that starts its stream,
/// and sends what the test says.
class StandInRobotiq {
 public:
  StandInRobotiq() : thread_([this] { answer(); }) {}
  ~StandInRobotiq() {
    over_.store(true);
    thread_.join();
  }
  StandInRobotiq(const StandInRobotiq&) = delete;
  StandInRobotiq& operator=(const StandInRobotiq&) = delete;

  PseudoTerminal& line() { return line_; }
  /// Whether it answers.
  void set_answering(bool answering) { answering_.store(answering); }
  /// How often its stream was asked for.
  int starts() const { return starts_.load(); }
  /// How many bytes 0xFF it has heard, of which fifty stop it.
  std::size_t jammed() const {
    const auto bytes = line_.bytes();
    return static_cast<std::size_t>(std::count(bytes.begin(), bytes.end(), 0xFF));
  }

 private:
  void answer() {
    // As the manual of the sensor has it: register 410 takes 0x0200.
    const std::vector<int> request{9, 16, 1, 154, 0, 1, 2, 2, 0};
    std::size_t known = 0;
    while (!over_.load()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      const auto bytes = line_.bytes();
      const auto found = std::search(bytes.begin() + static_cast<std::ptrdiff_t>(known),
                                     bytes.end(), request.begin(), request.end());
      const auto end = static_cast<std::size_t>(found - bytes.begin()) + request.size() + 2;
      if (found == bytes.end() || bytes.size() < end) {
        continue;
      }
      known = end;
      const std::string heard(found, found + static_cast<std::ptrdiff_t>(request.size()));
      const std::string sum{static_cast<char>(bytes[end - 2]), static_cast<char>(bytes[end - 1])};
      if (answering_.load() && sum == modbus_checksum(heard)) {
        const std::string head = heard.substr(0, 6);
        line_.send(head + modbus_checksum(head));
        ++starts_;
      }
    }
  }

  PseudoTerminal line_;
  std::atomic<bool> over_{false};
  std::atomic<bool> answering_{true};
  std::atomic<int> starts_{0};
  std::thread thread_;
};

}  // namespace haptrial::test
