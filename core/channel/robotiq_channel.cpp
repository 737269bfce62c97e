#include "core/channel/channel_kinds.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/channel/connection.h"

namespace haptrial::channel {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr int kRobotiqBaud = 19200;
constexpr double kRobotiqRate = 100.0;         // frames a second [Hz]
constexpr std::size_t kRobotiqFrame = 16;      // bytes
constexpr std::size_t kRobotiqRoom = 1024;     // bytes; ten times what comes in 50 ms
constexpr milliseconds kRobotiqSilence{2000};  // after which the sensor is lost
constexpr milliseconds kRobotiqPause{100};     // without bytes after which the sensor has stopped
constexpr std::array<std::uint8_t, 2> kRobotiqHead{0x20, 0x4E};

/// Checksum of Modbus over serial lines, and of these frames: polynomial x^16 + x^15 + x^2 + 1.
std::uint16_t robotiq_checksum(std::span<const std::uint8_t> bytes) {
  std::uint16_t sum = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    sum = static_cast<std::uint16_t>(sum ^ byte);
    for (int bit = 0; bit < 8; ++bit) {
      sum = static_cast<std::uint16_t>((sum & 1) != 0 ? (sum >> 1) ^ 0xA001 : sum >> 1);
    }
  }
  return sum;
}

/// Bytes with their checksum, low byte first.
std::vector<std::uint8_t> with_checksum(std::vector<std::uint8_t> bytes) {
  const std::uint16_t sum = robotiq_checksum(bytes);
  bytes.push_back(static_cast<std::uint8_t>(sum & 0xFF));
  bytes.push_back(static_cast<std::uint8_t>(sum >> 8));
  return bytes;
}

std::uint16_t low_first(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8);
}

bool is_frame(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kChecked = kRobotiqFrame - 2;
  return bytes[0] == kRobotiqHead[0] && bytes[1] == kRobotiqHead[1] &&
         robotiq_checksum(bytes.first(kChecked)) == low_first(bytes, kChecked);
}

class RobotiqSource final : public ChannelSource {
 public:
  explicit RobotiqSource(const std::string& path)
      : connection_(Connection::serial("Robotiq sensor", path, kRobotiqBaud)),
        bytes_(kRobotiqRoom) {
    stop();
    while (connection_.receive(bytes_, kRobotiqPause)) {
      if (steady_clock::now() - heard_ > kRobotiqSilence) {
        throw RunError(connection_.name() + ": sends without end and cannot be stopped");
      }
    }
    start();
    heard_ = emptied_ = steady_clock::now();
  }
  ~RobotiqSource() override {
    try {
      stop();
    } catch (const RunError&) {  // it is gone
    }
  }
  RobotiqSource(const RobotiqSource&) = delete;
  RobotiqSource& operator=(const RobotiqSource&) = delete;

  void read(ChannelInbox& into, milliseconds patience) override {
    const auto room = std::span<std::uint8_t>(bytes_).subspan(filled_);
    auto count = connection_.receive(room, milliseconds{0});
    double window = 0.0;  // in which the bytes came [s]
    if (count) {
      window = std::chrono::duration<double>(steady_clock::now() - emptied_).count();
    } else {
      count = connection_.receive(room, patience);
    }
    emptied_ = steady_clock::now();
    filled_ += count.value_or(0);
    take_frames(into, window);
    if (steady_clock::now() - heard_ > kRobotiqSilence) {
      throw RunError(connection_.name() + ": sends no more frames");
    }
  }

 private:
  void stop() {
    std::array<std::uint8_t, 50> jam{};
    jam.fill(0xFF);
    connection_.send(jam);
  }

