#include "experiments/screen/video.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "core/base/error.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

constexpr const char* kProgram = "ffmpeg";

std::string reason(int error) { return std::system_category().message(error); }

const fs::path& checked(const fs::path& file) {
  if (file.extension() != ".mp4") {
    throw InputError(
        fmt::format("video '{}' is not a video by its name; allowed: .mp4", file.string()));
  }
  if (!is_installed(kProgram)) {
    throw RunError(
        "ffmpeg is not installed, so no video can be written; install Debian's package ffmpeg, or "
        "write pictures with --frames");
  }
  return file;
}

}  // namespace

VideoWriter::VideoWriter(const fs::path& file, int fps)
    : out_(checked(file), false, ".mp4"), fps_(fps) {
  out_.close();  // ffmpeg writes it
}

void VideoWriter::start(int width, int height) {
  width_ = width;
  height_ = height;
  std::array<int, 2> ends{};
  complaints_ = Descriptor(memfd_create("ffmpeg", MFD_CLOEXEC));
  // A socket rather than a pipe: a write to a child that has ended fails without a signal.
  if (complaints_.get() < 0 ||
      socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw RunError(fmt::format("ffmpeg does not take the pictures: {}", reason(errno)));
  }
  feed_ = Descriptor(ends[0]);
  const Descriptor pictures(ends[1]);
  const std::vector<std::string> words{kProgram,    "-nostdin",
                                       "-loglevel", "error",
                                       "-f",        "rawvideo",
                                       "-pix_fmt",  "rgb24",
                                       "-s",        fmt::format("{}x{}", width, height),
                                       "-r",        std::to_string(fps_),
                                       "-i",        "pipe:0",
                                       "-c:v",      "libx264",
                                       "-preset",   "veryfast",
                                       "-crf",      "18",
                                       "-pix_fmt",  "yuv420p",
                                       "-movflags", "+faststart",
                                       "-y",        "file:" + out_.part().string()};
  try {
    ffmpeg_.emplace(Program{.words = words, .input = pictures.get(), .output = complaints_.get()});
  } catch (const std::system_error& error) {
    throw RunError(fmt::format("ffmpeg cannot be started: {}", error.code().message()));
  }
}

void VideoWriter::add(const render::Image& image) {
  if (!ffmpeg_) {
    start(image.width, image.height);
  }
  if (image.width != width_ || image.height != height_ || width_ % 2 != 0 || height_ % 2 != 0) {
    throw std::invalid_argument(
        fmt::format("a video of {} x {} pixels was given a picture of {} x {}; both must be even",
                    width_, height_, image.width, image.height));
  }
  for (std::size_t sent = 0; sent < image.rgb.size();) {
    const ssize_t now =
        send(feed_.get(), image.rgb.data() + sent, image.rgb.size() - sent, MSG_NOSIGNAL);
    if (now < 0 && errno != EINTR) {
      const std::string why = reason(errno);
      const std::string complaint = ended();
      throw RunError(fmt::format("ffmpeg failed to write the video '{}': {}", out_.file().string(),
                                 complaint.empty() ? why : complaint));
    }
    sent += static_cast<std::size_t>(std::max<ssize_t>(now, 0));
  }
}

std::string VideoWriter::ended() {
  feed_.close();
  const int status = ffmpeg_->wait();
  if (status == 0) {
    return "";
  }
  std::array<char, 400> text{};
  const ssize_t size = pread(complaints_.get(), text.data(), text.size(), 0);
  const std::string complaint(text.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  const std::string line = complaint.substr(0, complaint.find('\n'));
  return line.empty() ? fmt::format("it ended with status {}", status) : line;
}

void VideoWriter::finish() {
  if (!ffmpeg_) {
    throw RunError(fmt::format("the video '{}' has no pictures", out_.file().string()));
  }
  if (const std::string complaint = ended(); !complaint.empty()) {
    throw RunError(
        fmt::format("ffmpeg could not write the video '{}': {}", out_.file().string(), complaint));
  }
  out_.finish();
}

}  // namespace haptrial::experiments
