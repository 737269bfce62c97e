#include "core/channel/channel_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/channel/connection.h"

namespace haptrial::channel {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr long kMostInput = 254;
constexpr milliseconds kLabJackSilence{2000};  // without an answer the instrument is lost
constexpr milliseconds kLabJackLook{20};       // for that
constexpr float kNoReading = -9999.0F;         // that the instrument gives for an input without one
constexpr std::size_t kModbusHead = 6;         // bytes: transaction, protocol, length of the rest
constexpr std::size_t kModbusRest = 254;       // bytes at most
constexpr int kMostOfRun = 62;                 // inputs in an answer of Modbus
constexpr std::uint8_t kReadRegisters = 3;     // function of Modbus

/// One input and the quantity that it measures: scale * voltage + offset.
struct LabJackInput {
  int input{0};
  double scale{1.0};   // [unit/V]
  double offset{0.0};  // [unit]
  std::string unit{"V"};
};

struct LabJackOptions {
  std::string host;
  int port{502};
  double rate{100.0};  // > 0 [Hz]
  std::vector<std::string> names;
  std::vector<LabJackInput> inputs;
};

const Schema<LabJackInput>& labjack_input_schema() {
  using I = LabJackInput;
  static const auto schema =
      Schema<I>()
          .integer("input", &I::input, 0, kMostInput, "Number of the analogue input: 2 for AIN2")
          .required()
          .number("scale", &I::scale, {-1e9, 1e9}, "", "Change of the quantity for one volt")
          .number("offset", &I::offset, {-1e9, 1e9}, "", "Quantity at 0 V")
          .text("unit", &I::unit, "Unit of the quantity");
  return schema;
}

const Schema<LabJackOptions>& labjack_schema() {
  using L = LabJackOptions;
  static const auto schema =
      Schema<L>()
          .text("host", &L::host, "Address of the instrument, such as 192.168.1.207")
          .required()
          .integer("port", &L::port, 1, 65535, "TCP port of the instrument's Modbus")
          .number("rate", &L::rate, {0.01, 1000.0}, "Hz", "How often all inputs are read")
          .custom("inputs",
                  "Quantities and the analogue inputs that measure them; a quantity is scale times "
                  "the voltage, plus offset",
                  [](Table& table, const std::string& key, L& into) {
                    Table all = table.table(key);
                    for (const std::string& name : all.keys_as_written()) {
                      Table inner = all.table(name);
                      into.names.push_back(name);
                      into.inputs.push_back(labjack_input_schema().read(inner));
                    }
                  })
          .required();
  return schema;
}

/// Inputs one after the other, which one request reads; kMostOfRun at most.
struct InputRun {
  int first{0};
  int count{0};
};

std::vector<InputRun> runs_of(const std::vector<LabJackInput>& inputs) {
  std::vector<int> numbers;
  for (const LabJackInput& each : inputs) {
    numbers.push_back(each.input);
  }
  std::ranges::sort(numbers);
  std::vector<InputRun> runs;
  for (const int number : numbers) {
    const int next = runs.empty() ? -1 : runs.back().first + runs.back().count;
    if (number == next && runs.back().count < kMostOfRun) {
      ++runs.back().count;
    } else if (number >= next) {
      runs.push_back({number, 1});
    }
  }
  return runs;
}

std::uint16_t high_first(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

float float_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return std::bit_cast<float>(std::uint32_t{high_first(bytes, at)} << 16 |
                              std::uint32_t{high_first(bytes, at + 2)});
}

const char* exception_text(int code) {
  constexpr std::array<const char*, 7> kTexts{"unknown",     "unknown function", "no such input",
                                              "wrong value", "device failure",   "acknowledged",
                                              "busy"};
  return kTexts.at(code > 0 && code < static_cast<int>(kTexts.size()) ? code : 0);
}

static_assert(kMostQuantities <= 64, "a bit of absent_ for each");

class LabJackSource final : public ChannelSource {
 public:
  explicit LabJackSource(const LabJackOptions& options)
      : options_(options),
        runs_(runs_of(options.inputs)),
        voltages_(kMostInput + 1, std::numeric_limits<double>::quiet_NaN()),
        values_(options.inputs.size()),
        connection_(Connection::stream("LabJack", options.host, options.port)),
        bytes_(4 * (kModbusHead + kModbusRest)) {
    while (!poll(nullptr, kLabJackLook)) {  // shows that the instrument answers
    }
  }

