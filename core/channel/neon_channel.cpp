#include "core/channel/channel_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/base/definition/schema.h"
#include "core/base/error.h"

// The C library's header of name servers, which this one includes, defines a macro _res; Eigen has
// parameters of that name.
#include <httplib.h>

namespace haptrial::channel {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kAnswerWithin{1500};  // of the phone
constexpr milliseconds kShownWithin{3000};   // a recording, in the phone's answers
constexpr double kMissedAnswers = 4.0;       // until the phone counts as lost
constexpr int kNoAnswer = 1;                 // below any number that HTTP gives
constexpr double kBytesPerGigabyte = 1e9;
constexpr double kNsPerSecond = 1e9;

/// The keys of a channel of this kind.
struct NeonOptions {
  std::string host{"neon.local"};
  int port{8080};
  double rate{1.0};  // > 0 [Hz]
  bool record{false};
};

const Schema<NeonOptions>& neon_schema() {
  using O = NeonOptions;
  static const auto schema =
      Schema<O>()
          .text("host", &O::host,
                "Name or address of the phone with the Companion app; the app shows it")
          .integer("port", &O::port, 1, 65535, "Port of the app's interface")
          .number("rate", &O::rate, {0.01, 50.0}, "Hz",
                  "How often the phone is asked for its state")
          .flag("record", &O::record,
                "Whether a recording on the phone begins and ends with the channel")
          .check([](Table& table, O& o) {
            if (o.host.empty() || o.host.find('/') != std::string::npos) {
              table.reject("host", fmt::format("\"{}\"", o.host),
                           "a name or address such as 192.168.1.21, without http:// and path");
            }
          });
  return schema;
}

/// State of the phone in numbers, in the order of quantities().
struct PhoneState {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  double battery{kUnknown};  // [%]
  double memory{kUnknown};   // free [GB]
  double recording{0.0};     // 1: a recording runs
  double recorded{0.0};      // since when [s]

  static std::vector<Quantity> quantities() {
    return {{"battery", "%"}, {"memory", "GB"}, {"recording", "1"}, {"recorded", "s"}};
  }
};

/// One part of the phone and its state.
struct PartState {
  std::string text;
  bool fault{false};
};

/// All parts of an answer. @throws nlohmann::json::exception if it has another form
struct PhoneAnswer {
  PhoneState numbers;
  std::map<std::string, PartState> parts;

  explicit PhoneAnswer(const json& answer) {
    parts["recording"] = {"none", false};
    for (const json& each : answer.at("result")) {
      const std::string model = each.at("model");
      const json& data = each.at("data");
      if (model == "Phone") {
        read_phone(data);
      } else if (model == "Sensor") {
        read_sensor(data);
      } else if (model == "Recording") {
        read_recording(data);
      }
    }
  }

 private:
  void read_phone(const json& data) {
    numbers.battery = data.value("battery_level", PhoneState::kUnknown);
    numbers.memory = data.value("memory", PhoneState::kUnknown) / kBytesPerGigabyte;
    for (const char* part : {"battery", "memory"}) {
      const std::string state = data.value(fmt::format("{}_state", part), "OK");
      parts[part] = {state, state != "OK"};
    }
  }
  void read_sensor(const json& data) {
    const bool connected = data.value("connected", false);
    const bool error = data.value("stream_error", false);
    parts[fmt::format("sensor {} {}", data.value("sensor", "?"), data.value("conn_type", ""))] = {
        error       ? "error of the stream"
        : connected ? "connected"
                    : "not connected",
        error || !connected};
  }
  void read_recording(const json& data) {
    const std::string action = data.value("action", "");
    const std::string message = data.value("message", "");
    numbers.recording = action == "START" ? 1.0 : 0.0;
    numbers.recorded = data.value("rec_duration_ns", 0.0) / kNsPerSecond;
    parts["recording"] = {fmt::format("{} {}{}{}", action, data.value("id", ""),
                                      message.empty() ? "" : ": ", message),
                          action == "ERROR"};
  }
};

/// A phone that was reached. One that does not answer for a while is asked on and on.
class NeonSource final : public ChannelSource {
 public:
  explicit NeonSource(const NeonOptions& options)
      : options_(options), client_(options.host, options.port), next_(steady_clock::now()) {
    client_.set_connection_timeout(kAnswerWithin);
    client_.set_read_timeout(kAnswerWithin);
    client_.set_write_timeout(kAnswerWithin);
    client_.set_keep_alive(true);
    const httplib::Result status = client_.Get("/api/status");
    if (!status || status->status != 200) {
      throw RunError(
          fmt::format("{}:{} gives no state of a Neon: {}; open the Companion app, and state host "
                      "as it shows it",
                      options.host, options.port, failure_of(status)));
    }
    if (options.record) {
      start_recording();
    }
  }
  ~NeonSource() override {
    if (recording_) {
      client_.Post("/api/recording:stop_and_save");
    }
  }
  NeonSource(const NeonSource&) = delete;
  NeonSource& operator=(const NeonSource&) = delete;

