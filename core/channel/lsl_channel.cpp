#include "core/channel/channel_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/definition/schema.h"
#include "core/base/error.h"
#include "core/stream/lsl_library.h"

namespace haptrial::channel {
namespace {

using std::chrono::milliseconds;
using stream::LslLibrary;

constexpr double kResolveFor = 2.0;         // at most, for a stream [s]
constexpr double kSecondFor = 0.3;          // for another, beyond what the first one took [s]
constexpr double kWayTakes = 0.5;           // at most; a longer search waited for the sender [s]
constexpr double kAnswerFor = 5.0;          // of the sender, while the stream is opened [s]
constexpr std::int32_t kInletBuffer = 360;  // [s]
constexpr std::uint32_t kRawStamps = 0;     // no flag of post-processing
constexpr double kCorrectEvery = 1.0;       // until the next look for a measured offset [s]
constexpr double kSilentHost = 15.0;        // without a new offset the sender is lost [s]
constexpr double kHostDrift = 200e-6;       // of the sender's clock against ours, at most
constexpr double kLeastJump = 1e-3;         // of an offset that is a step [s]
constexpr int kPulledAtOnce = 4096;         // samples
constexpr std::size_t kLongestLabel = 40;

/// The keys of a channel of this kind.
struct LslInletOptions {
  std::string name{};
  std::string type{};
  std::string source_id{};
  std::vector<Quantity> quantities{};  // none: the stream sends texts
  double rate{0.0};                    // 0: unknown [Hz]
  std::string library{"liblsl.so"};
};

void check_inlet(Table& table, LslInletOptions& options) {
  const std::array<std::pair<const char*, const std::string*>, 3> all{
      {{"name", &options.name}, {"type", &options.type}, {"source_id", &options.source_id}}};
  for (const auto& [key, text] : all) {
    if (text->find('\'') != std::string::npos) {
      table.reject(key, fmt::format("\"{}\"", *text), "a text without '");
    }
  }
  if (std::ranges::all_of(all, [](const auto& each) { return each.second->empty(); })) {
    table.reject("name", "is not there; state name, type or source_id of the stream");
  }
}

const Schema<LslInletOptions>& lsl_inlet_schema() {
  using O = LslInletOptions;
  static const auto schema =
      Schema<O>()
          .text("name", &O::name, "Name of the stream")
          .otherwise("any")
          .text("type", &O::type, "Type of the stream, such as \"EEG\", \"Gaze\" or \"Markers\"")
          .otherwise("any")
          .text("source_id", &O::source_id,
                "Identifier of the instrument behind the stream, for streams of the same name")
          .otherwise("any")
          .custom("quantities", "Quantities of the stream's channels in their order, with units",
                  [](Table& table, const std::string& key, O& o) {
                    o.quantities = read_quantities(table, key);
                  })
          .otherwise("none: the stream sends texts, which become messages")
          .number("rate", &O::rate, {0.0, 20000.0}, "Hz",
                  "Samples a second, as far as known; above 1000 the buffers need it")
          .text("library", &O::library, "File or path of the Lab Streaming Layer's library")
          .check(check_inlet);
  return schema;
}

/// A description of a stream, which is destroyed at the end.
class StreamInfo {
 public:
  StreamInfo(const LslLibrary& lsl, LslLibrary::Info info) : lsl_(lsl), info_(info) {}
  ~StreamInfo() {
    if (info_ != nullptr) {
      lsl_.destroy_streaminfo(info_);
    }
  }
  StreamInfo(const StreamInfo&) = delete;
  StreamInfo& operator=(const StreamInfo&) = delete;
  LslLibrary::Info get() const { return info_; }

