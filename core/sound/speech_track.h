#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace haptrial::sound {

/// Speech, one text at a time: a new one takes the place of the one before. One thread.
class SpeechTrack {
 public:
  /// @param rate  of the samples [Hz]
  explicit SpeechTrack(double rate);

  void start(std::vector<float> clip);
  /// Lets the text that sounds now fade out over 5 ms.
  void stop() noexcept;
  bool sounds() const noexcept { return at_ < clip_.size(); }
  /// Adds the next samples to those that are there; the sum stays within full scale.
  void add(std::span<float> samples) noexcept;

 private:
  std::vector<float> clip_;
  std::size_t at_{0};
  int fade_;      // [samples]
  int left_{-1};  // samples until it has faded out; -1: it plays on
};

}  // namespace haptrial::sound
