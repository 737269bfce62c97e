#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/device/gamepad.h"
#include "core/record/rows/session_types.h"
#include "core/render/flat/text_screen.h"
#include "core/render/flat/trial_display_style.h"
#include "core/render/gl/window.h"
#include "core/stimulus/observer.h"
#include "core/stream/onset_log.h"
#include "experiments/control/session_control.h"
#include "experiments/screen/pad_pointer.h"
#include "experiments/screen/session_mark.h"
#include "protocols/definition/screen_options.h"
#include "protocols/interface/drawing.h"

namespace haptrial::experiments {

class Speaker;

/// How a screen kept time.
struct ScreenSummary {
  std::uint64_t frames{0};
  std::uint64_t dropped{0};
  double rate{0.0};            // of the monitor's refresh, or of the timer [Hz]
  bool refresh_locked{false};  // else a timer sets the pace
  double draw_median_ms{0.0};  // to draw a picture, without the wait for the refresh
  double draw_worst_ms{0.0};
  std::string notice;  // one sentence; empty where the refresh sets the pace
};

/// The first frame that a photodiode's square was white in after an onset.
struct Flash {
  std::uint64_t onsets{0};  // of the run, up to and with those that it shows
  std::int64_t frame{0};    // of take_frames(), from 0
  std::int64_t time_ns{0};  // when it was shown, as a frame's
};

/// Callbacks for events at the screen; called on its thread. They must not call back into the
/// screen.
struct ScreenCallbacks {
  std::function<void(const render::KeyPress&)> key;
  std::function<void(const ScreenPointer&)> pointer;  // when it or the view under it changed
  /// The window's close button, once; and the screen has stopped drawing.
  std::function<void()> closed;
  /// State of a game controller in the place of the mouse; empty: there is none.
  std::function<device::GamepadState()> pad;
  /// Words over the next picture, at its lower edge; empty: none.
  std::function<std::string()> words;
  /// Keys that are held, when they change; one that was tapped between two pictures is among them
  /// once.
  std::function<void(const std::vector<int>&)> held;
};

/// Request of a key in the participant's window, if keys are allowed there, as on the console's
/// keyboard: Escape is the emergency stop, space and Enter go on, P pauses, R repeats, S skips, C
/// clears.
std::optional<Request> request_of(const render::KeyPress& press);

/// The participant's screen: a window or a full screen, drawn on a thread of its own at every
/// refresh of the monitor. If the display does not wait for a refresh, a timer sets the pace at the
/// monitor's rate, or at kTimerRate if the monitor does not say.
///
/// The servo thread calls observe(); any other thread calls the rest.
class Screen final : public stimulus::Observer {
 public:
  static constexpr double kTimerRate = 60.0;  // [Hz]

  /// Opens the window; comes back when it shows an empty picture.
  /// @param style  of trials; its size is that of a window, while a full screen has its own.
  /// @throws RunError, InputError as render::Window does; InputError where the screen is too small
  /// for the style.
  Screen(const protocols::ScreenOptions& options, const render::TrialDisplayStyle& style,
         ScreenCallbacks callbacks = {}, const SessionMark& mark = {});
  ~Screen() override;
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// Shows a page from the next picture on; a countdown runs from this call.
  void show_text(render::TextPage page);
  /// Shows, from the next picture on, the drawing that `make` gives, with the views of observe().
  /// @returns a number for has_shown()
  std::uint64_t show(protocols::MakeDrawing make);
  /// Whether the participant has seen a picture of what show() or show_text() asked for then.
  bool has_shown(std::uint64_t number) const noexcept;

  /// Sets the log whose onsets make the photodiode's square white (Photodiode::kOnset). @param
  /// log  outlives the screen
  void flash_with(const markers::OnsetLog* log);

  /// Has the texts of its pictures spoken from the next one on, and again at Speaker::kRepeatKey.
  /// @param speaker  null: nobody speaks from when this returns; else outlives the screen
  void speak_with(Speaker* speaker);

  /// Servo thread: hands the newest presentation over; no allocation, lock, I/O or throw.
  void observe(const stimulus::Shown& shown, const stimulus::Forces& forces,
               double dt) noexcept override;

  /// The pictures since the last call, from the session's first tick on, in order.
  std::vector<record::FrameRow> take_frames();
  /// The flashes since the last call, in order.
  std::vector<Flash> take_flashes();
  ScreenSummary summary() const;
  /// Why the screen has stopped drawing, in a sentence; empty while it draws.
  std::string trouble() const;
  /// The next picture. @throws RunError when none comes within two seconds.
  render::Image screenshot();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Small copies of the participant's picture, for the experimenter's console. Nothing is copied
/// while nobody asks; a copy costs the screen's thread some milliseconds, and the rest is done on
/// the thread that asks. Any thread but the servo and the screen's.
class ScreenMirror {
 public:
  /// @param screen  outlives the mirror
  explicit ScreenMirror(Screen& screen) : screen_(screen) {}

  /// A PNG file at most kWidth wide; the one before if it is younger than kPeriod.
  /// @throws RunError if the screen shows no picture for two seconds
  std::string picture();

  static constexpr int kWidth = 640;  // [px]
  static constexpr std::chrono::milliseconds kPeriod{500};

 private:
  Screen& screen_;
  std::mutex mutex_;
  std::string picture_;
  std::chrono::steady_clock::time_point taken_{};
};

}  // namespace haptrial::experiments
