#include "experiments/screen/screen.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <future>
#include <mutex>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/realtime/histogram.h"
#include "core/realtime/latest_value.h"
#include "core/render/flat/painter.h"
#include "core/render/trial/trial_display.h"

namespace haptrial::experiments {
namespace {

using Clock = std::chrono::steady_clock;  // CLOCK_MONOTONIC, as the servo loop's

constexpr double kPatchSide = 0.06;  // of the photodiode's square, of the screen's shorter side
constexpr std::size_t kProbes = 12;  // pictures by which the display's pace is known
constexpr double kPaceTolerance = 0.25;

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch())
      .count();
}

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

/// What the session's thread asks to be shown.
struct Scene {
  std::uint64_t version{0};
  protocols::MakeDrawing make;  // empty: the page
  render::TextPage page;
  Clock::time_point shown;  // when the page was asked for
};

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
  std::promise<void> opened;  // outlives set_value(), which a local one might not
  std::thread thread;
  std::atomic<bool> stop{false};

  realtime::LatestValue<stimulus::Shown> shown;  // servo thread -> screen's
  std::atomic<std::int64_t> first_tick_ns{0};    // 0: none yet
  std::atomic<const markers::OnsetLog*> onsets{nullptr};

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
  void count(const record::FrameRow& frame, std::uint64_t flashed);
  std::uint64_t onsets_so_far() const;
};

namespace {

/// Decides when the next picture is due, and which refreshes passed without one.
class Pace {
 public:
  explicit Pace(double rate, bool locked)
      : period_ns_(1e9 / rate),
        locked_(locked),
        last_(now_ns()),
        due_(static_cast<double>(last_)) {}

  /// Before a picture is drawn; returns at once where the swap waits for the refresh.
  void wait() {
    if (locked_) {
      return;
    }
    due_ += period_ns_;
    const auto now = static_cast<double>(now_ns());
    if (now > due_) {  // too late for this one: on to the next in step
      const double missed = std::ceil((now - due_) / period_ns_);
      due_ += missed * period_ns_;
      missed_ += static_cast<std::int32_t>(missed);
    }
    std::this_thread::sleep_until(
        Clock::time_point(std::chrono::nanoseconds(static_cast<std::int64_t>(due_))));
  }

  /// When the display has a picture.
  record::FrameRow shown(std::int64_t draw_ns) {
    const std::int64_t now = now_ns();
    const std::int64_t since = now - std::exchange(last_, now);
    if (locked_) {  // pictures come at refreshes, so that their distance tells
      const auto refreshes = std::lround(static_cast<double>(since) / period_ns_);
      missed_ = static_cast<std::int32_t>(std::max(0L, refreshes - 1));
    }
    return {now, draw_ns, std::exchange(missed_, 0)};
  }

 private:
  double period_ns_;
  bool locked_;
  std::int64_t last_;
  double due_;
  std::int32_t missed_{0};  // before the next picture
};

/// Draws the pictures; lives on the screen's thread.
class Easel {
 public:
  Easel(render::Window& window, const render::TrialDisplayStyle& style,
        const protocols::ScreenOptions& options)
      : window_(window),
        style_(style),
        photodiode_(options.photodiode),
        flash_time_(options.photodiode_time),
        trial_(window.gl(), style, style.width, style.height),
        text_(window.gl(), style.width, style.height, style.background, style.marker_colour,
              style.target_colour),
        patch_(window.gl(), style.width, style.height) {}

  /// @returns whether it is another one than before.
  bool take(const Scene& scene) {
    if (scene.version == scene_.version) {
      return false;
    }
    scene_ = scene;
    if (drawing_) {
      before_ = std::move(drawing_);
    }
    drawing_ = scene_.make ? scene_.make(window_.gl(), style_.width, style_.height) : nullptr;
    return true;
  }

  void draw(const stimulus::Shown& shown) {
    if (drawing_) {
      drawing_->draw(shown);
    } else {
      render::TextPage page = scene_.page;
      if (page.countdown) {
        const double gone = std::chrono::duration<double>(Clock::now() - scene_.shown).count();
        page.countdown = std::max(0.0, *page.countdown - gone);
      }
      text_.draw(page);
    }
    ++frames_;
    draw_patch(shown);
  }

  /// The square is white from this frame on. @returns the onsets that it shows first; 0: no new
  /// ones
  std::uint64_t flash(std::uint64_t onsets) {
    if (photodiode_ != protocols::Photodiode::kOnset || onsets == onsets_) {
      return 0;
    }
    onsets_ = onsets;
    white_until_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(flash_time_);
    return onsets;
  }

  /// How fast the display takes pictures [s]; shows empty ones.
  double probe() {
    std::array<double, kProbes> intervals{};
    for (double& interval : intervals) {
      const auto start = Clock::now();
      trial_.draw({});
      window_.swap();
      window_.poll();
      interval = std::chrono::duration<double>(Clock::now() - start).count();
    }
    const auto middle = intervals.begin() + kProbes / 2;
    std::nth_element(intervals.begin(), middle, intervals.end());
    return *middle;
  }

  ScreenPointer pointer() const {
    const render::Pointer p = window_.pointer();
    const protocols::Drawing* drawing = drawing_ ? drawing_.get() : before_.get();
    const auto seen = drawing != nullptr ? drawing->to_world(p.position) : std::nullopt;
    const Eigen::Vector3d point = seen.value_or(trial_.to_world(p.position));
    return {point.x(), point.z(), p.wheel, p.buttons};
  }

