#include "core/channel/channel_kinds.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/channel/connection.h"
#include "core/channel/network_order.h"

namespace haptrial::channel {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using VrpnBytes = std::span<const std::uint8_t>;

constexpr milliseconds kVrpnSilence{2000};  // without a message the server is lost
constexpr milliseconds kVrpnLook{20};       // for that
// Both sides begin with a cookie: "vrpn: ver. ", a version, and the logging that they ask for.
constexpr std::string_view kVrpnCookie = "vrpn: ver. 07.38  0";
constexpr std::string_view kVrpnWord = "vrpn: ver. ";
constexpr std::string_view kVrpnMajor = "07.";  // another minor version is understood
constexpr std::size_t kVrpnCookieBytes = 24;
constexpr std::size_t kVrpnHead = 24;  // bytes: size, seconds, microseconds, sender, type, number
constexpr std::size_t kVrpnMost = 65536;            // bytes of a message
constexpr std::size_t kVrpnPose = 64;               // bytes of a pose
constexpr std::size_t kVrpnPoseValues = 7;          // position and quaternion
constexpr double kVrpnLengthError = 0.01;           // of a unit quaternion
constexpr std::int64_t kVrpnLate = 500'000;         // an older stamp is a clock that stepped [us]
constexpr std::uint32_t kVrpnSender = 0xFFFFFFFFu;  // type -1, which names a sender
constexpr std::uint32_t kVrpnType = 0xFFFFFFFEu;    // type -2, which names a type
constexpr std::string_view kVrpnPoses = "vrpn_Tracker Pos_Quat";

struct VrpnOptions {
  std::string host;
  int port{3883};
  std::string tracker;
  int sensor{0};
  double rate{0.0};  // 0: unknown [Hz]
};

const Schema<VrpnOptions>& vrpn_schema() {
  using V = VrpnOptions;
  static const auto schema =
      Schema<V>()
          .text("host", &V::host, "Address of the computer with the VRPN server")
          .required()
          .integer("port", &V::port, 1, 65535, "TCP port of the VRPN server")
          .text("tracker", &V::tracker,
                "Name of the tracker or rigid body in the server, such as \"Tracker0\"")
          .required()
          .integer("sensor", &V::sensor, 0, 1'000'000, "Number of the sensor in its tracker")
          .number("rate", &V::rate, {0.0, 20000.0}, "Hz",
                  "Poses a second, as far as known; `patience` is at least three of them");
  return schema;
}

/// The number there; NaN for one that is not finite.
double vrpn_number_at(VrpnBytes bytes, std::size_t at) {
  const double number = std::bit_cast<double>(std::uint64_t{word_at(bytes, at)} << 32 |
                                              std::uint64_t{word_at(bytes, at + 4)});
  return std::isfinite(number) ? number : std::numeric_limits<double>::quiet_NaN();
}

struct VrpnMessage {
  std::uint32_t seconds{0};       // since 1970, by the server's clock
  std::uint32_t microseconds{0};  // of the next second
  std::uint32_t sender{0};
  std::uint32_t type{0};
  VrpnBytes body;  // without the bytes that fill it up
};

/// Name in a description: its size with the zero at its end, and its text. @returns nothing if the
/// description is malformed
std::optional<std::string> vrpn_name_in(VrpnBytes body) {
  if (body.size() < 5 || word_at(body, 0) != body.size() - 4) {
    return std::nullopt;
  }
  const std::string name(body.begin() + 4, body.end());
  return name.substr(0, name.find('\0'));
}

class VrpnSource final : public ChannelSource {
 public:
  explicit VrpnSource(const VrpnOptions& options)
      : options_(options),
        connection_(Connection::stream("VRPN server", options.host, options.port)),
        bytes_(2 * kVrpnMost) {
    std::array<std::uint8_t, kVrpnCookieBytes> cookie{};
    std::ranges::copy(kVrpnCookie, cookie.begin());
    connection_.send(cookie);
    const auto until = steady_clock::now() + kVrpnSilence;
    while (!welcomed_ && steady_clock::now() < until) {
      receive(kVrpnLook);
      take_cookie();
    }
    while (!posed_ && steady_clock::now() < until) {
      take_messages(nullptr);
      receive(kVrpnLook);
    }
    if (!posed_) {
      throw RunError(connection_.name() + ": " + why_no_pose());
    }
  }

