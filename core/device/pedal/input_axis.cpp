#include "core/device/pedal/input_axis.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstring>

#include "core/base/error.h"
#include "core/device/pedal/axis_names.h"

namespace haptrial::device {
namespace {

constexpr std::size_t kWordBits = sizeof(unsigned long) * CHAR_BIT;

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw InputError(fmt::format(
      "pedal {}: {}; connect it, check pedal.input (/dev/input/by-id names what is connected) and "
      "that you may read it (on Debian: group input), or remove [pedal]",
      path, why));
}

bool is_pipe(int file) {
  struct stat status {};
  return fstat(file, &status) == 0 && S_ISFIFO(status.st_mode);
}

bool is_input_device(int file) {
  int version = 0;
  return ioctl(file, EVIOCGVERSION, &version) >= 0;
}

/// "ABS_GAS (0 to 255, now 3)" for each.
std::string axes_of(int file) {
  std::array<unsigned long, ABS_CNT / kWordBits + 1> bits{};
  if (ioctl(file, EVIOCGBIT(EV_ABS, sizeof(bits)), bits.data()) < 0) {
    return "";
  }
  std::string list;
  for (int axis = 0; axis < ABS_CNT; ++axis) {
    const auto bit = static_cast<std::size_t>(axis);
    input_absinfo info{};
    if (((bits[bit / kWordBits] >> (bit % kWordBits)) & 1u) != 0 &&
        ioctl(file, EVIOCGABS(axis), &info) >= 0) {
      list += fmt::format("{}{} ({} to {}, now {})", list.empty() ? "" : ", ", axis_name(axis),
                          info.minimum, info.maximum, info.value);
    }
  }
  return list;
}

}  // namespace

InputAxis::InputAxis(const std::string& path, int axis) : axis_(axis), records_(axis) {
  file_ = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (file_ < 0) {
    refuse(path, std::strerror(errno));
  }
  if (is_pipe(file_)) {
    return;
  }
  std::string why;
  if (!is_input_device(file_)) {
    why = "is neither an input device nor a named pipe";
  } else if (!ask()) {
    const std::string axes = axes_of(file_);
    why = fmt::format(
        "has no axis {}; it has {}", axis_name(axis),
        axes.empty() ? "no absolute axis (a pedal that acts as a keyboard is a key)" : axes);
  }
  if (!why.empty()) {
    close(file_);
    refuse(path, why);
  }
}

InputAxis::~InputAxis() { close(file_); }

/// The device's range and value. An axis that a device does not have is told as 0 to 0.
bool InputAxis::ask() noexcept {
  input_absinfo info{};
  if (ioctl(file_, EVIOCGABS(axis_), &info) < 0 || info.minimum == info.maximum) {
    return false;
  }
  range_ = {info.minimum, info.maximum};
  records_.set(info.value);
  return true;
}

bool InputAxis::wait(std::chrono::milliseconds most) noexcept {
  constexpr std::size_t kRecords = 64;
  pollfd ready{file_, POLLIN, 0};
  if (poll(&ready, 1, static_cast<int>(most.count())) <= 0) {
    return true;
  }
  std::array<std::byte, kRecords * sizeof(input_event)> bytes;
  const ssize_t count = read(file_, bytes.data(), bytes.size());
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) {
    return true;
  }
  if (count <= 0) {
    error_ = count < 0 ? errno : 0;
    return false;
  }
  records_.take(std::span(bytes).first(static_cast<std::size_t>(count)));
  if (records_.take_dropped()) {
    ask();
  }
  return true;
}

const char* InputAxis::error() const noexcept {
  return error_ != 0 ? std::strerror(error_) : "the writer of the pipe has closed it";
}

}  // namespace haptrial::device
