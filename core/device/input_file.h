#pragma once

#include <linux/input.h>

#include <array>
#include <bitset>
#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace haptrial::device {

/// State of an input device's absolute axes and buttons, from its records (struct input_event, as
/// the kernel or a pipe delivers them). Values count once their report has ended. If the kernel had
/// to drop records, the rest of that report is ignored, too.
class InputReports {
 public:
  /// Records in any pieces, in their order.
  void take(std::span<const std::byte> bytes) noexcept;
  /// The value in the last whole report that had one; nothing before the first. @param axis  below
  /// ABS_CNT
  std::optional<int> axis(int axis) const noexcept {
    return whole_.axes[static_cast<std::size_t>(axis)];
  }
  /// @param button  below KEY_CNT
  bool held(int button) const noexcept { return whole_.buttons[static_cast<std::size_t>(button)]; }
  /// The device's own word.
  void set_axis(int axis, int value) noexcept;
  void set_button(int button, bool held) noexcept;
  /// Whether records were dropped since the last call: the device has to be asked for its values.
  bool take_dropped() noexcept;

 private:
  struct State {
    std::array<std::optional<int>, ABS_CNT> axes{};
    std::bitset<KEY_CNT> buttons;
  };
  void take_record(const input_event& record) noexcept;

  std::array<std::byte, sizeof(input_event)> piece_{};
  std::size_t filled_{0};  // of the piece
  State whole_;
  State reported_;    // with the report that has not ended
  bool void_{false};  // up to the end of the report
  bool dropped_{false};
};

/// A Linux input device (/dev/input/eventN), or a named pipe into which another program writes the
/// same records. One thread.
class InputFile {
 public:
  /// Range of an axis, as the device states it.
  struct Range {
    int lowest{0};
    int highest{0};
  };

  /// @param table  of the definition that names the file, as "pedal": sentences begin with it
  /// @throws InputError in a sentence if the file is missing, may not be read, or is neither an
  /// input device nor a pipe
  InputFile(std::string path, std::string table);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// Range of an axis, whose value is known from now on: of a device at once, of a pipe from its
  /// first report on. @returns nothing of a pipe
  /// @throws InputError if a device has no such axis; the sentence lists those that it has
  std::optional<Range> follow_axis(int axis);
  /// Range of an axis; nothing if a device has no such axis.
  std::optional<Range> find_axis(int axis);
  /// The same of buttons. A device need not have them.
  void follow_buttons();
  bool is_pipe() const noexcept { return pipe_; }

  /// Waits for records, at most so long, and takes them in.
  /// @returns false when the device is gone; error() says why
  bool wait(std::chrono::milliseconds most) noexcept;
  const InputReports& reports() const noexcept { return reports_; }
  const char* error() const noexcept;

 private:
  [[noreturn]] void refuse(const std::string& why) const;
  std::optional<Range> ask_axis(int axis) noexcept;
  void ask_buttons() noexcept;

  std::string path_;
  std::string table_;
  InputReports reports_;
  std::vector<int> axes_;  // that are followed
  bool buttons_{false};    // likewise
  bool pipe_{false};
  int file_{-1};
  int error_{0};  // errno; 0: the other end of the pipe was closed
};

}  // namespace haptrial::device