  void read(ChannelInbox& into, milliseconds patience) override {
    const auto now = steady_clock::now();
    if (now < next_) {
      std::this_thread::sleep_until(std::min(next_, now + patience));
      return;
    }
    next_ = now + std::chrono::duration_cast<steady_clock::duration>(
                      std::chrono::duration<double>(1.0 / options_.rate));
    const std::int64_t asked = into.now();
    const httplib::Result status = client_.Get("/api/status");
    if (!status || status->status != 200) {
      note_failure(into, failure_of(status), status ? status->status : kNoAnswer);
      return;
    }
    failure_.clear();
    try {
      const PhoneAnswer answer(json::parse(status->body));
      take(into, answer, 1e-9 * static_cast<double>(into.now() - asked));
      watch_recording(answer.numbers.recording > 0.0);
    } catch (const json::exception&) {
      into.note(Incident::kMalformed, static_cast<double>(status->body.size()),
                "the answer of the phone is no state of a Neon");
    }
  }

 private:
  static std::string failure_of(const httplib::Result& result) {
    if (!result) {
      return httplib::to_string(result.error());
    }
    const json answer = json::parse(result->body, nullptr, false);
    const bool says = answer.is_object() && answer.contains("message");
    return fmt::format("HTTP {}{}{}", result->status, says ? ": " : "",
                       says ? answer["message"].dump() : "");
  }

  void start_recording() {
    const httplib::Result started = client_.Post("/api/recording:start");
    if (!started || started->status != 200) {
      throw RunError(fmt::format("{}:{} begins no recording: {}", options_.host, options_.port,
                                 failure_of(started)));
    }
    recording_ = true;
    ends_from_ = steady_clock::now() + kShownWithin;
  }

  /// The channel is lost with the recording that it began, and begins another one when it is opened
  /// anew.
  void watch_recording(bool runs) {
    if (runs) {
      ends_from_ = {};
    } else if (recording_ && steady_clock::now() > ends_from_) {
      recording_ = false;
      throw RunError("the recording on the phone has ended");
    }
  }

  /// Told when it begins, and when it changes.
  void note_failure(ChannelInbox& into, const std::string& failure, int status) {
    if (failure != failure_) {
      failure_ = failure;
      into.note(Incident::kStatus, status, "no answer: " + failure);
    }
  }

  void take(ChannelInbox& into, const PhoneAnswer& answer, double waited) {
    for (const auto& [name, part] : answer.parts) {
      PartState& before = parts_[name];
      if (before.text != part.text) {
        into.note(Incident::kStatus, part.fault ? 1.0 : 0.0,
                  fmt::format("{}: {}", name, part.text));
        before = part;
      }
    }
    const PhoneState& numbers = answer.numbers;
    const std::array values{numbers.battery, numbers.memory, numbers.recording, numbers.recorded};
    InstrumentSample sample;
    sample.values = values;
    sample.waited = waited;
    into.take(sample);
  }

  NeonOptions options_;
  httplib::Client client_;
  steady_clock::time_point next_;
  bool recording_{false};                 // that we began
  steady_clock::time_point ends_from_{};  // when an answer without a recording says that it ended
  std::string failure_;                   // empty: the phone answers
  std::map<std::string, PartState> parts_;
};

}  // namespace

ChannelKind neon_channel() {
  return {"neon", "state and recording of a Pupil Labs Neon eye tracker", [](Table& table) {
            const NeonOptions options = neon_schema().read(table);
            ChannelPlan plan;
            plan.quantities = PhoneState::quantities();
            plan.rate = options.rate;
            plan.patience = std::clamp(kMissedAnswers / options.rate, plan.patience, 60.0);
            plan.open = [options] { return std::make_unique<NeonSource>(options); };
            return plan;
          }};
}

}  // namespace haptrial::channel