 private:
  void draw_patch(const stimulus::Shown& shown) {
    if (photodiode_ == protocols::Photodiode::kOff) {
      return;
    }
    const bool runs = drawing_ != nullptr && shown.engaged();
    const bool white = photodiode_ == protocols::Photodiode::kRun     ? runs
                       : photodiode_ == protocols::Photodiode::kOnset ? Clock::now() < white_until_
                                                                      : frames_ % 2 == 0;
    const double side = std::round(kPatchSide * std::min(style_.width, style_.height));
    const double shade = white ? 1.0 : 0.0;
    patch_.begin_over();
    patch_.fill({{0.0, style_.height - side}, {side, static_cast<double>(style_.height)}}, 0.0,
                render::Colour{shade, shade, shade});
    patch_.end();
  }

  render::Window& window_;
  render::TrialDisplayStyle style_;
  protocols::Photodiode photodiode_;
  std::chrono::duration<double> flash_time_;
  Clock::time_point white_until_{};
  std::uint64_t onsets_{0};     // that were shown
  render::TrialDisplay trial_;  // where a pointer is while no drawing says it
  render::TextScreen text_;
  render::Painter patch_;
  Scene scene_;
  std::unique_ptr<protocols::Drawing> drawing_;
  std::unique_ptr<protocols::Drawing> before_;  // a page: what is behind it
  std::uint64_t frames_{0};
};

/// Who sets the pace: the display, if it keeps to the rate that its monitor states, or a timer.
ScreenSummary agreed_pace(const protocols::ScreenOptions& options, double monitor_rate,
                          double interval) {
  ScreenSummary summary;
  const bool steady = std::abs(interval * monitor_rate - 1.0) < kPaceTolerance;
  summary.refresh_locked = options.refresh_lock && monitor_rate > 0.0 && steady;
  summary.rate = monitor_rate > 0.0 ? monitor_rate : Screen::kTimerRate;
  if (!summary.refresh_locked) {
    summary.notice =
        fmt::format("{}, so a timer draws the screen at {:.0f} Hz and pictures may tear",
                    options.refresh_lock ? "the display does not wait for its monitor's refresh"
                                         : "the definition asks for no refresh lock",
                    summary.rate);
  }
  return summary;
}

}  // namespace

void Screen::Impl::run() {
  bool open = false;
  try {
    render::Window window(window_options(options, style));
    Easel easel(window, fitted(style, window), options);
    const ScreenSummary agreed = agreed_pace(options, window.refresh_rate(), easel.probe());
    {
      const std::lock_guard lock(mutex);
      summary = agreed;
    }
    Pace pace(agreed.rate, agreed.refresh_locked);
    open = true;
    opened.set_value();
    stimulus::Shown seen;
    render::Pointer pointer = window.pointer();
    std::vector<int> held;
    bool closed = false;
    while (!stop.load(std::memory_order_relaxed)) {
      pace.wait();
      const std::int64_t start = now_ns();
      bool other_view = false;
      {
        const std::lock_guard lock(mutex);
        other_view = easel.take(scene);
      }
      shown.read(seen);
      const std::uint64_t flashed = easel.flash(onsets_so_far());  // after what they belong to
      easel.draw(seen);
      {
        const std::lock_guard lock(mutex);
        if (std::exchange(picture_asked, false)) {
          picture = window.read();
          picture_taken.notify_all();
        }
      }
      const std::int64_t drawn = now_ns();
      window.swap();
      count(pace.shown(drawn - start), flashed);
      window.poll();
      std::vector<int> now_held = window.held_keys();
      for (const render::KeyPress& press : window.take_keys()) {
        if (callbacks.key) {
          callbacks.key(press);
        }
        const bool typed = press.character != 0;
        if (!typed && std::find(now_held.begin(), now_held.end(), press.key) == now_held.end()) {
          now_held.push_back(press.key);  // let go again already: held for a picture all the same
        }
      }
      if (callbacks.held && now_held != held) {
        held = now_held;
        callbacks.held(held);
      }
      const bool moved = std::exchange(pointer, window.pointer()) != pointer;
      if (callbacks.pointer && (moved || other_view)) {  // a view may move under the pointer
        callbacks.pointer(easel.pointer());
      }
      if (window.close_asked() && !std::exchange(closed, true) && callbacks.closed) {
        callbacks.closed();
      }
    }
  } catch (const std::exception& error) {
    if (!open) {
      opened.set_exception(std::current_exception());
      return;
    }
    const std::lock_guard lock(mutex);
    trouble = fmt::format("the screen has stopped: {}", error.what());
  }
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
               ScreenCallbacks callbacks)
    : impl_(std::make_unique<Impl>()) {
  impl_->options = options;
  impl_->style = style;
  impl_->callbacks = std::move(callbacks);
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
  impl_->scene = {impl_->scene.version + 1, {}, std::move(page), Clock::now()};
}

void Screen::show(protocols::MakeDrawing make) {
  const std::lock_guard lock(impl_->mutex);
  impl_->scene = {impl_->scene.version + 1, std::move(make), {}, {}};
}

void Screen::observe(const stimulus::Shown& shown, const stimulus::Forces&, double) noexcept {
  if (impl_->first_tick_ns.load(std::memory_order_relaxed) == 0) {
    impl_->first_tick_ns.store(now_ns(), std::memory_order_relaxed);
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

}  // namespace haptrial::experiments
