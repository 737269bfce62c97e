#pragma once

#include <filesystem>
#include <optional>

#include "core/base/child_process.h"
#include "core/base/whole_file.h"
#include "core/render/gl/image.h"

namespace haptrial::experiments {

/// Writes a video, picture by picture, through the ffmpeg of the system (H.264 in MP4), which runs
/// as a child process. The file takes its name in finish(); without it nothing is left.
class VideoWriter {
 public:
  /// @param file  ends in .mp4 and is not there yet: nothing is overwritten.
  /// @param fps   pictures a second > 0
  /// @throws InputError for another file name or where it cannot be written; RunError where ffmpeg
  /// is not installed.
  VideoWriter(const std::filesystem::path& file, int fps);

  /// All of one size, both sides even. @throws RunError with ffmpeg's words when it gives up.
  void add(const render::Image& image);
  /// @throws RunError when ffmpeg fails, InputError when a file has taken the name meanwhile.
  void finish();

 private:
  void start(int width, int height);
  std::string ended();  // waits for ffmpeg; what it complained of, empty where all is well

  WholeFile out_;
  int fps_;
  Descriptor feed_;
  Descriptor complaints_;
  std::optional<ChildProcess> ffmpeg_;  // ends before its file goes
  int width_{0};
  int height_{0};
};

}  // namespace haptrial::experiments
