#include "experiments/screen/screen.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <future>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/base/exception_words.h"
#include "core/realtime/histogram.h"
#include "core/realtime/latest_value.h"
#include "core/render/gl/image.h"
#include "experiments/screen/frame_pacing.h"
#include "experiments/screen/participant_canvas.h"
#include "experiments/screen/speaker.h"

namespace haptrial::experiments {
namespace {

render::WindowOptions window_options(const protocols::ScreenOptions& options,
                                     const render::TrialDisplayStyle& style) {
  return {options.title,       style.width,     style.height,
          options.full_screen, options.monitor, options.refresh_lock};
}

render::TrialDisplayStyle fitted(render::TrialDisplayStyle style, const render::Window& window) {
  style.width = window.width();
  style.height = window.height();
  if (!style.leaves_room()) {
    throw InputError(fmt::format(
        "the screen has {} x {} pixels, which leaves no room for the path beside bars of {} and "
        "margins of {} pixels; use a larger screen or smaller values in [display]",
        style.width, style.height, style.bar_height, style.margin));
  }
  return style;
}

}  // namespace

std::optional<Request> request_of(const render::KeyPress& press) {
  switch (press.key) {
    case render::KeyPress::kEscape:
      return Request::kEmergencyStop;
    case render::KeyPress::kSpace:
    case render::KeyPress::kEnter:
      return Request::kStart;
    case 'P':
      return Request::kPause;
    case 'R':
      return Request::kRepeatTrial;
    case 'S':
      return Request::kSkipTrial;
    case 'C':
      return Request::kClear;
    default:
      return std::nullopt;
  }
}

struct Screen::Impl {
  protocols::ScreenOptions options;
  render::TrialDisplayStyle style;
  ScreenCallbacks callbacks;
  SessionMark mark;
  std::promise<void> opened;  // outlives set_value(), which a local one might not
  std::thread thread;
  std::atomic<bool> stop{false};

  realtime::LatestValue<stimulus::Shown> shown;  // servo thread -> screen's
  std::atomic<std::int64_t> first_tick_ns{0};    // 0: none yet
  std::atomic<std::uint64_t> version_shown{0};   // of the scene, in a picture that was shown
  std::atomic<const markers::OnsetLog*> onsets{nullptr};

  std::mutex speaker_mutex;
  Speaker* speaker{nullptr};

  mutable std::mutex mutex;  // all below
  Scene scene;
  std::vector<record::FrameRow> frames;
  std::int64_t frame_count{0};
  std::vector<Flash> flashes;
  ScreenSummary summary;
  realtime::DurationHistogram draw_times;
  std::string trouble;
  bool picture_asked{false};
  std::optional<render::Image> picture;
  std::condition_variable picture_taken;

  void run();
  void show_pictures(render::Window& window, ParticipantCanvas& canvas, const AgreedPace& agreed);
  bool take_scene(ParticipantCanvas& canvas);
  void give_picture(render::Window& window);
  void speak(const ParticipantCanvas& canvas, const stimulus::Shown& seen,
             const std::string& words);
  bool says_again(const render::KeyPress& press);
  void count(const record::FrameRow& frame, std::uint64_t flashed);
  std::uint64_t onsets_so_far() const;
};

namespace {

/// Events at a window, told once: keys, held keys, the pointer, the close button.
class WindowEvents {
 public:
  /// @param takes  a key that is nobody else's
  WindowEvents(render::Window& window, const ScreenCallbacks& callbacks,
               std::function<bool(const render::KeyPress&)> takes)
      : window_(window),
        callbacks_(callbacks),
        takes_(std::move(takes)),
        pointer_(window.pointer()),
        pad_(window.width(), window.height()) {}

  /// @param other_view  the view moved under the pointer
  void tell(ParticipantCanvas& canvas, bool other_view) {
    tell_keys(canvas);
    const std::int64_t now = screen_ns();
    const double dt = told_ns_ != 0 ? 1e-9 * static_cast<double>(now - told_ns_) : 0.0;
    told_ns_ = now;
    const device::GamepadState pad = callbacks_.pad ? callbacks_.pad() : device::GamepadState{};
    const render::Pointer at = callbacks_.pad ? pad_.moved(pad, dt) : window_.pointer();
    const bool moved = std::exchange(pointer_, at) != pointer_;
    if (callbacks_.pointer) {
      const ScreenPointer pointer =
          canvas.pointer({at.position, at.wheel, at.buttons, held_, dt, pad.turn});
      if (moved || other_view || pointer.hand) {
        callbacks_.pointer(pointer);
      }
    }
    if (window_.close_asked() && !std::exchange(closed_, true) && callbacks_.closed) {
      callbacks_.closed();
    }
  }