  /// Writes 0x0200 to register 410 of slave 9 and waits for the answer.
  void start() {
    connection_.send(with_checksum({9, 16, 0x01, 0x9A, 0, 1, 2, 0x02, 0x00}));
    const auto answer = with_checksum({9, 16, 0x01, 0x9A, 0, 1});
    const auto until = steady_clock::now() + kRobotiqSilence;
    filled_ = 0;
    while (steady_clock::now() < until && filled_ < bytes_.size()) {
      filled_ +=
          connection_.receive(std::span<std::uint8_t>(bytes_).subspan(filled_), kRobotiqPause)
              .value_or(0);
      const auto end = bytes_.begin() + static_cast<std::ptrdiff_t>(filled_);
      const auto found = std::search(bytes_.begin(), end, answer.begin(), answer.end());
      if (found != end) {
        drop(static_cast<std::size_t>(found - bytes_.begin()) + answer.size());
        return;
      }
    }
    throw RunError(connection_.name() + ": does not answer the request for data");
  }

  void drop(std::size_t count) {
    std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(count),
              bytes_.begin() + static_cast<std::ptrdiff_t>(filled_), bytes_.begin());
    filled_ -= count;
  }

  /// Takes every whole frame; a part of one stays.
  void take_frames(ChannelInbox& into, double window) {
    std::array<std::size_t, kRobotiqRoom / kRobotiqFrame> begins{};
    std::size_t frames = 0;
    std::size_t bad = 0;
    std::size_t at = 0;
    while (at + kRobotiqFrame <= filled_) {
      if (is_frame(std::span<const std::uint8_t>(bytes_).subspan(at, kRobotiqFrame))) {
        begins[frames++] = at;
        at += kRobotiqFrame;
      } else {
        ++bad;
        ++at;
      }
    }
    if (bad > 0) {
      into.note(Incident::kMalformed, static_cast<double>(bad));
    }
    for (std::size_t i = 0; i < frames; ++i) {
      take_frame(into, begins[i], frames - 1 - i,
                 window - static_cast<double>(frames - 1) / kRobotiqRate);
    }
    drop(at);
  }

  /// @param later  frames that came after this one and were read with it
  /// @param slack  time within which the last of them came; below 0: at once [s]
  void take_frame(ChannelInbox& into, std::size_t begin, std::size_t later, double slack) {
    std::array<double, 6> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto counts = static_cast<std::int16_t>(low_first(bytes_, begin + 2 + 2 * i));
      values[i] = counts / (i < 3 ? 100.0 : 1000.0);
    }
    heard_ = steady_clock::now();
    InstrumentSample sample{values};
    sample.waited = 2.0 * static_cast<double>(later) / kRobotiqRate + std::max(0.0, slack);
    into.take(sample);
  }

  Connection connection_;
  std::vector<std::uint8_t> bytes_;  // the first filled_ are not taken yet
  std::size_t filled_{0};
  steady_clock::time_point emptied_{};  // when the line was read last
  steady_clock::time_point heard_{steady_clock::now()};
};

struct RobotiqOptions {
  std::string path;
};

ChannelPlan read_robotiq(Table& table) {
  using R = RobotiqOptions;
  static const auto schema =
      Schema<R>()
          .text("path", &R::path, "Serial line, such as /dev/ttyUSB0")
          .required()
          .check([](Table& definition, R& options) {
            if (options.path.empty()) {
              definition.reject("path", "empty", "the file of a serial line");
            }
          });
  const RobotiqOptions options = schema.read(table);
  ChannelPlan plan;
  plan.quantities = {{"fx", "N"},   {"fy", "N"},   {"fz", "N"},
                     {"tx", "N·m"}, {"ty", "N·m"}, {"tz", "N·m"}};
  plan.path = options.path;
  plan.rate = kRobotiqRate;
  plan.clock.latency = 10.0 * kRobotiqFrame / kRobotiqBaud;  // ten bits a byte on the line
  plan.clock.latency_uncertainty = 10e-3;                    // the adapter's, and the sensor's
  plan.open = [path = options.path] { return std::make_unique<RobotiqSource>(path); };
  return plan;
}

}  // namespace

const ChannelKind& robotiq_channel() {
  static const ChannelKind kind{"robotiq", "force-torque sensors Robotiq FT 150 and FT 300",
                                read_robotiq};
  return kind;
}

}  // namespace haptrial::channel
