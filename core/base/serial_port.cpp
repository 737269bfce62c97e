#include "core/base/serial_port.h"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

namespace haptrial {
namespace {

constexpr std::array<std::pair<int, speed_t>, 8> kSerialRates{{{9600, B9600},
                                                               {19200, B19200},
                                                               {38400, B38400},
                                                               {57600, B57600},
                                                               {115200, B115200},
                                                               {230400, B230400},
                                                               {460800, B460800},
                                                               {921600, B921600}}};

const std::pair<int, speed_t>* serial_rate(int baud) noexcept {
  const auto* found = std::find_if(kSerialRates.begin(), kSerialRates.end(),
                                   [baud](const auto& rate) { return rate.first == baud; });
  return found == kSerialRates.end() ? nullptr : found;
}

bool make_raw(int file, speed_t rate) noexcept {
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

}  // namespace

bool has_serial_rate(int baud) noexcept { return serial_rate(baud) != nullptr; }

int open_serial_port(const std::string& device, int baud) noexcept {
  const auto* rate = serial_rate(baud);
  if (rate == nullptr) {
    errno = EINVAL;
    return -1;
  }
  const int file = open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (file >= 0 && !make_raw(file, rate->second)) {
    const int error = errno;
    close(file);
    errno = error;
    return -1;
  }
  return file;
}

}  // namespace haptrial
