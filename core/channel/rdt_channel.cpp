#include "core/channel/channel_kinds.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/channel/connection.h"
#include "core/channel/network_order.h"

// The C library's header of name servers, which this one includes, defines a macro _res; Eigen has
// parameters of that name.
#include <httplib.h>

namespace haptrial::channel {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr std::size_t kRdtRecord = 36;     // bytes
constexpr std::size_t kRdtPacket = 65536;  // bytes of the largest datagram
constexpr int kRdtPackets = 64;            // in one read
constexpr milliseconds kRdtSilence{2000};  // after which the sensor is lost
constexpr std::size_t kRdtText = 250;      // bytes of an incident's text
constexpr std::uint16_t kRdtStop = 0;
constexpr std::uint16_t kRdtBias = 0x42;

enum class RdtMode : std::uint16_t { kRealtime = 2, kBuffered = 3 };  // commands that start it

struct RdtOptions {
  std::string host;
  int port{49152};
  int http_port{80};
  double rate{0.0};                         // > 0 [Hz]
  std::optional<double> counts_per_force;   // > 0 [1/N]; nothing: the sensor's page says it
  std::optional<double> counts_per_torque;  // > 0 [1/(N·m)]; likewise
  RdtMode mode{RdtMode::kRealtime};
  bool bias{false};
};

/// Counts of the sensor and the units in which it counts.
struct RdtScale {
  double force_counts{1.0};
  double torque_counts{1.0};
  double force_unit{1.0};   // [N]
  double torque_unit{1.0};  // [N·m]
};

const Schema<RdtOptions>& rdt_schema() {
  using R = RdtOptions;
  static const auto schema =
      Schema<R>()
          .text("host", &R::host, "Address of the sensor, such as 192.168.1.1")
          .required()
          .integer("port", &R::port, 1, 65535, "UDP port of the sensor's records")
          .number("rate", &R::rate, {0.0, 20000.0, true}, "Hz",
                  "Records a second that the sensor is set to send; they are its clock")
          .required()
          .number("counts_per_force", &R::counts_per_force, {0.0, 1e12, true}, "1/N",
                  "Counts for one newton")
          .otherwise("from the sensor's netftapi2.xml")
          .number("counts_per_torque", &R::counts_per_torque, {0.0, 1e12, true}, "1/(N·m)",
                  "Counts for one newton metre")
          .otherwise("from the sensor's netftapi2.xml")
          .integer("http_port", &R::http_port, 1, 65535,
                   "Port of the sensor's web pages, which state its counts")
          .choice("mode", &R::mode,
                  {{"realtime", RdtMode::kRealtime}, {"buffered", RdtMode::kBuffered}},
                  "Whether each record comes at once, or several come together")
          .flag("bias", &R::bias,
                "Whether the load at the start of a session counts as zero from then on")
          .check([](Table& table, R& options) {
            if (options.counts_per_force.has_value() != options.counts_per_torque.has_value()) {
              table.reject(
                  options.counts_per_force ? "counts_per_force" : "counts_per_torque",
                  "needs the other one of counts_per_force and counts_per_torque beside it");
            }
          });
  return schema;
}

/// Text of an element of a page of the sensor; empty if it has none of this name.
std::string element_of(const std::string& page, const std::string& name) {
  const std::string opening = "<" + name + ">";
  const std::size_t begin = page.find(opening);
  const std::size_t end = page.find("</" + name + ">", begin);
  if (begin == std::string::npos || end == std::string::npos) {
    return "";
  }
  return page.substr(begin + opening.size(), end - begin - opening.size());
}

double number_of(const std::string& text) {
  double value = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

/// Size of a unit that the sensor names; 0: the name is unknown.
double unit_of(const std::string& name, std::span<const std::pair<const char*, double>> units) {
  for (const auto& [each, size] : units) {
    if (name == each) {
      return size;
    }
  }
  return 0.0;
}

constexpr std::array<std::pair<const char*, double>, 6> kForceUnits{{{"N", 1.0},
                                                                     {"kN", 1000.0},
                                                                     {"lbf", 4.4482216152605},
                                                                     {"klbf", 4448.2216152605},
                                                                     {"kgf", 9.80665},
                                                                     {"gf", 9.80665e-3}}};  // [N]
constexpr std::array<std::pair<const char*, double>, 9> kTorqueUnits{
    {{"Nm", 1.0},
     {"N-m", 1.0},
     {"Nmm", 1e-3},
     {"N-mm", 1e-3},
     {"kNm", 1000.0},
     {"kN-m", 1000.0},
     {"lbf-in", 0.1129848290276167},
     {"lbf-ft", 1.3558179483314004},
     {"kgf-cm", 0.0980665}}};  // [N·m]

/// Reads the counts from the sensor's page. @throws RunError if it has no such page, or if it sends
/// at another rate than the definition says
RdtScale read_scale(const RdtOptions& options) {
  const std::string where =
      fmt::format("RDT sensor at http://{}:{}/netftapi2.xml", options.host, options.http_port);
  httplib::Client client(options.host, options.http_port);
  client.set_connection_timeout(kRdtSilence);
  client.set_read_timeout(kRdtSilence);
  const auto answer = client.Get("/netftapi2.xml");
  if (!answer || answer->status != 200) {
    throw RunError(
        fmt::format("{}: there is no such page; state counts_per_force and "
                    "counts_per_torque",
                    where));
  }
  const std::string force = element_of(answer->body, "scfgfu");
  const std::string torque = element_of(answer->body, "scfgtu");
  const RdtScale scale{number_of(element_of(answer->body, "cfgcpf")),
                       number_of(element_of(answer->body, "cfgcpt")), unit_of(force, kForceUnits),
                       unit_of(torque, kTorqueUnits)};
  if (!(scale.force_counts > 0.0) || !(scale.torque_counts > 0.0) || scale.force_unit == 0.0 ||
      scale.torque_unit == 0.0) {
    throw RunError(
        fmt::format("{}: the counts or units (force '{}', torque '{}') cannot be read; "
                    "state counts_per_force and counts_per_torque",
                    where, force, torque));
  }
  const double rate = number_of(element_of(answer->body, "comrdtrate"));
  if (rate > 0.0 && std::abs(rate - options.rate) > 0.005 * rate) {
    throw RunError(
        fmt::format("{}: the sensor is set to {} records a second, and rate is {}; they "
                    "must be equal",
                    where, rate, options.rate));
  }
  return scale;
}

/// Names of the bits of the status word by the manuals of Net F/T and Axia, which differ.
struct StatusBit {
  const char* net;
  const char* axia;
};
constexpr std::array<StatusBit, 32> kStatusBits{
    {{"", "temperature out of range"},
     {"HTTP failure", "supply voltage out of range"},
     {"temperature out of range", "broken strain gage"},
     {"reference voltage wrong", "busy"},
     {"no data from the analog board", ""},
     {"supply of the analog board too low", "other error"},
     {"supply of the analog board too high", ""},
     {"analog ground out of range", "calibration cannot be read"},
     {"too little excitation of gages", ""},
     {"too much excitation of gages", ""},
     {"watchdog of the analog board", ""},
     {"flash memory failure", ""},
     {"EEPROM failure", ""},
     {"stack error", ""},
     {"watchdog", ""},
     {"", ""},
     {"monitor condition latched", "monitor condition latched"},
     {"saturated, or an error of the A/D converter", ""},
     {"DeviceNet failure", ""},
     {"EtherNet/IP failure", ""},
     {"RDT failure", ""},
     {"CAN failure", ""},
     {"network failure", ""},
     {"configuration does not fit the calibration", ""},
     {"settings invalid", ""},
     {"halted by its configuration", ""},
     {"program memory damaged", ""},
     {"serial link failure", "gage out of range"},
     {"analog board failure", "simulated error"},
     {"digital board failure", "checksum of the calibration wrong"},
     {"CPU or RAM failure", "force or torque out of range"},
     {"error", "error"}}};

std::string name_of_bit(int bit) {
  const std::string net = kStatusBits.at(static_cast<std::size_t>(bit)).net;
  const std::string axia = kStatusBits.at(static_cast<std::size_t>(bit)).axia;
  if (net.empty() && axia.empty()) {
    return fmt::format("bit {}", bit);
  }
  if (net == axia || axia.empty()) {
    return net;
  }
  return net.empty() ? axia : fmt::format("{} (Axia: {})", net, axia);
}

/// The status in words, highest bit first, no longer than an incident's text.
std::string status_text(std::uint32_t status) {
  std::string text = fmt::format("0x{:08x}: ", status);
  if (status == 0) {
    return text + "no error";
  }
  const char* between = "";
  for (int bit = 31; bit >= 0; --bit) {
    if ((status >> bit & 1u) != 0) {
      const std::string name = name_of_bit(bit);
      if (text.size() + name.size() + 5 > kRdtText) {
        return text + ", ...";
      }
      text += between + name;
      between = ", ";
    }
  }
  return text;
}

class RdtSource final : public ChannelSource {
 public:
  RdtSource(const RdtOptions& options, const RdtScale& scale)
      : options_(options),
        scale_(scale),
        connection_(Connection::datagrams("RDT sensor", options.host, options.port)),
        packet_(kRdtPacket) {
    if (options.bias) {
      request(kRdtBias);
    }
    request(static_cast<std::uint16_t>(options.mode));
    waiting_ = connection_.receive(packet_, kRdtSilence);
    if (!waiting_) {
      throw RunError(connection_.name() + ": sends no records");
    }
  }
  ~RdtSource() override {
    try {
      request(kRdtStop);
    } catch (const RunError&) {  // it is gone
    }
  }
  RdtSource(const RdtSource&) = delete;
  RdtSource& operator=(const RdtSource&) = delete;

  void read(ChannelInbox& into, milliseconds patience) override {
    auto size = std::exchange(waiting_, std::nullopt);
    if (!size) {
      size = connection_.receive(packet_, patience);
    }
    for (int i = 0; size && i < kRdtPackets; ++i) {
      take_packet(into, *size);
      size = connection_.receive(packet_, milliseconds{0});
    }
    waiting_ = size;
    if (steady_clock::now() - heard_ > kRdtSilence) {
      throw RunError(connection_.name() + ": sends no more records");
    }
  }

 private:
  void request(std::uint16_t command) {
    const std::array<std::uint8_t, 8> bytes{0x12,
                                            0x34,
                                            static_cast<std::uint8_t>(command >> 8),
                                            static_cast<std::uint8_t>(command),
                                            0,
                                            0,
                                            0,
                                            0};  // a count of 0: without end
    connection_.send(bytes);
  }

  void take_packet(ChannelInbox& into, std::size_t size) {
    if (size == 0 || size % kRdtRecord != 0) {
      into.note(Incident::kMalformed, static_cast<double>(size));
      return;
    }
    int repeated = 0;
    for (std::size_t at = 0; at < size; at += kRdtRecord) {
      const auto record = std::span<const std::uint8_t>(packet_).subspan(at, kRdtRecord);
      repeated += take_record(into, record) ? 0 : 1;
    }
    if (repeated > 0) {
      into.note(Incident::kRepeated, repeated);
    }
  }

  /// @returns whether the record is newer than all before it
  bool take_record(ChannelInbox& into, std::span<const std::uint8_t> record) {
    const std::uint32_t sequence = word_at(record, 0);
    const auto ahead = began_ ? static_cast<std::int32_t>(sequence - expected_) : 0;
    if (ahead < 0) {
      return false;
    }
    began_ = true;
    expected_ = sequence + 1;  // may begin again at 0
    counted_ += static_cast<std::uint64_t>(ahead) + 1;
    heard_ = steady_clock::now();
    note_status(into, word_at(record, 8));
    std::array<double, 6> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto counts = static_cast<std::int32_t>(word_at(record, 12 + 4 * i));
      values[i] = i < 3 ? counts * scale_.force_unit / scale_.force_counts
                        : counts * scale_.torque_unit / scale_.torque_counts;
    }
    into.take({values, static_cast<double>(counted_) / options_.rate, 0.0,
               static_cast<std::uint64_t>(ahead)});
    return true;
  }

  void note_status(ChannelInbox& into, std::uint32_t status) {
    if (status != std::exchange(status_, status)) {
      into.note(Incident::kStatus, status, status_text(status));
    }
  }

  RdtOptions options_;
  RdtScale scale_;
  Connection connection_;
  std::vector<std::uint8_t> packet_;
  std::optional<std::size_t> waiting_;  // bytes in packet_ that were not taken yet
  bool began_{false};
  std::uint32_t expected_{0};  // sequence of the next record
  std::uint64_t counted_{0};   // records of the sensor so far, with those that are lost
  std::uint32_t status_{0};
  steady_clock::time_point heard_{steady_clock::now()};
};

ChannelPlan read_rdt(Table& table) {
  RdtOptions options = rdt_schema().read(table);
  ChannelPlan plan;
  plan.quantities = {{"fx", "N"},   {"fy", "N"},   {"fz", "N"},
                     {"tx", "N·m"}, {"ty", "N·m"}, {"tz", "N·m"}};
  plan.rate = options.rate;
  plan.open = [options]() mutable {
    const RdtScale scale = options.counts_per_force ? RdtScale{*options.counts_per_force,
                                                               *options.counts_per_torque, 1.0, 1.0}
                                                    : read_scale(options);
    auto source = std::make_unique<RdtSource>(options, scale);
    options.bias = false;  // a sensor that is opened anew may be under load
    return source;
  };
  return plan;
}

}  // namespace

const ChannelKind& rdt_channel() {
  static const ChannelKind kind{
      "rdt", "force-torque sensors that send RDT records: ATI Net F/T and Axia, Schunk, OnRobot",
      read_rdt};
  return kind;
}

}  // namespace haptrial::channel
