#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "experiments/command/arguments.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/progress.h"
#include "experiments/control/signals.h"
#include "experiments/screen/video.h"
#include "experiments/studies/recorded_kinds.h"
#include "experiments/studies/registry.h"
#include "protocols/interface/recorded_definition.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

struct ReplayOptions {
  std::string file;
  int trial{0};
  std::string phase;
  std::string video;
  std::string frames;
  std::string sound;
  int fps{30};
};

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

/// Language that the participant read, if the file does not hold its texts, as those of version 0.2
/// and before. Pictures show what the definition has then.
std::string unshown_language(const fs::path& file) {
  std::string language;
  for (const record::EventRow& event : record::SessionReader(file).events()) {
    if (event.kind == protocols::kLanguageEvent) {
      language = event.text;
    } else if (event.kind == protocols::kLanguageTextsEvent) {
      return "";
    }
  }
  return language;
}

int replay(const ReplayOptions& options) {
  watch_for_interrupt();
  constexpr int kMostFps = 240;
  const int fps = checked_number("--fps", options.fps, 1, kMostFps);
  const Study& study = *with_recorded_kinds(
      options.file, [&] { return &study_of(record::SessionReader(options.file).info()); });
  const protocols::Protocol& protocol = study.protocol();
  std::optional<VideoWriter> video;
  std::optional<PictureFolder> pictures;
  if (!options.video.empty()) {
    video.emplace(options.video, fps);
  }
  if (!options.frames.empty()) {
    pictures.emplace(options.frames);
  }
  std::unique_ptr<Progress> progress;
  protocols::ReplayRequest request;
  request.file = options.file;
  request.trial = options.trial;
  request.phase = options.phase;
  request.fps = fps;
  request.pictures = !options.video.empty() || !options.frames.empty();
  request.sound = options.sound;
  request.picture = [&](const render::Image& image) {
    if (video) {
      video->add(image);
    }
    if (pictures) {
      pictures->add(image);
    }
  };
  request.progress = [&](double done, double all, const std::string& what, double rate) {
    if (interrupted()) {
      throw RunError("interrupted; nothing was written");
    }
    if (!progress) {
      progress = std::make_unique<Progress>("replay", all);
    }
    progress->update(done, what, rate);
  };
  std::vector<std::string> lines;
  request.tell = [&](const std::string& line) {
    progress.reset();
    lines.push_back(line);
  };
  with_recorded_kinds(options.file, [&] { protocol.replay(request); });
  progress.reset();
  if (video) {
    video->finish();
    lines.push_back("video: " + options.video);
  }
  if (pictures) {
    pictures->keep();
    lines.push_back("pictures: " + options.frames);
  }
  if (const std::string language = unshown_language(options.file);
      request.pictures && !language.empty()) {
    lines.push_back(fmt::format(
        "words: as the definition has them; the participant read them in {}", language));
  }
  for (const std::string& line : lines) {
    fmt::print("{}\n", line);
  }
  return 0;
}

}  // namespace

void add_replay(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "replay",
                 "Replay a recorded trial as the participant saw it, or simulate a drilling again",
                 "haptrial replay out/force_training-001/S01.h5 --trial 3 --video trial-3.mp4",
                 {"the video, pictures or sound asked for", "guide-analyst.md"});
  auto& o = options_of<ReplayOptions>(*sub, status, replay);
  sub->add_option("FILE", o.file, "Session file (.h5)")->required();
  sub->add_option("--trial", o.trial,
                  "Number of the trial, from 1 (default: of a drilling all, in a video the first)");
  sub->add_option("--phase", o.phase,
                  "Phase of the trial: training or test (default: both; a drilling has one)");
  sub->add_option("--video", o.video, "New video (.mp4); needs ffmpeg");
  sub->add_option("--frames", o.frames, "New folder for pictures (.png)");
  sub->add_option("--sound", o.sound, "New sound file of a drilling (.wav)");
  sub->add_option("--fps", o.fps, with_default("Pictures per second [1/s]", o.fps));
}

}  // namespace haptrial::experiments