  void read(ChannelInbox& into, milliseconds patience) override {
    if (!drained_) {  // poses from before the session have no time of arrival
      do {
        take_messages(nullptr);
      } while (receive(milliseconds{0}));
      drained_ = true;
    }
    receive(patience);
    take_messages(&into);
    if (steady_clock::now() - heard_ > kVrpnSilence) {
      throw RunError(connection_.name() + ": sends nothing more");
    }
  }

 private:
  /// @returns whether bytes have come
  bool receive(milliseconds patience) {
    const auto count =
        connection_.receive(std::span<std::uint8_t>(bytes_).subspan(filled_), patience);
    if (count) {
      filled_ += *count;
      heard_ = steady_clock::now();
    }
    return count.has_value();
  }

  void forget(std::size_t count) {
    std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(count),
              bytes_.begin() + static_cast<std::ptrdiff_t>(filled_), bytes_.begin());
    filled_ -= count;
  }

  void take_cookie() {
    const std::string_view cookie(reinterpret_cast<const char*>(bytes_.data()),
                                  std::min(filled_, kVrpnCookieBytes));
    if (!cookie.starts_with(kVrpnWord.substr(0, cookie.size()))) {
      throw RunError(connection_.name() + ": is no VRPN server");
    }
    if (cookie.size() < kVrpnCookieBytes) {
      return;
    }
    const std::string_view version = cookie.substr(kVrpnWord.size(), 5);
    if (!version.starts_with(kVrpnMajor)) {
      throw RunError(fmt::format("{}: has version {} of VRPN; only 07 is understood",
                                 connection_.name(), version));
    }
    forget(kVrpnCookieBytes);
    welcomed_ = true;
  }

  /// Why no pose of the sensor has come after the opening.
  std::string why_no_pose() const {
    if (!welcomed_) {
      return "does not answer";
    }
    const auto is_named = [this](const auto& each) { return each.second == options_.tracker; };
    if (std::ranges::none_of(senders_, is_named)) {
      std::vector<std::string> names;
      for (const auto& [number, name] : senders_) {
        names.push_back("'" + name + "'");
      }
      return fmt::format("has no tracker '{}', but {}", options_.tracker,
                         names.empty() ? "none at all" : fmt::format("{}", fmt::join(names, ", ")));
    }
    return fmt::format("sends no pose of sensor {} of '{}'{}", options_.sensor, options_.tracker,
                       others_.empty() ? "" : fmt::format(", but of {}", fmt::join(others_, ", ")));
  }

  /// @param into  null: nothing is recorded
  void take_messages(ChannelInbox* into) {
    const VrpnBytes bytes = bytes_;
    std::size_t at = 0;
    while (at + kVrpnHead <= filled_) {
      const std::size_t size = word_at(bytes, at);
      if (size < kVrpnHead || size > kVrpnMost) {
        // Nothing shows at which of the bytes a message begins, so that the connection is given up.
        note(into, Incident::kMalformed, filled_ - at);
        throw RunError(connection_.name() + ": sends what is no message of VRPN");
      }
      const std::size_t padded = (size + 7) / 8 * 8;
      if (at + padded > filled_) {
        break;
      }
      if (!take_message(
              into, {word_at(bytes, at + 4), word_at(bytes, at + 8), word_at(bytes, at + 12),
                     word_at(bytes, at + 16), bytes.subspan(at + kVrpnHead, size - kVrpnHead)})) {
        note(into, Incident::kMalformed, size);
      }
      at += padded;
    }
    forget(at);
  }