  void read(ChannelInbox& into, milliseconds patience) override {
    if (poll(&into, patience)) {
      take_sample(into);
    }
  }

 private:
  /// Asks for all inputs when that is due, and takes what comes. @param into  null: nobody is told
  /// @returns whether the last of the inputs has come
  bool poll(ChannelInbox* into, milliseconds patience) {
    const auto until = steady_clock::now() + patience;
    if (!asked_) {
      std::this_thread::sleep_until(std::min(due_, until));
      if (steady_clock::now() < due_) {
        return false;
      }
      run_ = 0;
      asked_ = true;
      asked_at_ = steady_clock::now();
      asked_ns_ = into == nullptr ? 0 : into->now();
      ask();
    }
    while (asked_) {
      const auto left = std::chrono::duration_cast<milliseconds>(until - steady_clock::now());
      const auto count = connection_.receive(std::span<std::uint8_t>(bytes_).subspan(filled_),
                                             std::max(left, milliseconds{0}));
      if (!count) {
        break;
      }
      filled_ += *count;
      take_answers(into);
    }
    if (asked_ && steady_clock::now() - asked_at_ > kLabJackSilence) {
      throw RunError(connection_.name() + ": does not answer");
    }
    return !asked_;
  }

  void ask() {
    const InputRun& run = runs_[run_];
    ++transaction_;
    const int address = 2 * run.first;  // of the first register
    const std::array<std::uint8_t, 12> request{static_cast<std::uint8_t>(transaction_ >> 8),
                                               static_cast<std::uint8_t>(transaction_),
                                               0,
                                               0,
                                               0,
                                               6,
                                               1,
                                               kReadRegisters,
                                               static_cast<std::uint8_t>(address >> 8),
                                               static_cast<std::uint8_t>(address),
                                               0,
                                               static_cast<std::uint8_t>(2 * run.count)};
    connection_.send(request);
  }

  void take_answers(ChannelInbox* into) {
    const std::span<const std::uint8_t> bytes = bytes_;
    std::size_t at = 0;
    while (at + kModbusHead <= filled_) {
      const std::size_t rest = high_first(bytes, at + 4);
      if (high_first(bytes, at + 2) != 0 || rest < 3 || rest > kModbusRest) {
        refuse_bytes(into, filled_ - at);
      }
      if (at + kModbusHead + rest > filled_) {
        break;
      }
      if (!asked_ || high_first(bytes, at) != transaction_) {
        note(into, Incident::kRepeated, 1.0);
      } else {
        take_answer(into, bytes.subspan(at + kModbusHead, rest));
      }
      at += kModbusHead + rest;
    }
    std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(at),
              bytes_.begin() + static_cast<std::ptrdiff_t>(filled_), bytes_.begin());
    filled_ -= at;
  }

  /// Nothing shows at which of the bytes an answer begins, so that the connection is given up.
  [[noreturn]] void refuse_bytes(ChannelInbox* into, std::size_t count) {
    note(into, Incident::kMalformed, static_cast<double>(count));
    throw RunError(connection_.name() + ": sends what is no answer of Modbus");
  }

