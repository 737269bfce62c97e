#include "experiments/screen/speaker.h"

#include <iterator>

namespace haptrial::experiments {

Speaker::Speaker(Engine engine, sound::CuePlayer& player, std::string seconds)
    : engine_(std::move(engine)), player_(player), seconds_(std::move(seconds)) {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void Speaker::follow(const protocols::PictureText& text, const std::string& words) {
  SpeechChange change = speech_between(shown_, text, seconds_);
  shown_ = text;
  if (std::exchange(words_, words) != words && !words.empty()) {
    say(words);
    return;
  }
  switch (change.kind) {
    case SpeechChange::Kind::kSay:
      say(std::move(change.text));
      break;
    case SpeechChange::Kind::kForget:
      be_silent(false);
      break;
    case SpeechChange::Kind::kCut:
      be_silent(true);
      break;
    case SpeechChange::Kind::kNone:
      break;
  }
}

void Speaker::repeat() { say(words_of(shown_.page, seconds_)); }

void Speaker::say(std::string text) {
  const std::lock_guard lock(mutex_);
  player_.hush();
  texts_[++newest_] = text;
  next_ = std::move(text);
  wanted_.notify_one();
}

void Speaker::be_silent(bool cut) {
  const std::lock_guard lock(mutex_);
  ++newest_;
  next_.reset();
  cut ? player_.hush() : player_.forget();
}

bool Speaker::speaks() const {
  const std::lock_guard lock(mutex_);
  return next_ || at_work_ || player_.speaks();
}

std::vector<SpokenText> Speaker::take_spoken() {
  const std::lock_guard lock(mutex_);
  std::vector<SpokenText> spoken;
  for (const sound::StartedCue& begun : player_.take_said()) {
    const auto found = texts_.find(begun.ticket);
    if (found != texts_.end()) {
      spoken.push_back({found->second, begun.handed_ns});
      texts_.erase(texts_.begin(), std::next(found));  // those before were never said
    }
  }
  return spoken;
}

/// A text that was replaced while its samples were made is not said.
void Speaker::run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (wanted_.wait(lock, stop, [this] { return next_.has_value(); }) && !stop.stop_requested()) {
    const std::string text = *std::exchange(next_, std::nullopt);
    const std::uint64_t number = newest_;
    at_work_ = true;
    lock.unlock();
    std::vector<float> clip = engine_(text);
    lock.lock();
    at_work_ = false;
    if (number == newest_ && !clip.empty()) {
      player_.say(std::move(clip), number);
    }
  }
}

}  // namespace haptrial::experiments
