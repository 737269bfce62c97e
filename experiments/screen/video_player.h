#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>

#include "core/base/child_process.h"
#include "core/render/gl/image.h"
#include "core/sound/card_player.h"

namespace haptrial::experiments {

struct VideoFacts {
  double duration{0.0};  // [s]
  bool sound{false};     // it has some
};

/// Asks ffprobe, which comes with ffmpeg.
/// @throws InputError naming the file if it is absent or no video; RunError without ffmpeg
VideoFacts video_facts(const std::filesystem::path& file);

/// Plays a video once through the ffmpeg of the system, which runs as a child process for pictures
/// and another for sound. It plays while somebody asks for its picture, ten times a second at
/// least, and waits otherwise: a session that pauses takes its video along. One thread.
///
/// Source: Morris 2006, §3.3.1 (an instructional video before the procedure).
class VideoPlayer {
 public:
  /// @param width, height  that pictures are made smaller for [px]
  /// @param card  ALSA's name of the sound card
  /// @throws what video_facts() does
  VideoPlayer(const std::filesystem::path& file, int width, int height, const std::string& card);
  ~VideoPlayer();
  VideoPlayer(const VideoPlayer&) = delete;
  VideoPlayer& operator=(const VideoPlayer&) = delete;

  /// The picture of now, the same as long as none follows; the last one when it is over. Null while
  /// the first is not there.
  std::shared_ptr<const render::Image> picture();
  bool is_over() const;
  double played() const { return clock_; }  // [s]
  const VideoFacts& facts() const { return facts_; }
  /// Why the sound is not heard, in a sentence; empty: it is, or there is none.
  const std::string& silence() const { return silence_; }

 private:
  using Clock = std::chrono::steady_clock;
  void read_pictures(const std::stop_token& stop);
  std::shared_ptr<const render::Image> read_picture() const;
  void play_sound(const std::string& file, const std::string& card);
  void fill(std::span<float> samples);

  VideoFacts facts_;
  std::optional<Pipe> pictures_;
  std::optional<ChildProcess> picture_maker_;
  mutable std::mutex mutex_;  // of the next three
  std::condition_variable_any room_;
  std::deque<std::shared_ptr<const render::Image>> waiting_;
  bool all_read_{false};

  std::shared_ptr<const render::Image> shown_;
  std::int64_t taken_{0};  // pictures
  std::optional<Clock::time_point> asked_;
  std::atomic<double> clock_{0.0};  // since the beginning [s]

  std::optional<Pipe> sound_;
  std::optional<ChildProcess> sound_maker_;
  std::int64_t heard_{0};  // samples; the card's thread
  std::string silence_;
  std::optional<sound::CardPlayer> card_;
  std::jthread reader_;  // last: it uses the others
};

}  // namespace haptrial::experiments
