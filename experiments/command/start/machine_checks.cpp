#include "experiments/command/start/machine_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <thread>

#include "core/base/exception_words.h"
#include "core/base/whole_file.h"
#include "core/device/catalog.h"
#include "core/realtime/servo_loop.h"
#include "core/render/gl/offscreen.h"
#include "core/render/gl/window.h"
#include "core/sound/card_player.h"
#include "core/stream/lsl_outlet.h"
#include "experiments/screen/video.h"

namespace haptrial::experiments {
namespace {

using State = MachineCheck::State;

class CountedTicks final : public realtime::ServoTask {
 public:
  explicit CountedTicks(double count) : left_(static_cast<int>(count)) {}
  bool tick(const realtime::Tick&) noexcept override { return --left_ > 0; }

 private:
  int left_;
};

/// @returns the sentence of what `check` throws; empty if it does not
template <class Check>
std::string refusal_of(Check&& check) {
  try {
    check();
  } catch (const std::exception& error) {
    return sentence_of(error);
  }
  return "";
}

MachineCheck ready_unless(const char* what, const std::string& refusal, State otherwise,
                          const char* ready) {
  return refusal.empty() ? MachineCheck{what, State::kReady, ready}
                         : MachineCheck{what, otherwise, refusal};
}

}  // namespace

const char* name_of(MachineCheck::State state) {
  switch (state) {
    case State::kReady:
      return "ready";
    case State::kLimited:
      return "limited";
    case State::kAbsent:
      return "absent";
    case State::kUnused:
      return "unused";
    case State::kBroken:
      break;
  }
  return "BROKEN";
}

MachineCheck check_clock(double seconds, double rate) {
  realtime::ServoLoop loop(realtime::ClockKind::kReal, rate);
  CountedTicks task(seconds * rate);
  loop.run(task);
  const realtime::LoopTiming& timing = loop.timing();
  const bool good = loop.overruns() == 0;
  return {"clock", good ? State::kReady : State::kLimited,
          fmt::format("{} ticks at {:g} kHz on {} processors: 99.9 % at most {:.0f} µs late, the "
                      "latest {:.0f} µs, {} overruns{}",
                      loop.ticks(), 1e-3 * rate, std::thread::hardware_concurrency(),
                      1e-3 * timing.lateness.percentile(99.9), 1e-3 * timing.lateness.max(),
                      loop.overruns(), good ? "" : "; close other programs and try again")};
}

MachineCheck check_real_time() {
  const realtime::RealTimeScope scope;
  const realtime::RealTimeStatus& status = scope.status();
  return status.notice.empty()
             ? MachineCheck{"real time", State::kReady, "granted, and memory stays in place"}
             : MachineCheck{"real time", State::kLimited, status.notice};
}

MachineCheck check_off_screen() {
  const std::string refusal = refusal_of([] { render::OffscreenContext(64, 64).read(); });
  return ready_unless("pictures", refusal, State::kBroken, "drawn off screen, by the processor");
}

MachineCheck check_window() {
  const std::string refusal = refusal_of([] { render::Window({.width = 64, .height = 64}); });
  return ready_unless("window", refusal, State::kLimited, "opens, with OpenGL 3.3");
}

MachineCheck check_sound() {
  const std::string refusal = refusal_of([] {
    const sound::CardPlayer player("default",
                                   [](std::span<float> part) { std::ranges::fill(part, 0.0F); });
  });
  return ready_unless("sound", refusal, State::kLimited, "ALSA's card 'default' opens");
}

MachineCheck check_video() {
  constexpr int kPicturesASecond = 30;
  const std::string refusal = refusal_of([] {  // nothing is left of a video without a picture
    VideoWriter(std::filesystem::temp_directory_path() / "haptrial-doctor.mp4", kPicturesASecond);
  });
  return ready_unless("video", refusal, State::kLimited, "ffmpeg is there");
}

MachineCheck check_stream() {
  const std::string refusal = refusal_of([] { stream::LslOutlet::check_library(); });
  return ready_unless("stream", refusal, State::kLimited, "the Lab Streaming Layer is there");
}

std::vector<MachineCheck> check_devices() {
  std::vector<MachineCheck> checks;
  for (const device::DeviceListing& listing : device::list_devices()) {
    checks.push_back(
        {listing.name, listing.available ? State::kReady : State::kAbsent, listing.what});
  }
  return checks;
}

MachineCheck check_disk(const std::filesystem::path& folder) {
  constexpr double kGigabyte = 1e9;
  constexpr double kLittle = 1.0;  // [GB]: a session of an hour needs some hundred MB
  const std::filesystem::path probe = folder / ".haptrial-doctor";
  const std::string refusal = refusal_of([&] { write_whole(probe, "x"); });
  std::error_code error;
  std::filesystem::remove(probe, error);
  if (!refusal.empty()) {
    return {"disk", State::kBroken, refusal};
  }
  const auto space = std::filesystem::space(folder, error);
  const double free = error ? 0.0 : static_cast<double>(space.available) / kGigabyte;
  return {"disk", free < kLittle ? State::kLimited : State::kReady,
          fmt::format("{} can be written; {:.1f} GB are free",
                      std::filesystem::weakly_canonical(folder).string(), free)};
}

}  // namespace haptrial::experiments