  /// @param answer  unit, function and what follows
  void take_answer(ChannelInbox* into, std::span<const std::uint8_t> answer) {
    const InputRun& run = runs_[run_];
    if (answer[1] == (kReadRegisters | 0x80)) {
      const std::string last =
          run.count > 1 ? fmt::format(" to AIN{}", run.first + run.count - 1) : "";
      throw RunError(fmt::format("{}: cannot read AIN{}{} (exception {}: {})", connection_.name(),
                                 run.first, last, answer[2], exception_text(answer[2])));
    }
    const auto size = 4 * static_cast<std::size_t>(run.count);
    if (answer[1] != kReadRegisters || answer[2] != size || answer.size() != 3 + size) {
      refuse_bytes(into, kModbusHead + answer.size());
    }
    for (int i = 0; i < run.count; ++i) {
      voltages_[static_cast<std::size_t>(run.first + i)] =
          float_at(answer, 3 + 4 * static_cast<std::size_t>(i));
    }
    if (++run_ < runs_.size()) {
      ask();
      return;
    }
    asked_ = false;
    const auto now = steady_clock::now();
    const auto period = std::chrono::duration_cast<steady_clock::duration>(
        std::chrono::duration<double>(1.0 / options_.rate));
    due_ = std::max(due_ + period, now - period);
  }

  static void note(ChannelInbox* into, Incident what, double amount) {
    if (into != nullptr) {
      into->note(what, amount);
    }
  }

  void take_sample(ChannelInbox& into) {
    std::uint64_t absent = 0;  // a bit for each input without a reading
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const LabJackInput& input = options_.inputs[i];
      const double voltage = voltages_[static_cast<std::size_t>(input.input)];
      const bool is_there = std::isfinite(voltage) && voltage != kNoReading;
      values_[i] = is_there ? input.scale * voltage + input.offset
                            : std::numeric_limits<double>::quiet_NaN();
      absent |= std::uint64_t{is_there ? 0u : 1u} << i;
    }
    note_absent(into, absent);
    // The reading lies between request and answer: half of that before now, and as far to each
    // side.
    InstrumentSample sample{values_};
    sample.waited = 1e-9 * static_cast<double>(into.now() - asked_ns_);
    into.take(sample);
  }

  void note_absent(ChannelInbox& into, std::uint64_t absent) {
    if (absent == absent_) {
      return;
    }
    absent_ = absent;
    std::string text;
    for (std::size_t i = 0; i < values_.size(); ++i) {
      if ((absent >> i & 1u) != 0) {
        text += fmt::format("{}AIN{}", text.empty() ? "no reading of " : ", ",
                            options_.inputs[i].input);
      }
    }
    into.note(Incident::kStatus, std::popcount(absent),
              text.empty() ? "all inputs have a reading" : text);
  }

  LabJackOptions options_;
  std::vector<InputRun> runs_;
  std::vector<double> voltages_;  // of each input of the instrument [V]
  std::vector<double> values_;    // in the order of the quantities
  Connection connection_;
  std::vector<std::uint8_t> bytes_;  // the first filled_ are not taken yet
  std::size_t filled_{0};
  std::uint16_t transaction_{0};
  std::size_t run_{0};  // of the request that waits for its answer
  bool asked_{false};
  std::uint64_t absent_{0};
  std::int64_t asked_ns_{0};  // when the first request of a sample went out, by the session's clock
  steady_clock::time_point asked_at_{};
  steady_clock::time_point due_{steady_clock::now()};
};

ChannelPlan read_labjack(Table& table) {
  const LabJackOptions options = labjack_schema().read(table);
  ChannelPlan plan;
  for (std::size_t i = 0; i < options.inputs.size(); ++i) {
    plan.quantities.push_back({options.names[i], options.inputs[i].unit});
  }
  check_quantities(table, "inputs", plan.quantities);
  plan.rate = options.rate;
  plan.patience = std::clamp(3.0 / options.rate, plan.patience, 60.0);
  plan.clock.latency_uncertainty = 0.1e-3;
  plan.open = [options] { return std::make_unique<LabJackSource>(options); };
  return plan;
}

}  // namespace

const ChannelKind& labjack_channel() {
  static const ChannelKind kind{"labjack", "analogue inputs of LabJack T4, T7 and T8",
                                read_labjack};
  return kind;
}

}  // namespace haptrial::channel
