#include "core/stream/lsl_outlet.h"

#include <fmt/format.h>

#include <array>
#include <exception>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/exception_words.h"
#include "core/stream/lsl_library.h"

namespace haptrial::stream {
namespace {

constexpr double kIrregular = 0.0;          // rate of a stream without one
constexpr std::int32_t kChunkAsPushed = 0;  // samples are sent on as they were pushed
constexpr std::int32_t kBuffered = 360;     // kept for who listens late or slowly [s]

constexpr std::array<LslOutlet::Channel, 15> kChannels{{
    {"sequence", "1", "Counter"},
    {"position_x", "m", "Position"},
    {"position_y", "m", "Position"},
    {"position_z", "m", "Position"},
    {"velocity_x", "m/s", "Velocity"},
    {"velocity_y", "m/s", "Velocity"},
    {"velocity_z", "m/s", "Velocity"},
    {"force_x", "N", "Force"},
    {"force_y", "N", "Force"},
    {"force_z", "N", "Force"},
    {"applied_force", "N", "Force"},
    {"target_force", "N", "Force"},
    {"pass", "1", "Counter"},
    {"stage", "1", "State"},
    {"saturated", "1", "State"},
}};

void append(const record::Sample& s, std::vector<double>& values) {
  values.push_back(static_cast<double>(s.sequence));
  for (const Eigen::Vector3d* vector : {&s.position, &s.velocity, &s.force}) {
    values.insert(values.end(), vector->begin(), vector->end());
  }
  values.insert(values.end(), {s.applied_force, s.target_force, static_cast<double>(s.pass),
                               static_cast<double>(s.stage), s.saturated ? 1.0 : 0.0});
}

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

}  // namespace

struct LslOutlet::Impl {
  Impl(const LslOptions& o, SessionClock clock)
      : options(o), now(std::move(clock)), lsl(o.library) {}
  ~Impl() {
    std::vector<LslLibrary::Outlet> all{samples, markers};
    all.insert(all.end(), sides.begin(), sides.end());
    for (const LslLibrary::Outlet outlet : all) {
      if (outlet != nullptr) {
        lsl.destroy_outlet(outlet);
      }
    }
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  LslLibrary::Outlet open_samples();
  LslLibrary::Outlet open_markers();
  LslLibrary::Outlet open_side(const SideStream& side);
  LslLibrary::Outlet opened(LslLibrary::Info info, const std::string& name);
  void describe(LslLibrary::Info info);
  void synchronise();
  void note(std::int32_t result, std::size_t count);

  LslOptions options;
  SessionClock now;
  LslLibrary lsl;
  LslLibrary::Outlet samples{nullptr};
  LslLibrary::Outlet markers{nullptr};
  std::vector<LslLibrary::Outlet> sides;
  double offset{0.0};                    // of the layer's clock from the session's [s]
  std::optional<std::int64_t> measured;  // when the samples' offset was, on the session's clock
  std::vector<double> values;
  std::vector<double> timestamps;
  std::uint64_t refused{0};
  std::string first_refusal;
  mutable std::mutex mutex;  // all of it, once the streams are open
};

/// The closest of a few readings: whatever interrupts one of them does not interrupt them all.
void LslOutlet::Impl::synchronise() {
  constexpr int kReadings = 5;
  double closest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kReadings; ++i) {
    const double before = seconds(now());
    const double layer = lsl.local_clock();
    const double after = seconds(now());
    if (after - before < closest) {
      closest = after - before;
      offset = layer - 0.5 * (before + after);
    }
  }
}

void LslOutlet::Impl::describe(LslLibrary::Info info) {
  const LslLibrary::Xml about = lsl.get_desc(info);
  lsl.append_child_value(about, "study", options.study.c_str());
  lsl.append_child_value(about, "subject", options.subject.c_str());
  lsl.append_child_value(about, "device", options.device.c_str());
  lsl.append_child_value(about, "simulated", options.simulated ? "true" : "false");
}

/// An outlet keeps a copy of its description, which is ours to destroy.
LslLibrary::Outlet LslOutlet::Impl::opened(LslLibrary::Info info, const std::string& name) {
  const LslLibrary::Outlet outlet = lsl.create_outlet(info, kChunkAsPushed, kBuffered);
  lsl.destroy_streaminfo(info);
  if (outlet == nullptr) {
    throw RunError(
        fmt::format("the Lab Streaming Layer opens no stream '{}': {}", name, lsl.last_error()));
  }
  return outlet;
}

LslLibrary::Outlet LslOutlet::Impl::open_samples() {
  const std::string name = "haptrial " + options.subject;
  const LslLibrary::Info info = lsl.create_streaminfo(
      name.c_str(), "Haptics", static_cast<std::int32_t>(kChannels.size()), options.rate,
      kLslDouble, fmt::format("haptrial-{}-{}-samples", options.study, options.subject).c_str());
  if (info == nullptr) {
    throw RunError(fmt::format("the Lab Streaming Layer takes no description of '{}': {}", name,
                               lsl.last_error()));
  }
  describe(info);
  const LslLibrary::Xml list = lsl.append_child(lsl.get_desc(info), "channels");
  for (const Channel& channel : kChannels) {
    const LslLibrary::Xml one = lsl.append_child(list, "channel");
    lsl.append_child_value(one, "label", channel.label);
    lsl.append_child_value(one, "unit", channel.unit);
    lsl.append_child_value(one, "type", channel.type);
  }
  return opened(info, name);
}

LslLibrary::Outlet LslOutlet::Impl::open_markers() {
  const std::string name = "haptrial " + options.subject + " markers";
  const LslLibrary::Info info = lsl.create_streaminfo(
      name.c_str(), "Markers", 1, kIrregular, kLslText,
      fmt::format("haptrial-{}-{}-markers", options.study, options.subject).c_str());
  if (info == nullptr) {
    throw RunError(fmt::format("the Lab Streaming Layer takes no description of '{}': {}", name,
                               lsl.last_error()));
  }
  describe(info);
  return opened(info, name);
}

LslLibrary::Outlet LslOutlet::Impl::open_side(const SideStream& side) {
  const std::string name = fmt::format("haptrial {} {}", options.subject, side.name);
  const LslLibrary::Info info = lsl.create_streaminfo(
      name.c_str(), side.type.c_str(), static_cast<std::int32_t>(side.channels.size()),
      side.rate > 0.0 ? side.rate : kIrregular, kLslDouble,
      fmt::format("haptrial-{}-{}-{}", options.study, options.subject, side.name).c_str());
  if (info == nullptr) {
    throw RunError(fmt::format("the Lab Streaming Layer takes no description of '{}': {}", name,
                               lsl.last_error()));
  }
  describe(info);
  for (const auto& [line, value] : side.about) {
    lsl.append_child_value(lsl.get_desc(info), line.c_str(), value.c_str());
  }
  const LslLibrary::Xml list = lsl.append_child(lsl.get_desc(info), "channels");
  for (const std::string& channel : side.channels) {
    const LslLibrary::Xml one = lsl.append_child(list, "channel");
    lsl.append_child_value(one, "label", channel.c_str());
    lsl.append_child_value(one, "unit", side.unit.c_str());
    lsl.append_child_value(one, "type", side.type.c_str());
  }
  return opened(info, name);
}

void LslOutlet::Impl::note(std::int32_t result, std::size_t count) {
  if (result != 0) {
    if (refused == 0) {
      first_refusal = fmt::format("error {}: {}", result, lsl.last_error());
    }
    refused += count;
  }
}

std::span<const LslOutlet::Channel> LslOutlet::channels() { return kChannels; }

void LslOutlet::check_library(const std::string& library) { const LslLibrary needed(library); }

LslOutlet::LslOutlet(const LslOptions& options, SessionClock now)
    : impl_(std::make_unique<Impl>(options, std::move(now))) {
  impl_->samples = impl_->open_samples();
  impl_->markers = impl_->open_markers();
  for (const SideStream& side : impl_->options.sides) {
    impl_->sides.push_back(impl_->open_side(side));
  }
}

LslOutlet::~LslOutlet() = default;

std::unique_ptr<LslOutlet> LslOutlet::open(const LslOptions& options, SessionClock now,
                                           std::string& notice) {
  try {
    return std::make_unique<LslOutlet>(options, std::move(now));
  } catch (const std::exception& error) {
    notice = fmt::format("{}; the session continues without its streams", sentence_of(error));
    return nullptr;
  }
}

void LslOutlet::push(std::span<const record::Sample> samples) {
  if (samples.empty()) {
    return;
  }
  const std::lock_guard lock(impl_->mutex);
  constexpr std::int64_t kEvery = 1'000'000'000;
  if (!impl_->measured || samples.back().time_ns - *impl_->measured >= kEvery) {
    impl_->synchronise();
    impl_->measured = samples.back().time_ns;
  }
  impl_->values.clear();
  impl_->timestamps.clear();
  for (const record::Sample& sample : samples) {
    append(sample, impl_->values);
    impl_->timestamps.push_back(impl_->offset + seconds(sample.time_ns));
  }
  impl_->note(impl_->lsl.push_chunk(impl_->samples, impl_->values.data(), impl_->values.size(),
                                    impl_->timestamps.data()),
              samples.size());
}

void LslOutlet::push_side(std::size_t number, std::span<const double> values,
                          std::span<const double> times) {
  if (times.empty() || number >= impl_->sides.size()) {
    return;
  }
  const std::lock_guard lock(impl_->mutex);
  if (!impl_->measured) {
    impl_->synchronise();
  }
  impl_->timestamps.clear();
  for (const double time : times) {
    impl_->timestamps.push_back(impl_->offset + time);
  }
  impl_->note(impl_->lsl.push_chunk(impl_->sides[number], values.data(), values.size(),
                                    impl_->timestamps.data()),
              times.size());
}

bool LslOutlet::mark(const std::string& text, std::int64_t session_ns) {
  const std::lock_guard lock(impl_->mutex);
  impl_->synchronise();  // a session's clock stands before its first tick
  const char* marker = text.c_str();
  const std::int32_t result =
      impl_->lsl.push_text(impl_->markers, &marker, impl_->offset + seconds(session_ns));
  impl_->note(result, 1);
  return result == 0;
}

std::uint64_t LslOutlet::refused() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->refused;
}

std::string LslOutlet::first_refusal() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->first_refusal;
}

}  // namespace haptrial::stream