 private:
  void tell_keys(ParticipantCanvas& canvas) {
    std::vector<int> held = window_.held_keys();
    for (const render::KeyPress& press : window_.take_keys()) {
      if (takes_(press)) {
        continue;
      }
      if (callbacks_.key) {
        callbacks_.key(press);
      }
      const bool typed = press.character != 0;
      if (!typed) {
        canvas.pressed(press.key);
      }
      if (!typed && std::find(held.begin(), held.end(), press.key) == held.end()) {
        held.push_back(press.key);  // let go again already: held for a picture all the same
      }
    }
    if (std::exchange(held_, held) != held && callbacks_.held) {
      callbacks_.held(held_);
    }
  }

  render::Window& window_;
  const ScreenCallbacks& callbacks_;
  std::function<bool(const render::KeyPress&)> takes_;
  render::Pointer pointer_;
  PadPointer pad_;
  std::vector<int> held_;
  std::int64_t told_ns_{0};
  bool closed_{false};
};

}  // namespace

void Screen::Impl::run() {
  bool open = false;
  try {
    render::Window window(window_options(options, style));
    ParticipantCanvas canvas(window, fitted(style, window), options, mark);
    const AgreedPace agreed =
        agreed_pace(options.refresh_lock, window.refresh_rate(), canvas.probe(), kTimerRate);
    {
      const std::lock_guard lock(mutex);
      summary.rate = agreed.rate;
      summary.refresh_locked = agreed.refresh_locked;
      summary.notice = agreed.notice;
    }
    open = true;
    opened.set_value();
    show_pictures(window, canvas, agreed);
  } catch (const std::exception& error) {
    if (!open) {
      opened.set_exception(std::current_exception());
      return;
    }
    {
      const std::lock_guard lock(mutex);
      trouble = fmt::format("the screen has stopped: {}", sentence_of(error));
    }
    if (callbacks.closed) {
      callbacks.closed();
    }
  }
}

void Screen::Impl::show_pictures(render::Window& window, ParticipantCanvas& canvas,
                                 const AgreedPace& agreed) {
  Pace pace(agreed);
  WindowEvents happenings(window, callbacks,
                          [this](const render::KeyPress& press) { return says_again(press); });
  stimulus::Shown seen;
  while (!stop.load(std::memory_order_relaxed)) {
    pace.wait();
    const std::int64_t start = screen_ns();
    const bool other_view = take_scene(canvas);
    shown.read(seen);
    const std::uint64_t flashed = canvas.flash(onsets_so_far());  // after what they belong to
    const std::string words = callbacks.words ? callbacks.words() : "";
    canvas.draw(seen, words);
    give_picture(window);
    const std::int64_t drawn = screen_ns();
    window.swap();
    version_shown.store(canvas.version(), std::memory_order_release);
    count(pace.shown(drawn - start), flashed);
    speak(canvas, seen, words);
    window.poll();
    happenings.tell(canvas, other_view);
  }
}

bool Screen::Impl::take_scene(ParticipantCanvas& canvas) {
  const std::lock_guard lock(mutex);
  return canvas.take(scene);
}

void Screen::Impl::give_picture(render::Window& window) {
  const std::lock_guard lock(mutex);
  if (std::exchange(picture_asked, false)) {
    picture = window.read();
    picture_taken.notify_all();
  }
}

/// Words of a picture that is in the window.
void Screen::Impl::speak(const ParticipantCanvas& canvas, const stimulus::Shown& seen,
                         const std::string& words) {
  const std::lock_guard lock(speaker_mutex);
  if (speaker != nullptr) {
    speaker->follow(canvas.text(seen), words);
  }
}

bool Screen::Impl::says_again(const render::KeyPress& press) {
  const std::lock_guard lock(speaker_mutex);
  const bool again = speaker != nullptr && press.key == Speaker::kRepeatKey;
  if (again) {
    speaker->repeat();
  }
  return again;
}

std::uint64_t Screen::Impl::onsets_so_far() const {
  const markers::OnsetLog* log = onsets.load(std::memory_order_acquire);
  return log != nullptr ? log->count() : 0;
}

void Screen::Impl::count(const record::FrameRow& frame, std::uint64_t flashed) {
  const std::int64_t first = first_tick_ns.load(std::memory_order_relaxed);
  const std::lock_guard lock(mutex);
  ++summary.frames;
  summary.dropped += static_cast<std::uint64_t>(frame.dropped);
  draw_times.add(frame.frame_time_ns);
  if (first != 0 && frame.time_ns >= first) {
    frames.push_back({frame.time_ns - first, frame.frame_time_ns, frame.dropped});
    if (flashed > 0) {
      flashes.push_back({flashed, frame_count, frame.time_ns - first});
    }
    ++frame_count;
  }
}

Screen::Screen(const protocols::ScreenOptions& options, const render::TrialDisplayStyle& style,
               ScreenCallbacks callbacks, const SessionMark& mark)
    : impl_(std::make_unique<Impl>()) {
  impl_->options = options;
  impl_->style = style;
  impl_->callbacks = std::move(callbacks);
  impl_->mark = mark;
  std::future<void> result = impl_->opened.get_future();
  impl_->thread = std::thread([this] { impl_->run(); });
  try {
    result.get();
  } catch (...) {
    impl_->thread.join();
    throw;
  }
}

Screen::~Screen() {
  impl_->stop.store(true, std::memory_order_relaxed);
  impl_->thread.join();
}

void Screen::show_text(render::TextPage page) {
  const std::lock_guard lock(impl_->mutex);
  impl_->scene = {impl_->scene.version + 1, {}, std::move(page), ScreenClock::now()};
}

std::uint64_t Screen::show(protocols::MakeDrawing make) {
  const std::lock_guard lock(impl_->mutex);
  impl_->scene = {impl_->scene.version + 1, std::move(make), {}, {}};
  return impl_->scene.version;
}

bool Screen::has_shown(std::uint64_t number) const noexcept {
  return impl_->version_shown.load(std::memory_order_acquire) >= number;
}

void Screen::observe(const stimulus::Shown& shown, const stimulus::Forces&, double) noexcept {
  if (impl_->first_tick_ns.load(std::memory_order_relaxed) == 0) {
    impl_->first_tick_ns.store(screen_ns(), std::memory_order_relaxed);
  }
  impl_->shown.write(shown);
}

std::vector<record::FrameRow> Screen::take_frames() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->frames, {});
}

