#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/sound/wav.h"
#include "experiments/arguments.h"
#include "experiments/bone_display.h"
#include "experiments/bone_replay.h"
#include "experiments/bone_sound.h"
#include "experiments/commands.h"
#include "experiments/counted.h"
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
    throw InputError(not_allowed("--phase", fmt::format("'{}'", name), {"training", "test"}));
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
      throw InputError(fmt::format(
          "{}: exists already and is not an empty folder; choose a new folder", folder_.string()));
    }
    made_ = fs::create_directories(folder_, error);
    if (error) {
      throw InputError(
          fmt::format("{}: the folder cannot be created ({})", folder_.string(), error.message()));
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

namespace {

/// What is written of a drilling that is simulated again.
class DrillingOutputs {
 public:
  DrillingOutputs(const ReplayOptions& options, const BoneReplay& replay, int fps)
      : replay_(replay), every_(replay.rate() / fps) {
    if (!options.video.empty()) {
      video_.emplace(options.video, fps);
    }
    if (!options.frames.empty()) {
      pictures_.emplace(options.frames);
    }
    if (!options.sound.empty()) {
      const BoneDefinition& d = replay.definition();
      sound_.emplace(options.sound, replay.rate(), d.sound_table, d.thin_bone, 1);
    }
  }
  bool any() const { return video_ || pictures_ || sound_; }

  void watch(std::uint64_t tick, const stimulus::DrillingView& seen,
             const std::shared_ptr<const BoneStage>& stage) {
    if (stage != stage_) {
      stage_ = stage;
      renderer_.reset();
      probe_.emplace(stage);
      if (video_ || pictures_) {
        renderer_ = std::make_unique<BoneRenderer>(replay_.definition(), stage);
      }
    }
    constexpr std::uint64_t kProbeEvery = 20;  // ticks
    if (sound_) {
      thickness_ = tick % kProbeEvery == 0 ? probe_->under(seen) : thickness_;
      sound_->add(sound_of(seen, stage->simulator->tools(), thickness_));
    }
    if (renderer_ && static_cast<double>(tick) >= next_) {
      next_ += every_;
      const render::Image image = renderer_->draw(seen);
      if (video_) {
        video_->add(image);
      }
      if (pictures_) {
        pictures_->add(image);
      }
      ++count_;
    }
  }

  void finish(const ReplayOptions& options) {
    renderer_.reset();
    if (video_) {
      video_->finish();
      fmt::print("video: {}\n", options.video);
    }
    if (pictures_) {
      pictures_->keep();
      fmt::print("pictures: {}\n", options.frames);
    }
    if (sound_) {
      sound_->finish();
      fmt::print("sound: {}\n", options.sound);
    }
    if (count_ > 0) {
      fmt::print("{} pictures\n", count_);
    }
  }

 private:
  const BoneReplay& replay_;
  double every_;  // ticks from picture to picture
  double next_{0.0};
  int count_{0};
  std::optional<VideoWriter> video_;
  std::optional<PictureFolder> pictures_;
  std::optional<sound::SoundTrack> sound_;
  std::shared_ptr<const BoneStage> stage_;
  std::unique_ptr<BoneRenderer> renderer_;
  std::optional<ThicknessProbe> probe_;
  double thickness_{1.0};  // [m]
};

void print_verdict(const ReplayOptions& options, const ReplayVerdict& verdict) {
  if (!verdict.difference.empty()) {
    throw RunError(fmt::format("{}: trial {} differs from the recording when simulated again: {}",
                               options.file, verdict.trial, verdict.difference));
  }
  fmt::print("trial {}: the same bone, {} ticks in {}, {} voxels emptied, checksum {:016x}{}\n",
             verdict.trial, verdict.ticks, counted(verdict.passes, "pass", "passes"),
             verdict.emptied, verdict.checksum,
             verdict.whole ? "" : "; an unfinished pass has no checksum");
}

int replay_drilling(const ReplayOptions& options, int fps) {
  const BoneReplay replay(options.file);
  DrillingOutputs outputs(options, replay, fps);
  const std::vector<int> all = replay.trials();
  if (all.empty()) {
    throw InputError(fmt::format("{}: holds no trials", options.file));
  }
  const int first = options.trial != 0 ? options.trial : all.front();
  const int last = options.trial != 0 || outputs.any() ? first : all.back();
  for (int trial = first; trial <= last; ++trial) {
    Progress progress("replay", static_cast<double>(replay.ticks(trial)));
    BoneReplay::Watch watch;
    if (outputs.any()) {
      watch = [&](std::uint64_t tick, const stimulus::DrillingView& seen,
                  const std::shared_ptr<const BoneStage>& stage) {
        if (interrupted()) {
          throw RunError("interrupted");
        }
        outputs.watch(tick, seen, stage);
        constexpr std::uint64_t kBetween = 100;  // ticks
        if (tick % kBetween == 0) {
          progress.update(static_cast<double>(tick), fmt::format("trial {}", trial), replay.rate());
        }
      };
    }
    print_verdict(options, replay.run(trial, watch));
  }
  outputs.finish(options);
  return 0;
}

}  // namespace

int replay(const ReplayOptions& options) {
  const auto phase = phase_of(options.phase);
  constexpr int kMostFps = 240;
  const int fps = checked_number("--fps", options.fps, 1, kMostFps);
  if (record::SessionReader(options.file).drills()) {
    return replay_drilling(options, fps);
  }
  if (options.trial == 0) {
    throw InputError("--trial is missing; give the number of the trial to show");
  }
  if (!options.sound.empty()) {
    throw InputError("--sound is given for a session without drilling; leave it out");
  }
  if (options.video.empty() && options.frames.empty()) {
    throw InputError("neither --video nor --frames is given; add one to write to");
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
