#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "core/render/flat/painter.h"
#include "core/render/flat/text_screen.h"
#include "core/render/flat/trial_display.h"
#include "experiments/screen/frame_pacing.h"
#include "experiments/screen/pad_pointer.h"
#include "experiments/screen/session_mark.h"
#include "protocols/definition/screen_options.h"
#include "protocols/interface/drawing.h"

namespace haptrial::render {
class Window;
}

namespace haptrial::experiments {

/// Scene that the session's thread asks to be shown.
struct Scene {
  std::uint64_t version{0};
  protocols::MakeDrawing make;  // empty: the page
  render::TextPage page;
  ScreenClock::time_point shown;  // when the page was asked for
};

/// Draws the pictures of a window; lives on the screen's thread.
class ParticipantCanvas {
 public:
  /// @param style  whose size is the window's
  ParticipantCanvas(render::Window& window, const render::TrialDisplayStyle& style,
                    const protocols::ScreenOptions& options, const SessionMark& mark);
  ~ParticipantCanvas();

  /// @returns whether it is another one than before.
  bool take(const Scene& scene);
  std::uint64_t version() const noexcept { return scene_.version; }  // of the scene it draws
  /// @param words  over the picture, at its lower edge
  void draw(const stimulus::Shown& shown, const std::string& words);
  /// The text of that picture.
  protocols::PictureText text(const stimulus::Shown& shown) const;
  /// The square is white from this frame on. @returns the onsets that it shows first; 0: no new
  /// ones
  std::uint64_t flash(std::uint64_t onsets);
  /// How fast the display takes pictures [s]; shows empty ones.
  double probe();
  void pressed(int key);
  /// Position of the window's pointer over the picture.
  /// @param input  with pixel, wheel and buttons of that pointer
  ScreenPointer pointer(const device::PointerInput& input);

 private:
  render::TextPage page_now() const;
  bool is_white(const stimulus::Shown& shown) const;
  void draw_patch(const stimulus::Shown& shown);
  void draw_mark();
  void draw_words(const std::string& words);

  render::Window& window_;
  render::TrialDisplayStyle style_;
  SessionMark mark_;
  protocols::Photodiode photodiode_;
  std::chrono::duration<double> flash_time_;
  ScreenClock::time_point white_until_{};
  std::uint64_t onsets_{0};     // that were shown
  render::TrialDisplay trial_;  // where a pointer is while no drawing says it
  render::TextScreen text_;
  render::Painter patch_;
  render::TextPainter words_;
  Scene scene_;
  std::unique_ptr<protocols::Drawing> drawing_;
  std::unique_ptr<protocols::Drawing> before_;  // a page: what is behind it
  std::uint64_t frames_{0};
};

}  // namespace haptrial::experiments
