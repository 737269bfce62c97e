#include "core/device/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstring>
#include <utility>

#include "core/base/error.h"
#include "core/device/axis_names.h"

namespace haptrial::device {

void InputReports::take(std::span<const std::byte> bytes) noexcept {
  for (const std::byte byte : bytes) {
    piece_[filled_++] = byte;
    if (filled_ == piece_.size()) {
      input_event record;
      std::memcpy(&record, piece_.data(), sizeof(record));
      take_record(record);
      filled_ = 0;
    }
  }
}

void InputReports::set_axis(int axis, int value) noexcept {
  const auto at = static_cast<std::size_t>(axis);
  whole_.axes[at] = reported_.axes[at] = value;
}

void InputReports::set_button(int button, bool held) noexcept {
  const auto at = static_cast<std::size_t>(button);
  whole_.buttons[at] = reported_.buttons[at] = held;
}

bool InputReports::take_dropped() noexcept { return std::exchange(dropped_, false); }

void InputReports::take_record(const input_event& record) noexcept {
  if (record.type == EV_SYN && record.code == SYN_DROPPED) {
    void_ = true;
    reported_ = whole_;
  } else if (record.type == EV_SYN && record.code == SYN_REPORT) {
    dropped_ = dropped_ || void_;
    whole_ = reported_;
    void_ = false;
  } else if (record.type == EV_ABS && record.code < ABS_CNT && !void_) {
    reported_.axes[record.code] = record.value;
  } else if (record.type == EV_KEY && record.code < KEY_CNT && !void_) {
    reported_.buttons[record.code] = record.value != 0;
  }
}

namespace {

constexpr std::size_t kWordBits = sizeof(unsigned long) * CHAR_BIT;

template <std::size_t N>
bool has_bit(const std::array<unsigned long, N>& bits, int number) {
  const auto bit = static_cast<std::size_t>(number);
  return ((bits[bit / kWordBits] >> (bit % kWordBits)) & 1u) != 0;
}

bool is_pipe_file(int file) {
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
    input_absinfo info{};
    if (has_bit(bits, axis) && ioctl(file, EVIOCGABS(axis), &info) >= 0) {
      list += fmt::format("{}{} ({} to {}, now {})", list.empty() ? "" : ", ", axis_name(axis),
                          info.minimum, info.maximum, info.value);
    }
  }
  return list;
}

}  // namespace

InputFile::InputFile(std::string path, std::string table)
    : path_(std::move(path)), table_(std::move(table)) {
  file_ = open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (file_ < 0) {
    refuse(std::strerror(errno));
  }
  pipe_ = is_pipe_file(file_);
  if (!pipe_ && !is_input_device(file_)) {
    close(file_);
    refuse("is neither an input device nor a named pipe");
  }
}

InputFile::~InputFile() { close(file_); }

void InputFile::refuse(const std::string& why) const {
  throw InputError(fmt::format(
      "{0} {1}: {2}; connect it, check {0}.input (/dev/input/by-id names what is connected) and "
      "that you may read it (on Debian: group input), or remove [{0}]",
      table_, path_, why));
}

std::optional<InputFile::Range> InputFile::find_axis(int axis) {
  const std::optional<Range> range = pipe_ ? std::nullopt : ask_axis(axis);
  if (range) {
    axes_.push_back(axis);
  }
  return range;
}

std::optional<InputFile::Range> InputFile::follow_axis(int axis) {
  const std::optional<Range> range = find_axis(axis);
  if (!range && !pipe_) {
    const std::string axes = axes_of(file_);
    refuse(fmt::format(
        "has no axis {}; it has {}", axis_name(axis),
        axes.empty() ? "no absolute axis (a pedal that acts as a keyboard is a key)" : axes));
  }
  return range;
}

/// The device's range and value. An axis that a device does not have is told as 0 to 0.
std::optional<InputFile::Range> InputFile::ask_axis(int axis) noexcept {
  input_absinfo info{};
  if (ioctl(file_, EVIOCGABS(axis), &info) < 0 || info.minimum == info.maximum) {
    return std::nullopt;
  }
  reports_.set_axis(axis, info.value);
  return Range{info.minimum, info.maximum};
}

void InputFile::follow_buttons() {
  buttons_ = !pipe_;
  ask_buttons();
}

void InputFile::ask_buttons() noexcept {
  std::array<unsigned long, KEY_CNT / kWordBits + 1> bits{};
  if (buttons_ && ioctl(file_, EVIOCGKEY(sizeof(bits)), bits.data()) >= 0) {
    for (int button = 0; button < KEY_CNT; ++button) {
      reports_.set_button(button, has_bit(bits, button));
    }
  }
}

bool InputFile::wait(std::chrono::milliseconds most) noexcept {
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
  reports_.take(std::span(bytes).first(static_cast<std::size_t>(count)));
  if (reports_.take_dropped()) {
    for (const int axis : axes_) {
      ask_axis(axis);
    }
    ask_buttons();
  }
  return true;
}

const char* InputFile::error() const noexcept {
  return error_ != 0 ? std::strerror(error_) : "the writer of the pipe has closed it";
}

}  // namespace haptrial::device