  static void note(ChannelInbox* into, Incident what, std::size_t amount) {
    if (into != nullptr) {
      into->note(what, static_cast<double>(amount));
    }
  }

  /// @returns whether the message is well formed, as far as it is of use
  bool take_message(ChannelInbox* into, const VrpnMessage& message) {
    if (message.type == kVrpnSender || message.type == kVrpnType) {
      const auto name = vrpn_name_in(message.body);
      if (name) {
        (message.type == kVrpnSender ? senders_ : types_)[message.sender] = *name;
      }
      return name.has_value();
    }
    const auto sender = senders_.find(message.sender);
    const auto type = types_.find(message.type);
    if (sender == senders_.end() || sender->second != options_.tracker || type == types_.end() ||
        type->second != kVrpnPoses) {
      return true;
    }
    if (message.body.size() != kVrpnPose || message.microseconds >= 1'000'000) {
      return false;
    }
    const auto sensor = static_cast<std::int32_t>(word_at(message.body, 0));
    if (sensor == options_.sensor) {
      return take_pose(into, message);
    }
    if (!posed_) {
      others_.insert(sensor);
    }
    return true;
  }

  /// @returns whether its quaternion is an orientation, or not measured
  bool take_pose(ChannelInbox* into, const VrpnMessage& message) {
    posed_ = true;
    std::array<double, kVrpnPoseValues> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = vrpn_number_at(message.body, 8 + 8 * i);
    }
    // Servers send zeros for a body that is out of view.
    if (std::abs(Eigen::Vector4d(values[3], values[4], values[5], values[6]).norm() - 1.0) >
        kVrpnLengthError) {
      return false;
    }
    if (into == nullptr) {
      return true;
    }
    const std::int64_t stamp = std::int64_t{message.seconds} * 1'000'000 + message.microseconds;
    const std::int64_t behind = stamp_ - stamp;
    const bool again = behind == 0 && std::ranges::equal(message.body, body_);
    if (again || (behind > 0 && behind <= kVrpnLate)) {
      note(into, Incident::kRepeated, 1);
      return true;
    }
    stamp_ = stamp;
    body_.assign(message.body.begin(), message.body.end());
    InstrumentSample sample{values};
    sample.device_time = message.seconds + 1e-6 * message.microseconds;
    into->take(sample);
    return true;
  }

  VrpnOptions options_;
  Connection connection_;
  std::vector<std::uint8_t> bytes_;  // the first filled_ are not taken yet
  std::size_t filled_{0};
  bool welcomed_{false};                          // the server's cookie has come
  bool posed_{false};                             // a pose of the sensor has come
  bool drained_{false};                           // nothing lies there from before the session
  std::map<std::uint32_t, std::string> senders_;  // by the server's number
  std::map<std::uint32_t, std::string> types_;    // likewise
  std::set<std::int32_t> others_;                 // sensors of the tracker that sent poses
  std::int64_t stamp_{std::numeric_limits<std::int64_t>::min() / 2};  // of the last sample [us]
  std::vector<std::uint8_t> body_;                                    // likewise
  steady_clock::time_point heard_{steady_clock::now()};
};

ChannelPlan read_vrpn(Table& table) {
  const VrpnOptions options = vrpn_schema().read(table);
  ChannelPlan plan;
  plan.quantities = {{"x", "m"},  {"y", "m"},  {"z", "m"}, {"qx", "1"},
                     {"qy", "1"}, {"qz", "1"}, {"qw", "1"}};
  plan.rate = options.rate;
  if (options.rate > 0.0) {
    plan.patience = std::clamp(3.0 / options.rate, plan.patience, 60.0);
  }
  plan.open = [options] { return std::make_unique<VrpnSource>(options); };
  return plan;
}

}  // namespace

const ChannelKind& vrpn_channel() {
  static const ChannelKind kind{
      "vrpn", "trackers behind a VRPN server: OptiTrack, Vicon, PhaseSpace, Polhemus", read_vrpn};
  return kind;
}

}  // namespace haptrial::channel
