#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/sound/cue_player.h"
#include "experiments/screen/spoken_text.h"

namespace haptrial::experiments {

/// A text whose speech has begun.
struct SpokenText {
  std::string text;
  std::int64_t begun_ns{0};  // on the player's clock
};

/// Speaks what the participant's window shows, on a thread of its own, by the session's sound card.
/// A new text interrupts the one before. The screen's thread calls follow() and repeat(), the
/// session's the rest.
class Speaker {
 public:
  /// Key that says the window's text again: Tab, which answers no question and types nothing.
  static constexpr int kRepeatKey = 258;
  /// Makes samples at CardPlayer::kRate of a text.
  using Engine = std::function<std::vector<float>(const std::string&)>;

  /// @param player  outlives the speaker  @param seconds  the word, for a countdown
  Speaker(Engine engine, sound::CuePlayer& player, std::string seconds);
  Speaker(const Speaker&) = delete;
  Speaker& operator=(const Speaker&) = delete;

  /// Compares the picture with the one before. @param words  over the picture; empty: none
  void follow(const protocols::PictureText& text, const std::string& words);
  /// Says all of the present text again.
  void repeat();

  /// Whether a text is being said, or is about to be.
  bool speaks() const;
  /// Texts that have begun since the last call.
  std::vector<SpokenText> take_spoken();

 private:
  void say(std::string text);
  void be_silent(bool cut);
  void run(const std::stop_token& stop);

  Engine engine_;
  sound::CuePlayer& player_;
  const std::string seconds_;
  protocols::PictureText shown_;  // of the screen's thread, as the next one
  std::string words_;

  mutable std::mutex mutex_;  // all that follow
  std::condition_variable_any wanted_;
  std::uint64_t newest_{0};                     // number of the newest text
  std::optional<std::string> next_;             // the newest text, while nobody has taken it
  bool at_work_{false};                         // on samples of a text
  std::map<std::uint64_t, std::string> texts_;  // by number, those that have not begun

  std::jthread thread_;  // last: it uses the others
};

}  // namespace haptrial::experiments