void Screen::flash_with(const markers::OnsetLog* log) {
  impl_->onsets.store(log, std::memory_order_release);
}

void Screen::speak_with(Speaker* speaker) {
  const std::lock_guard lock(impl_->speaker_mutex);
  impl_->speaker = speaker;
}

std::vector<Flash> Screen::take_flashes() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->flashes, {});
}

ScreenSummary Screen::summary() const {
  const std::lock_guard lock(impl_->mutex);
  ScreenSummary summary = impl_->summary;
  if (impl_->draw_times.count() > 0) {
    summary.draw_median_ms = 1e-6 * impl_->draw_times.percentile(50.0);
    summary.draw_worst_ms = 1e-6 * impl_->draw_times.max();
  }
  return summary;
}

std::string Screen::trouble() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->trouble;
}

render::Image Screen::screenshot() {
  std::unique_lock lock(impl_->mutex);
  impl_->picture.reset();
  impl_->picture_asked = true;
  constexpr std::chrono::seconds kLongest{2};
  if (!impl_->picture_taken.wait_for(lock, kLongest,
                                     [this] { return impl_->picture.has_value(); })) {
    throw RunError(impl_->trouble.empty() ? "the screen showed no picture for two seconds"
                                          : impl_->trouble);
  }
  return std::move(*std::exchange(impl_->picture, std::nullopt));
}

std::string ScreenMirror::picture() {
  const std::lock_guard lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (picture_.empty() || now - taken_ >= kPeriod) {
    const render::Image image = screen_.screenshot();
    const int times = (image.width + kWidth - 1) / kWidth;
    picture_ = render::png_bytes(render::coarser(image, times));
    taken_ = now;
  }
  return picture_;
}

}  // namespace haptrial::experiments
