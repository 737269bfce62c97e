#include "experiments/screen/video.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "core/base/error.h"

extern char** environ;

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

constexpr const char* kProgram = "ffmpeg";

std::string reason(int error) { return std::system_category().message(error); }

bool installed() {
  const char* path = std::getenv("PATH");
  std::string folders = path != nullptr ? path : "/usr/bin:/bin";
  for (std::size_t from = 0; from <= folders.size();) {
    const std::size_t to = std::min(folders.find(':', from), folders.size());
    if (access((fs::path(folders.substr(from, to - from)) / kProgram).c_str(), X_OK) == 0) {
      return true;
    }
    from = to + 1;
  }
  return false;
}

}  // namespace

VideoWriter::VideoWriter(fs::path file, int fps) : file_(std::move(file)), fps_(fps) {
  if (file_.extension() != ".mp4") {
    throw InputError(
        fmt::format("video '{}' is not a video by its name; allowed: .mp4", file_.string()));
  }
  std::error_code error;
  if (fs::exists(fs::symlink_status(file_, error))) {
    throw InputError(fmt::format("{}: exists already; choose another name", file_.string()));
  }
  const fs::path folder = file_.has_parent_path() ? file_.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error) || access(folder.c_str(), W_OK) != 0) {
    throw InputError(fmt::format("{}: cannot be written; choose a folder with write permission",
                                 file_.string()));
  }
  if (!installed()) {
    throw RunError(
        "ffmpeg is not installed, so no video can be written; install Debian's package ffmpeg, or "
        "write pictures with --frames");
  }
  part_ = file_;
  part_.replace_extension(fmt::format("{}.partial.mp4", getpid()));
}

VideoWriter::~VideoWriter() {
  if (child_ > 0) {
    kill(child_, SIGKILL);
    ended();
  }
  if (complaints_ >= 0) {
    close(complaints_);
  }
  std::error_code ignored;
  fs::remove(part_, ignored);
}

void VideoWriter::start(int width, int height) {
  width_ = width;
  height_ = height;
  std::array<int, 2> ends{};
  complaints_ = memfd_create("ffmpeg", MFD_CLOEXEC);
  // A socket rather than a pipe: a write to a child that has ended fails without a signal.
  if (complaints_ < 0 || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw RunError(fmt::format("ffmpeg does not take the pictures: {}", reason(errno)));
  }
  std::vector<std::string> words{kProgram,    "-nostdin",
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
                                 "-n",        "file:" + part_.string()};
  std::vector<char*> arguments;
  for (std::string& word : words) {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], 0);
  posix_spawn_file_actions_adddup2(&actions, complaints_, 1);
  posix_spawn_file_actions_adddup2(&actions, complaints_, 2);
  const int error = posix_spawnp(&child_, kProgram, &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  feed_ = ends[0];
  if (error != 0) {
    child_ = -1;
    close(feed_);
    throw RunError(fmt::format("ffmpeg cannot be started: {}", reason(error)));
  }
}

void VideoWriter::add(const render::Image& image) {
  if (child_ < 0) {
    start(image.width, image.height);
  }
  if (image.width != width_ || image.height != height_ || width_ % 2 != 0 || height_ % 2 != 0) {
    throw std::invalid_argument(
        fmt::format("a video of {} x {} pixels was given a picture of {} x {}; both must be even",
                    width_, height_, image.width, image.height));
  }
  for (std::size_t sent = 0; sent < image.rgb.size();) {
    const ssize_t now = send(feed_, image.rgb.data() + sent, image.rgb.size() - sent, MSG_NOSIGNAL);
    if (now < 0 && errno != EINTR) {
      const std::string why = reason(errno);
      const std::string complaint = ended();
      throw RunError(fmt::format("ffmpeg failed to write the video '{}': {}", file_.string(),
                                 complaint.empty() ? why : complaint));
    }
    sent += static_cast<std::size_t>(std::max<ssize_t>(now, 0));
  }
}

std::string VideoWriter::ended() {
  close(feed_);
  int status = 0;
  while (waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    return "";
  }
  std::array<char, 400> text{};
  const ssize_t size = pread(complaints_, text.data(), text.size(), 0);
  const std::string complaint(text.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  const std::string line = complaint.substr(0, complaint.find('\n'));
  return line.empty() ? fmt::format("it ended with status {}", status) : line;
}

void VideoWriter::finish() {
  if (child_ < 0) {
    throw RunError(fmt::format("the video '{}' has no pictures", file_.string()));
  }
  if (const std::string complaint = ended(); !complaint.empty()) {
    throw RunError(
        fmt::format("ffmpeg could not write the video '{}': {}", file_.string(), complaint));
  }
  if (renameat2(AT_FDCWD, part_.c_str(), AT_FDCWD, file_.c_str(), RENAME_NOREPLACE) != 0) {
    throw InputError(
        fmt::format("{}: the video cannot take its name ({})", file_.string(), reason(errno)));
  }
}

}  // namespace haptrial::experiments
