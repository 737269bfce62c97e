#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <optional>

#include "core/base/error.h"
#include "experiments/arguments.h"
#include "experiments/commands.h"
#include "experiments/interrupt.h"
#include "experiments/progress.h"
#include "experiments/replay.h"
#include "experiments/video.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

std::optional<record::Phase> phase_of(const std::string& name) {
  if (name.empty()) {
    return std::nullopt;
  }
  if (name != "training" && name != "test") {
    throw InputError(
        fmt::format("--phase is '{}'; allowed: training, test, or nothing for both", name));
  }
  return name == "test" ? record::Phase::kTest : record::Phase::kTraining;
}

/// A new folder of pictures; without keep() they go again.
class PictureFolder {
 public:
  explicit PictureFolder(fs::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    if (fs::exists(folder_, error) &&
        !(fs::is_directory(folder_, error) && fs::is_empty(folder_, error))) {
      throw InputError(
          fmt::format("{}: exists and is not an empty folder; name a new one, nothing is "
                      "overwritten",
                      folder_.string()));
    }
    made_ = fs::create_directories(folder_, error);
    if (error) {
      throw InputError(
          fmt::format("{}: the folder cannot be made ({})", folder_.string(), error.message()));
    }
  }
  ~PictureFolder() {
    std::error_code ignored;
    for (int i = 1; !kept_ && i <= count_; ++i) {
      fs::remove(name(i), ignored);
    }
    if (!kept_ && made_) {
      fs::remove(folder_, ignored);
    }
  }
  PictureFolder(const PictureFolder&) = delete;
  PictureFolder& operator=(const PictureFolder&) = delete;

  void add(const render::Image& image) { render::write_png(name(++count_), image); }
  void keep() { kept_ = true; }

 private:
  fs::path name(int number) const { return folder_ / fmt::format("frame-{:05}.png", number); }

  fs::path folder_;
  bool made_{false};
  bool kept_{false};
  int count_{0};
};

}  // namespace

int replay(const ReplayOptions& options) {
  const auto phase = phase_of(options.phase);
  constexpr int kMostFps = 240;
  const int fps = checked_number("--fps", options.fps, 1, kMostFps);
  if (options.video.empty() && options.frames.empty()) {
    throw InputError("replay needs --video FILE.mp4 or --frames FOLDER to write to");
  }
  Replay replay(options.file, options.trial, phase);
  std::optional<VideoWriter> video;
  std::optional<PictureFolder> pictures;
  if (!options.video.empty()) {
    video.emplace(options.video, fps);
  }
  if (!options.frames.empty()) {
    pictures.emplace(options.frames);
  }
  if (!replay.notice().empty()) {
    fmt::print("{}\n", replay.notice());
  }
  const auto count = static_cast<int>(std::floor(replay.duration() * fps + 1e-9)) + 1;
  {
    Progress progress("replay", count);
    for (int i = 0; i < count; ++i) {
      if (interrupted()) {
        throw RunError("interrupted");
      }
      const render::Image image = replay.draw(static_cast<double>(i) / fps);
      if (video) {
        video->add(image);
      }
      if (pictures) {
        pictures->add(image);
      }
      progress.update(i + 1, fmt::format("{} of {} pictures", i + 1, count), fps);
    }
  }
  if (video) {
    video->finish();
    fmt::print("video: {}\n", options.video);
  }
  if (pictures) {
    pictures->keep();
    fmt::print("pictures: {}\n", options.frames);
  }
  fmt::print("{} pictures, {:.1f} s at {} a second\n", count, replay.duration(), fps);
  return 0;
}

}  // namespace haptrial::experiments
