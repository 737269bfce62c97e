#include "experiments/studies/drilling/rating_pictures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>

#include "experiments/screen/video.h"
#include "protocols/bone_drilling/display/bone_display.h"
#include "protocols/bone_drilling/display/bone_pictures.h"

namespace haptrial::experiments {
namespace {

constexpr int kColumns = 4;

void paste(render::Image& sheet, const render::Image& picture, int left, int top) {
  for (int row = 0; row < picture.height; ++row) {
    const auto from = picture.rgb.begin() + static_cast<std::ptrdiff_t>(3) * row * picture.width;
    std::copy(
        from, from + static_cast<std::ptrdiff_t>(3) * picture.width,
        sheet.rgb.begin() + static_cast<std::ptrdiff_t>(3) * ((top + row) * sheet.width + left));
  }
}

// The view with which the procedure began.
bone::DrillingView from_the_start(bone::DrillingView seen, const protocols::BoneStage& stage) {
  seen.eye = stage.start_view.eye;
  seen.target = stage.start_view.target;
  seen.up = stage.start_view.up;
  seen.field_of_view = stage.start_view.field_of_view;
  seen.tip = seen.eye + 10.0 * (seen.eye - seen.target);  // the tool would hide the cavity
  return seen;
}

// Draws a procedure at moments that `wanted` chooses; the last picture is the cavity at the end.
class Watcher {
 public:
  Watcher(const protocols::BoneReplay& replay, int trial)
      : replay_(replay), last_(replay.ticks(trial) - 1) {}

  template <class Wanted, class Frame, class End>
  protocols::BoneReplay::Watch watch(Wanted wanted, Frame frame, End end) {
    return [=, this](std::uint64_t tick, std::uint64_t, const bone::DrillingView& seen,
                     const std::shared_ptr<const protocols::BoneStage>& stage) {
      if (stage != stage_) {
        renderer_.reset();
        renderer_ = std::make_unique<protocols::BoneRenderer>(replay_.definition(), stage);
        stage_ = stage;
        began_ = tick;
      }
      if (wanted(tick)) {
        bone::DrillingView timed = seen;
        timed.elapsed = static_cast<double>(tick - began_) / replay_.rate();
        frame(renderer_->draw(timed));
      }
      if (tick == last_) {
        end(renderer_->draw(from_the_start(seen, *stage)));
        renderer_.reset();
      }
    };
  }

 private:
  const protocols::BoneReplay& replay_;
  std::uint64_t last_;
  std::uint64_t began_{0};  // tick on which the bone was new
  std::shared_ptr<const protocols::BoneStage> stage_;
  std::unique_ptr<protocols::BoneRenderer> renderer_;
};

}  // namespace

render::Image contact_sheet(const std::vector<render::Image>& frames, int columns,
                            const render::Image& below) {
  if (frames.empty() || columns < 1) {
    throw std::invalid_argument("contact_sheet: no pictures or no columns");
  }
  const int width = frames.front().width, height = frames.front().height;
  const int rows = (static_cast<int>(frames.size()) + columns - 1) / columns;
  render::Image sheet{columns * width, rows * height + below.height, {}};
  if (below.width > sheet.width || std::any_of(frames.begin(), frames.end(), [&](const auto& f) {
        return f.width != width || f.height != height;
      })) {
    throw std::invalid_argument("contact_sheet: pictures of other sizes");
  }
  sheet.rgb.assign(static_cast<std::size_t>(3) * sheet.width * sheet.height, 0);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const int at = static_cast<int>(i);
    paste(sheet, frames[i], at % columns * width, at / columns * height);
  }
  paste(sheet, below, (sheet.width - below.width) / 2, rows * height);
  return sheet;
}

render::Image frame_sheet(const protocols::BoneReplay& replay, int trial, int frames) {
  if (frames < 2) {
    throw std::invalid_argument("frame_sheet: fewer than two pictures");
  }
  const std::uint64_t ticks = replay.ticks(trial);
  std::vector<std::uint64_t> moments;
  for (int i = 0; i < frames; ++i) {
    moments.push_back((ticks - 1) * static_cast<std::uint64_t>(i + 1) /
                      static_cast<std::uint64_t>(frames));
  }
  std::vector<render::Image> pictures;
  render::Image cavity;
  Watcher watcher(replay, trial);
  replay.run(trial, watcher.watch(
                        [&](std::uint64_t tick) {
                          return std::binary_search(moments.begin(), moments.end(), tick);
                        },
                        [&](const render::Image& image) {
                          pictures.push_back(render::coarser(image, kColumns / 2));
                        },
                        [&](render::Image image) { cavity = std::move(image); }));
  return contact_sheet(pictures, kColumns, cavity);
}

void film(const protocols::BoneReplay& replay, int trial, const std::filesystem::path& file,
          double speed) {
  constexpr int kFps = 15;
  constexpr int kSecondsOfTheEnd = 4;
  VideoWriter video(file, kFps);
  const auto step =
      static_cast<std::uint64_t>(std::max(1.0, std::round(replay.rate() * speed / kFps)));
  Watcher watcher(replay, trial);
  replay.run(trial, watcher.watch([&](std::uint64_t tick) { return tick % step == 0; },
                                  [&](const render::Image& image) { video.add(image); },
                                  [&](const render::Image& image) {
                                    for (int i = 0; i < kFps * kSecondsOfTheEnd; ++i) {
                                      video.add(image);
                                    }
                                  }));
  video.finish();
}

}  // namespace haptrial::experiments
