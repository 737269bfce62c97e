#include "experiments/screen/participant_canvas.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/render/gl/window.h"

namespace haptrial::experiments {
namespace {

const render::Colour kOrange{0.90, 0.45, 0.0};
constexpr double kPatchSide = 0.06;  // of the photodiode's square, of the screen's shorter side
constexpr std::size_t kProbes = 12;  // pictures by which the display's pace is known

double seconds_since(ScreenClock::time_point start) {
  return std::chrono::duration<double>(ScreenClock::now() - start).count();
}

}  // namespace

ParticipantCanvas::ParticipantCanvas(render::Window& window, const render::TrialDisplayStyle& style,
                                     const protocols::ScreenOptions& options,
                                     const SessionMark& mark)
    : window_(window),
      style_(style),
      mark_(mark),
      photodiode_(options.photodiode),
      flash_time_(options.photodiode_time),
      trial_(window.gl(), style, style.width, style.height),
      text_(window.gl(), style.width, style.height, style.background, style.marker_colour,
            style.target_colour),
      patch_(window.gl(), style.width, style.height),
      words_(window.gl(), style.width, style.height) {}

ParticipantCanvas::~ParticipantCanvas() = default;

bool ParticipantCanvas::take(const Scene& scene) {
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

void ParticipantCanvas::draw(const stimulus::Shown& shown, const std::string& words) {
  if (drawing_) {
    drawing_->draw(shown);
  } else {
    text_.draw(page_now());
  }
  ++frames_;
  draw_mark();
  draw_words(words);
  draw_patch(shown);
}

render::TextPage ParticipantCanvas::page_now() const {
  render::TextPage page = scene_.page;
  if (page.countdown) {
    page.countdown = std::max(0.0, *page.countdown - seconds_since(scene_.shown));
  }
  return page;
}

protocols::PictureText ParticipantCanvas::text(const stimulus::Shown& shown) const {
  if (!drawing_) {
    return {page_now()};
  }
  const auto* source = dynamic_cast<const protocols::TextSource*>(drawing_.get());
  return source != nullptr ? source->text(shown) : protocols::PictureText{};
}

void ParticipantCanvas::draw_words(const std::string& words) {
  if (words.empty()) {
    return;
  }
  constexpr double kSize = 0.035;  // of the screen's shorter side
  const double size = kSize * std::min(style_.width, style_.height);
  words_.begin();
  words_.paragraphs(words, {0.5 * style_.width, style_.height - 2.5 * size}, 0.9 * style_.width,
                    {static_cast<int>(size), false, style_.marker_colour}, render::Align::kCentre);
  words_.end();
}

void ParticipantCanvas::draw_mark() {
  constexpr double kFrame = 0.02;  // of the screen's shorter side, half of it outside
  constexpr double kWords = 0.025;
  const double side = std::min(style_.width, style_.height);
  if (mark_.framed) {
    patch_.begin_over();
    patch_.outline({{0.0, 0.0}, {double(style_.width), double(style_.height)}}, 0.0, kFrame * side,
                   kOrange);
    patch_.end();
  }
  if (!mark_.words.empty()) {
    const render::TextStyle style{std::max(10, static_cast<int>(kWords * side)), true, kOrange};
    words_.begin();
    words_.paragraphs(mark_.words, {kFrame * side, kFrame * side}, style_.width, style,
                      render::Align::kLeft);
    words_.end();
  }
}

std::uint64_t ParticipantCanvas::flash(std::uint64_t onsets) {
  if (photodiode_ != protocols::Photodiode::kOnset || onsets == onsets_) {
    return 0;
  }
  onsets_ = onsets;
  white_until_ =
      ScreenClock::now() + std::chrono::duration_cast<ScreenClock::duration>(flash_time_);
  return onsets;
}

double ParticipantCanvas::probe() {
  std::array<double, kProbes> intervals{};
  for (double& interval : intervals) {
    const auto start = ScreenClock::now();
    trial_.draw({});
    window_.swap();
    window_.poll();
    interval = seconds_since(start);
  }
  const auto middle = intervals.begin() + kProbes / 2;
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

void ParticipantCanvas::pressed(int key) {
  if (drawing_) {
    drawing_->pressed(key);
  }
}

ScreenPointer ParticipantCanvas::pointer(const device::PointerInput& input) {
  const protocols::Drawing* drawing = drawing_ ? drawing_.get() : before_.get();
  const auto seen = drawing != nullptr ? drawing->to_world(input.pixel) : std::nullopt;
  const Eigen::Vector3d point = seen.value_or(trial_.to_world(input.pixel));
  ScreenPointer pointer{point.x(), point.z(), input.wheel, input.buttons};
  if (drawing_) {
    pointer.hand = drawing_->hand(input);
  }
  return pointer;
}

bool ParticipantCanvas::is_white(const stimulus::Shown& shown) const {
  switch (photodiode_) {
    case protocols::Photodiode::kRun:
      return drawing_ != nullptr && shown.engaged();
    case protocols::Photodiode::kOnset:
      return ScreenClock::now() < white_until_;
    default:
      return frames_ % 2 == 0;
  }
}

void ParticipantCanvas::draw_patch(const stimulus::Shown& shown) {
  if (photodiode_ == protocols::Photodiode::kOff) {
    return;
  }
  const double side = std::round(kPatchSide * std::min(style_.width, style_.height));
  const double shade = is_white(shown) ? 1.0 : 0.0;
  patch_.begin_over();
  patch_.fill({{0.0, style_.height - side}, {side, static_cast<double>(style_.height)}}, 0.0,
              render::Colour{shade, shade, shade});
  patch_.end();
}

}  // namespace haptrial::experiments
