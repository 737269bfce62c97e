#include "core/stream/serial_line.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"

namespace haptrial::markers {
namespace {

constexpr std::array<std::pair<int, speed_t>, 8> kRates{{{9600, B9600},
                                                         {19200, B19200},
                                                         {38400, B38400},
                                                         {57600, B57600},
                                                         {115200, B115200},
                                                         {230400, B230400},
                                                         {460800, B460800},
                                                         {921600, B921600}}};

const std::pair<int, speed_t>* rate_of(int baud) noexcept {
  const auto* found = std::find_if(kRates.begin(), kRates.end(),
                                   [baud](const auto& rate) { return rate.first == baud; });
  return found == kRates.end() ? nullptr : found;
}

[[noreturn]] void refuse(const std::string& device, const char* why) {
  throw InputError(
      fmt::format("serial line {}: {}; connect it and check that you may write to it (on Debian: "
                  "group dialout), or remove markers.serial",
                  device, why));
}

bool make_raw(int file, speed_t rate) {
  termios settings{};
  if (tcgetattr(file, &settings) != 0) {
    return false;
  }
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  cfsetispeed(&settings, rate);
  cfsetospeed(&settings, rate);
  return tcsetattr(file, TCSANOW, &settings) == 0;
}

int open_line(const std::string& device) noexcept {
  return open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
}

}  // namespace

bool SerialLine::has_rate(int baud) noexcept { return rate_of(baud) != nullptr; }

SerialLine::SerialLine(std::string device, int baud) : device_(std::move(device)), baud_(baud) {
  const auto* rate = rate_of(baud);
  if (rate == nullptr) {
    throw std::invalid_argument("SerialLine: baud is none of the common rates");
  }
  file_ = open_line(device_);
  if (file_ < 0) {
    refuse(device_, std::strerror(errno));
  }
  if (!make_raw(file_, rate->second)) {
    const int error = errno;
    close(file_);
    refuse(device_, error == ENOTTY ? "is no serial line" : std::strerror(error));
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
  const int file = open_line(device_);
  if (file < 0 || !make_raw(file, rate_of(baud_)->second)) {
    if (file >= 0) {
      close(file);
    }
    return;
  }
  file_ = file;
  ++reopened_;
}

}  // namespace haptrial::markers
