#include "experiments/screen/video_player.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/error.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

constexpr double kRate = 25.0;           // pictures a second
constexpr std::size_t kMostWaiting = 8;  // pictures
constexpr double kLongestStep = 0.1;     // between two askings, while it plays [s]

/// Starts a program whose output goes into the pipe.
void start(std::optional<ChildProcess>& child, const std::vector<std::string>& words, Pipe& pipe) {
  try {
    child.emplace(Program{.words = words, .output = pipe.to.get()});
  } catch (const std::system_error& error) {
    throw RunError(fmt::format("{} cannot be started: {}", words[0], error.code().message()));
  }
  pipe.to.close();
}

std::string ffmpeg_input(const fs::path& file) { return "file:" + file.string(); }

/// A number of a portable pixel map's head, and the white space behind it; 0: there is none.
int read_number(int from) {
  constexpr std::size_t kMostDigits = 6;
  std::string digits;
  char next = 0;
  while (digits.size() <= kMostDigits && read_fully(from, &next, 1) == 1 && next >= '0' &&
         next <= '9') {
    digits += next;
  }
  int number = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return number;
}

}  // namespace

VideoFacts video_facts(const fs::path& file) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) {
    throw InputError(fmt::format("{}: there is no such video", file.string()));
  }
  if (!is_installed("ffprobe") || !is_installed("ffmpeg")) {
    throw RunError(
        fmt::format("{}: ffmpeg is not installed, so the video cannot be shown; install Debian's "
                    "package ffmpeg",
                    file.string()));
  }
  Pipe answer;
  std::optional<ChildProcess> probe;
  start(probe,
        {"ffprobe", "-loglevel", "quiet", "-show_entries", "format=duration:stream=codec_type",
         "-of", "json", ffmpeg_input(file)},
        answer);
  const auto json = nlohmann::json::parse(read_to_end(answer.from.get()), nullptr, false);
  VideoFacts facts;
  bool pictures = false;
  if (json.is_object()) {
    const std::string duration = json.value("/format/duration"_json_pointer, std::string());
    std::from_chars(duration.data(), duration.data() + duration.size(), facts.duration);
    for (const auto& stream : json.value("streams", nlohmann::json::array())) {
      const std::string type = stream.value("codec_type", "");
      pictures = pictures || type == "video";
      facts.sound = facts.sound || type == "audio";
    }
  }
  if (!pictures || !(facts.duration > 0.0)) {
    throw InputError(
        fmt::format("{}: is no video; allowed: a file that ffmpeg can play", file.string()));
  }
  return facts;
}

VideoPlayer::VideoPlayer(const fs::path& file, int width, int height, const std::string& card)
    : facts_(video_facts(file)) {
  pictures_.emplace();
  const std::string size = fmt::format(
      "fps={},scale=w='min({},iw*sar)':h='min({},ih)':force_original_aspect_ratio=decrease,setsar="
      "1",
      kRate, width, height);
  start(picture_maker_,
        {"ffmpeg", "-nostdin", "-loglevel", "quiet", "-i", ffmpeg_input(file), "-an", "-vf", size,
         "-f", "image2pipe", "-c:v", "ppm", "pipe:1"},
        *pictures_);
  if (facts_.sound) {
    play_sound(ffmpeg_input(file), card);
  }
  reader_ = std::jthread([this](const std::stop_token& stop) { read_pictures(stop); });
}

/// Reading from a child that has gone ends at once.
VideoPlayer::~VideoPlayer() {
  picture_maker_->kill();
  if (sound_maker_) {
    sound_maker_->kill();
  }
  card_.reset();
  reader_.request_stop();
  reader_.join();
}

void VideoPlayer::play_sound(const std::string& file, const std::string& card) {
  sound_.emplace();
  start(sound_maker_,
        {"ffmpeg", "-nostdin", "-loglevel", "quiet", "-i", file, "-vn", "-ac", "1", "-ar",
         fmt::format("{:.0f}", sound::CardPlayer::kRate), "-f", "f32le", "pipe:1"},
        *sound_);
  try {
    card_.emplace(card, [this](std::span<float> samples) { fill(samples); });
  } catch (const RunError& error) {
    silence_ = error.what();
    sound_maker_->kill();
  }
}

/// The sound follows the pictures: it waits while they do, and leaves out what it has missed.
void VideoPlayer::fill(std::span<float> samples) {
  constexpr double kAhead = 0.05;   // [s]
  constexpr double kBehind = 0.25;  // [s]
  const double ahead = static_cast<double>(heard_) / sound::CardPlayer::kRate - clock_;
  if (clock_ == 0.0 || ahead > kAhead) {
    std::ranges::fill(samples, 0.0F);
    return;
  }
  const auto rounds = ahead < -kBehind ? 2 : 1;
  for (int round = 0; round < rounds; ++round) {
    const std::size_t bytes = read_fully(sound_->from.get(), samples.data(), samples.size_bytes());
    std::ranges::fill(samples.subspan(bytes / sizeof(float)), 0.0F);
    heard_ += static_cast<std::int64_t>(samples.size());
  }
}

std::shared_ptr<const render::Image> VideoPlayer::read_picture() const {
  constexpr int kMostSide = 16384;
  const int from = pictures_->from.get();
  std::array<char, 3> magic{};
  if (read_fully(from, magic.data(), magic.size()) != magic.size() || magic[1] != '6') {
    return nullptr;
  }
  auto image = std::make_shared<render::Image>();
  image->width = read_number(from);
  image->height = read_number(from);
  const bool fits = image->width > 0 && image->width <= kMostSide && image->height > 0 &&
                    image->height <= kMostSide;
  if (!fits || read_number(from) != 255) {
    return nullptr;
  }
  image->rgb.resize(static_cast<std::size_t>(image->width) *
                    static_cast<std::size_t>(image->height) * 3);
  const bool whole = read_fully(from, image->rgb.data(), image->rgb.size()) == image->rgb.size();
  return whole ? image : nullptr;
}

void VideoPlayer::read_pictures(const std::stop_token& stop) {
  while (auto image = read_picture()) {
    std::unique_lock lock(mutex_);
    room_.wait(lock, stop, [this] { return waiting_.size() < kMostWaiting; });
    if (stop.stop_requested()) {
      return;
    }
    waiting_.push_back(std::move(image));
  }
  const std::lock_guard lock(mutex_);
  all_read_ = true;
}

std::shared_ptr<const render::Image> VideoPlayer::picture() {
  const auto now = Clock::now();
  const double step = asked_ ? std::chrono::duration<double>(now - *asked_).count() : 0.0;
  asked_ = now;
  const std::lock_guard lock(mutex_);
  if (shown_) {
    const double known = static_cast<double>(taken_ + std::ssize(waiting_)) / kRate;
    clock_ = std::min(clock_ + std::min(step, kLongestStep), known);
  }
  while (!waiting_.empty() && static_cast<double>(taken_) / kRate <= clock_) {
    shown_ = std::move(waiting_.front());
    waiting_.pop_front();
    ++taken_;
    room_.notify_one();
  }
  return shown_;
}

bool VideoPlayer::is_over() const {
  const std::lock_guard lock(mutex_);
  return all_read_ && waiting_.empty() && clock_ >= static_cast<double>(taken_) / kRate;
}

}  // namespace haptrial::experiments
