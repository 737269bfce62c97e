#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace haptrial::markers {

/// A serial line that takes trigger codes, a byte each: a trigger box or a USB adapter whose data
/// lines are an amplifier's TTL inputs. Raw: 8 bits, no parity, one stop bit, no flow control. One
/// thread.
class SerialLine {
 public:
  /// @param device  such as /dev/ttyUSB0
  /// @param baud    one of 9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600
  /// @throws InputError in a sentence if it cannot be opened or is no serial line;
  /// std::invalid_argument for another rate
  SerialLine(std::string device, int baud);
  ~SerialLine();
  SerialLine(const SerialLine&) = delete;
  SerialLine& operator=(const SerialLine&) = delete;

  static bool has_rate(int baud) noexcept;

  /// Does not wait: a line that takes nothing has failed. A line that has failed is opened anew
  /// before the next byte, at most twice a second. @returns whether the system took the byte
  bool write(std::uint8_t byte) noexcept;
  /// How often the line was opened anew.
  int reopened() const noexcept { return reopened_; }
  /// errno of the last write() that failed; 0 if all went well.
  int error() const noexcept { return error_; }
  const std::string& device() const { return device_; }

 private:
  void reopen() noexcept;

  std::string device_;
  int baud_;
  int file_{-1};  // -1: it has failed
  int error_{0};
  int reopened_{0};
  std::chrono::steady_clock::time_point tried_{};
};

}  // namespace haptrial::markers