 private:
  const LslLibrary& lsl_;
  LslLibrary::Info info_;
};

LslLibrary loaded(const std::string& name) {
  LslLibrary lsl(name);
  lsl.load_inlets();
  return lsl;
}

std::string predicate_of(const LslInletOptions& options) {
  std::string predicate;
  const auto add = [&](const char* property, const std::string& value) {
    if (!value.empty()) {
      predicate += fmt::format("{}{}='{}'", predicate.empty() ? "" : " and ", property, value);
    }
  };
  add("name", options.name);
  add("type", options.type);
  add("source_id", options.source_id);
  return predicate;
}

/// A label as a name of a quantity that no other one has.
std::string name_of_label(std::string label, std::size_t number,
                          const std::vector<Quantity>& others) {
  std::ranges::replace_if(
      label, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  label = label.substr(0, kLongestLabel - 3);
  if (label.empty()) {
    label = fmt::format("channel_{}", number);
  }
  const bool taken = std::ranges::find(others, label, &Quantity::name) != others.end();
  return taken ? fmt::format("{}_{}", label, number) : label;
}

/// An open stream, and its clock against this machine's.
class LslSource final : public ChannelSource {
 public:
  /// @param alone  whether the stream was found to be the only one that fits; it then is
  LslSource(const LslInletOptions& options, bool& alone)
      : lsl_(loaded(options.library)), name_(predicate_of(options)) {
    open_inlet();
    try {
      describe();
      if (!alone) {
        refuse_second();
      }
      check(options.quantities);
      measure_offset(kAnswerFor);
      alone = true;
    } catch (...) {
      lsl_.destroy_inlet(inlet_);
      throw;
    }
  }
  ~LslSource() override { lsl_.destroy_inlet(inlet_); }
  LslSource(const LslSource&) = delete;
  LslSource& operator=(const LslSource&) = delete;

  bool may_be_silent() const override { return text_ || rate_ == 0.0; }
  bool keeps_samples() const override { return true; }

  void read(ChannelInbox& into, milliseconds patience) override {
    if (std::exchange(is_new_, false) || lsl_.local_clock() - looked_ >= kCorrectEvery) {
      follow_offset(into);
    }
    double timeout = 1e-3 * static_cast<double>(patience.count());
    std::optional<Bridge> bridge;
    for (int i = 0; i < kPulledAtOnce; ++i) {
      const double stamp = pull(timeout);
      if (stamp == 0.0) {
        break;
      }
      timeout = 0.0;
      if (!bridge) {
        bridge = bridge_to(into);
      }
      give(into, stamp, *bridge);
    }
  }

 private:
  /// The session's clock against the layer's, at this moment.
  struct Bridge {
    double ahead{0.0};        // of the layer's clock [s]
    double uncertainty{0.0};  // [s]
  };

  /// Opens the stream that answers first.
  void open_inlet() {
    LslLibrary::Info found = nullptr;
    const double began = lsl_.local_clock();
    const std::int32_t count = lsl_.resolve(&found, 1, name_.c_str(), 1, kResolveFor);
    const StreamInfo info(lsl_, found);
    if (count < 1) {
      throw RunError(
          fmt::format("no stream of the Lab Streaming Layer has {}; start it, and check "
                      "that both computers are in one network",
                      name_));
    }
    answered_after_ = lsl_.local_clock() - began;
    // A lost stream is opened anew by the channel, so that its clock is measured anew, too.
    inlet_ = lsl_.create_inlet(info.get(), kInletBuffer, 0, 0);
    if (inlet_ == nullptr) {
      throw RunError(
          fmt::format("the stream with {} cannot be opened: {}", name_, lsl_.last_error()));
    }
  }

  /// Looks for a second stream that fits, while the first one's samples are kept by the layer.
  void refuse_second() const {
    std::array<LslLibrary::Info, 2> found{};
    const std::int32_t count = lsl_.resolve(found.data(), 2, name_.c_str(), 2,
                                            std::min(answered_after_, kWayTakes) + kSecondFor);
    const StreamInfo first(lsl_, found[0]);
    const StreamInfo second(lsl_, found[1]);
    if (count > 1) {
      throw RunError(fmt::format(
          "two streams of the Lab Streaming Layer have {}: '{}' of {} and '{}' of {}; state "
          "source_id or more of name and type",
          name_, lsl_.get_name(first.get()), lsl_.get_host(first.get()),
          lsl_.get_name(second.get()), lsl_.get_host(second.get())));
    }
  }

  void describe() {
    std::int32_t error = 0;
    const StreamInfo info(lsl_, lsl_.get_fullinfo(inlet_, kAnswerFor, &error));
    if (info.get() == nullptr || error != 0) {
      fail(error, "describes itself");
    }
    channels_ = static_cast<std::size_t>(std::max(1, lsl_.get_channel_count(info.get())));
    text_ = lsl_.get_channel_format(info.get()) == stream::kLslText;
    rate_ = lsl_.get_nominal_rate(info.get());
    values_.resize(channels_);
    texts_.resize(channels_);
    if (channels_ > kMostQuantities && !text_) {
      throw RunError(fmt::format("the stream with {} has {} channels; allowed: at most {}", name_,
                                 channels_, kMostQuantities));
    }
    if (!text_) {
      read_quantities_of(info.get());
    }
    lsl_.set_postprocessing(inlet_, kRawStamps);
    lsl_.open_stream(inlet_, kAnswerFor, &error);
    if (error != 0) {
      fail(error, "sends");
    }
  }

  void read_quantities_of(LslLibrary::Info info) {
    LslLibrary::Xml one = lsl_.child(lsl_.child(lsl_.get_desc(info), "channels"), "channel");
    for (std::size_t i = 0; i < channels_; ++i) {
      std::string label;
      std::string unit;
      if (lsl_.is_empty(one) == 0) {
        label = lsl_.child_value(one, "label");
        unit = lsl_.child_value(one, "unit");
        one = lsl_.next_sibling(one, "channel");
      }
      quantities_.push_back({name_of_label(label, i + 1, quantities_), unit.empty() ? "1" : unit});
    }
  }

  void check(const std::vector<Quantity>& expected) const {
    if (expected.size() != quantities_.size()) {
      std::string line;
      for (const Quantity& each : quantities_) {
        line += fmt::format("{}{} = \"{}\"", line.empty() ? "" : ", ", each.name, each.unit);
      }
      throw RunError(fmt::format("the stream with {} has {} quantities, and the definition {}; {}",
                                 name_, quantities_.size(), expected.size(),
                                 text_ ? "it sends texts: remove `quantities`"
                                       : fmt::format("state quantities = {{ {} }}", line)));
    }
  }

  [[noreturn]] void fail(std::int32_t error, const char* what) const {
    throw RunError(error == stream::kLslLost
                       ? fmt::format("the stream with {} is gone", name_)
                       : fmt::format("the stream with {} no longer {}: error {}, {}", name_, what,
                                     error, lsl_.last_error()));
  }

  /// @returns whether the offset is another one than before
  bool measure_offset(double timeout) {
    std::int32_t error = 0;
    double remote = 0.0;
    double uncertainty = 0.0;
    const double offset = lsl_.time_correction(inlet_, &remote, &uncertainty, timeout, &error);
    const double now = lsl_.local_clock();
    looked_ = now;
    if (error != 0 && error != stream::kLslTimeout) {
      fail(error, "tells its clock");
    }
    if (error != 0 || (offset_at_ && remote == remote_)) {
      if (!offset_at_ || now - *offset_at_ > kSilentHost) {
        throw RunError(fmt::format("the sender of the stream with {} no longer answers", name_));
      }
      return false;
    }
    remote_ = remote;
    offset_ = offset;
    uncertainty_ = uncertainty;
    offset_at_ = now;
    return true;
  }

  void follow_offset(ChannelInbox& into) {
    const std::optional<double> before_at = told_at_;
    const double before = offset_;
    const double allowed = uncertainty_;
    if (!measure_offset(0.0) && told_at_) {
      return;
    }
    told_at_ = offset_at_;
    const Bridge bridge = bridge_to(into);
    into.note(Incident::kClockOffset, offset_ - bridge.ahead,
              fmt::format("within {:.6f} s; the layer measured {:.6f} s",
                          uncertainty_ + bridge.uncertainty, offset_));
    const double jump = before - offset_;
    if (before_at && std::abs(jump) > kLeastJump + allowed + uncertainty_ +
                                          kHostDrift * (*offset_at_ - *before_at)) {
      into.note(Incident::kClockStep, jump, "the sender's clock, or the way to it, is another one");
    }
  }

  /// The closest of a few readings: an interruption of one does not interrupt them all.
  Bridge bridge_to(const ChannelInbox& into) const {
    constexpr int kReadings = 3;
    Bridge best{0.0, std::numeric_limits<double>::infinity()};
    for (int i = 0; i < kReadings; ++i) {
      const std::int64_t before = into.now();
      const double layer = lsl_.local_clock();
      const std::int64_t after = into.now();
      const double half = 0.5e-9 * static_cast<double>(after - before);
      if (half < best.uncertainty) {
        best = {layer - (1e-9 * static_cast<double>(before) + half), half};
      }
    }
    return best;
  }

  /// Waits for the next sample. @returns its stamp; 0: none came
  double pull(double timeout) {
    std::int32_t error = 0;
    const auto room = static_cast<std::int32_t>(channels_);
    const double stamp = text_ ? lsl_.pull_texts(inlet_, texts_.data(), room, timeout, &error)
                               : lsl_.pull_sample(inlet_, values_.data(), room, timeout, &error);
    if (error != 0 && error != stream::kLslTimeout) {
      fail(error, "sends");
    }
    return error == 0 ? stamp : 0.0;
  }

  /// Hands on a sample that pull() has brought.
  void give(ChannelInbox& into, double stamp, const Bridge& bridge) {
    const double session = stamp + offset_ - bridge.ahead;
    SampleTime time;
    time.time_ns = std::llround(1e9 * session);
    time.uncertainty = uncertainty_ + bridge.uncertainty + kHostDrift * std::abs(stamp - remote_);
    if (!text_) {
      InstrumentSample sample;
      sample.values = values_;
      sample.device_time = stamp;
      sample.time = time;
      into.take(sample);
      return;
    }
    std::string all;
    for (char*& each : texts_) {
      all += fmt::format("{}{}", all.empty() ? "" : "\t", each);
      lsl_.destroy_text(std::exchange(each, nullptr));
    }
    into.note(Incident::kMessage, time.uncertainty, all, time.time_ns);
  }

  LslLibrary lsl_;
  std::string name_;  // the predicate that finds it
  LslLibrary::Inlet inlet_{nullptr};
  double answered_after_{0.0};  // time until the stream was found [s]
  std::size_t channels_{1};
  bool text_{false};
  double rate_{0.0};                  // 0: irregular [Hz]
  std::vector<Quantity> quantities_;  // by the stream's own description
  std::vector<double> values_;
  std::vector<char*> texts_;

  double offset_{0.0};               // what the layer adds to stamps to get its clock here [s]
  double uncertainty_{0.0};          // of that [s]
  double remote_{0.0};               // sender's time at which it was measured [s]
  std::optional<double> offset_at_;  // when a new one came, on the layer's clock [s]
  std::optional<double> told_at_;    // `offset_at_` of the one that was noted last
  double looked_{0.0};               // when it was asked for, last
  bool is_new_{true};
};

}  // namespace

ChannelKind lsl_channel() {
  return {"lsl", "a stream of the Lab Streaming Layer", [](Table& table) {
            const LslInletOptions options = lsl_inlet_schema().read(table);
            ChannelPlan plan;
            plan.quantities = options.quantities;
            plan.rate = options.rate;
            // One that is back is there at once.
            plan.open = [options, alone = std::make_shared<bool>(false)] {
              return std::make_unique<LslSource>(options, *alone);
            };
            return plan;
          }};
}

}  // namespace haptrial::channel
