#include "core/stream/serial_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/serial_port.h"

namespace haptrial::markers {
namespace {

[[noreturn]] void refuse(const std::string& device, const char* why) {
  throw InputError(
      fmt::format("serial line {}: {}; connect it and check that you may write to it (on Debian: "
                  "group dialout), or remove markers.serial",
                  device, why));
}

}  // namespace

bool SerialLine::has_rate(int baud) noexcept { return has_serial_rate(baud); }

SerialLine::SerialLine(std::string device, int baud) : device_(std::move(device)), baud_(baud) {
  if (!has_rate(baud)) {
    throw std::invalid_argument("SerialLine: baud is none of the common rates");
  }
  file_ = open_serial_port(device_, baud);
  if (file_ < 0) {
    refuse(device_, errno == ENOTTY ? "is no serial line" : std::strerror(errno));
  }
}

SerialLine::~SerialLine() {
  if (file_ >= 0) {
    close(file_);
  }
}

bool SerialLine::write(std::uint8_t byte) noexcept {
  if (file_ < 0) {
    reopen();
  }
  if (file_ < 0) {
    return false;
  }
  ssize_t count = -1;
  do {
    count = ::write(file_, &byte, 1);
  } while (count < 0 && errno == EINTR);
  if (count == 1) {
    return true;
  }
  error_ = count < 0 ? errno : EIO;
  if (error_ != EAGAIN) {  // a full line is still there
    close(file_);
    file_ = -1;
    tried_ = std::chrono::steady_clock::now();
  }
  return false;
}

/// A device that was plugged in again has its name back after a while.
void SerialLine::reopen() noexcept {
  constexpr std::chrono::milliseconds kBetween{500};
  const auto now = std::chrono::steady_clock::now();
  if (now - tried_ < kBetween) {
    return;
  }
  tried_ = now;
  file_ = open_serial_port(device_, baud_);
  reopened_ += file_ >= 0 ? 1 : 0;
}

}  // namespace haptrial::markers
