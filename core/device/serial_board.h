#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/device/device.h"
#include "core/realtime/latest_value.h"

namespace haptrial::device {

/// One reading of a board on a serial line.
struct BoardReading {
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};  // in W [m]
  std::uint32_t buttons{0};                           // bit i: button i is pressed
  const char* trouble{""};  // why the position does not count; a text of static duration
};

/// Messages of one kind of board. All functions belong to the thread of its SerialBoard.
class BoardProtocol {
 public:
  virtual ~BoardProtocol() = default;
  /// Whether the board speaks once for each force, and only then; else it speaks by its own clock.
  virtual bool answers() const = 0;
  /// Bytes for a board that was reset; sent until it gives a reading. May be empty.
  virtual std::string start_message() const = 0;
  /// Bytes that command a force. @param force  on the handle, in W [N]; finite
  virtual std::string force_message(const Eigen::Vector3d& force) = 0;
  /// Takes bytes as they come; malformed parts are passed over.
  /// @returns the newest whole reading that ended in them
  virtual std::optional<BoardReading> take(std::string_view bytes) = 0;
  /// Forgets the part of a reading that has come: the board is asked anew.
  virtual void forget() {}
  /// The beginning of the last message that was no reading, for a person; empty: there was none.
  virtual std::string misunderstood() const { return ""; }
};

/// Set-up of a board on a serial line, whatever it speaks.
struct SerialBoardSetup {
  std::string port;               // "/dev/ttyACM0"; empty: there is no board
  int baud{115200};               // a board with USB of its own ignores it
  double max_force{3.0};          // > 0 [N]
  double workspace_radius{0.05};  // > 0 [m]
  double patience{0.02};          // how long one side goes on without word from the other > 0 [s]
  double start_time{5.0};         // until a board that restarts gives its first reading > 0 [s]
  double velocity_window{0.01};   // of readings from which velocity follows > 0 [s]
  // No keys of the table: the kind of board sets them.
  std::string table;                                    // of the definition, for sentences: "hapi"
  Eigen::Vector3d force_axes{Eigen::Vector3d::Ones()};  // as in DeviceInfo
  int stop_button{-1};                                  // emergency stop; -1: none
};

/// Serial lines that are connected, by names that stay: /dev/serial/by-id/…
std::vector<std::string> find_serial_lines();

/// A sentence on the axes along which a device gives no force; empty if there are none.
/// @param name  of the device; @param axes  as in DeviceInfo
std::string missing_axes_sentence(const std::string& name, const Eigen::Vector3d& axes);

/// The keys that the tables of all boards have.
const Schema<SerialBoardSetup>& serial_board_schema();

/// A device that is a board on a serial line.
///
/// A thread of its own writes and reads the line. It and the servo loop exchange their newest
/// values; a command wakes it, so that a board that answers is asked at once. Silence on either
/// side for `patience` is a fault: read() fails when no fresh reading came, and the thread lets the
/// force go when no fresh command came. A line that is lost is a fault at the next read(), and
/// stays lost. Many boards restart when their line is opened; the constructor waits for the first
/// reading.
class SerialBoard final : public Device {
 public:
  /// @param rate  of the servo loop > 0 [Hz]
  /// @throws InputError if the line cannot be opened, RunError if the board gives no reading within
  ///         `start_time`, std::invalid_argument for a number that is out of its bounds
  SerialBoard(SerialBoardSetup setup, std::unique_ptr<BoardProtocol> protocol, double rate);
  /// Commands zero force and closes the line.
  ~SerialBoard() override;
  SerialBoard(const SerialBoard&) = delete;
  SerialBoard& operator=(const SerialBoard&) = delete;

  const DeviceInfo& info() const noexcept override { return info_; }
  bool read(DeviceReading& reading) noexcept override;
  bool write(const Wrench& wrench) noexcept override;
  const char* trouble() const noexcept override { return trouble_; }
  /// Ticks to which no fresh reading came.
  std::uint64_t slow_calls() const noexcept override {
    return stale_.load(std::memory_order_relaxed);
  }
  /// Readings that came from the board. Any thread.
  std::uint64_t readings() const noexcept { return readings_.load(std::memory_order_acquire); }

 private:
  using Clock = std::chrono::steady_clock;
  struct Place {
    double tick{0.0};
    Eigen::Vector3d position{Eigen::Vector3d::Zero()};
  };

  void open();
  void await_first_reading();
  void close() noexcept;
  // Board's thread.
  void run();
  void exchange();
  void take_command();
  void wait(std::chrono::milliseconds most);
  void hear();
  void ask();
  void command(const Eigen::Vector3d& force);
  bool send(std::string_view bytes);
  void flush();
  void lose();
  // Servo thread.
  Eigen::Vector3d velocity() const noexcept;

  SerialBoardSetup setup_;
  std::unique_ptr<BoardProtocol> protocol_;
  DeviceInfo info_;
  double rate_;
  int patience_ticks_;
  double window_ticks_;
  int line_{-1};
  int wake_{-1};  // an eventfd that write() counts up

  realtime::LatestValue<BoardReading> sensed_;      // board's thread -> servo
  realtime::LatestValue<Eigen::Vector3d> command_;  // servo -> board's thread
  std::atomic<bool> over_{false};
  std::atomic<std::uint64_t> stale_{0};
  std::atomic<std::uint64_t> readings_{0};
  // Servo thread.
  BoardReading latest_;
  const char* trouble_{""};
  int ticks_without_news_{0};
  double tick_{0.0};
  std::array<Place, 32> places_{};  // ring of fresh readings
  std::size_t placed_{0};
  // Board's thread.
  bool lost_{false};
  bool wanted_{false};  // a command came that was not sent
  bool asked_{false};   // and no answer came
  Clock::time_point asked_at_{};
  Clock::time_point commanded_at_{};
  Eigen::Vector3d force_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d sent_{Eigen::Vector3d::Zero()};
  std::string unsent_;
  std::thread thread_;
};

}  // namespace haptrial::device
