#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace haptrial::sound {

/// Keeps a signal within full scale: where it would leave it, the gain falls at once to what fits
/// and comes back over 50 ms. It does nothing to a signal that fits.
class Limiter {
 public:
  /// @param rate  of the samples [Hz]
  explicit Limiter(double rate);
  /// @returns from -1 to 1; 0 for what is no number
  float limited(double sample) noexcept;
  bool acts() const noexcept { return gain_ < 1.0; }

 private:
  double back_;  // of the gain, a sample
  double gain_{1.0};
};

/// Adds the sounds of a session: clips that are started, each from its beginning, and a loop of
/// masking noise that fades in and out. One thread; no allocation, lock or throw after the
/// constructor but in take_further().
class Mixer {
 public:
  static constexpr std::size_t kMostVoices = 16;  // that sound at once; the oldest gives way

  using Clip = std::shared_ptr<const std::vector<float>>;

  /// @param masking  a loop; empty: none  @param fade  of it [s]
  Mixer(std::vector<std::vector<float>> clips, std::vector<float> masking, double fade,
        double rate);

  /// Takes further clips, behind those of the constructor and in place of those that it took last;
  /// what sounds goes on. It allocates.
  void take_further(const std::vector<Clip>& clips);
  /// Starts a clip from the next sample on. @param clip  from 0; others are none
  void start(std::size_t clip) noexcept;
  /// Lets everything that sounds now fade out over 5 ms; a sound that is started later does not.
  void still() noexcept;
  void mask(bool on) noexcept { masked_ = on; }
  void fill(std::span<float> samples) noexcept;
  /// Whether a clip or the masking noise is heard.
  bool sounds() const noexcept;

  /// Samples at which the limiter held the sum down. Any thread.
  std::uint64_t limited() const noexcept { return limited_.load(std::memory_order_relaxed); }

 private:
  struct Voice {
    Clip clip{};
    std::size_t at{0};
    int left{-1};  // samples until it has faded out; -1: it plays on
  };
  double next() noexcept;

  std::vector<Clip> clips_;
  std::size_t fixed_;  // of them, for the whole session
  std::vector<float> masking_;
  double step_;  // of the masking's gain, a sample
  int fade_;     // of what is stilled [samples]
  std::array<Voice, kMostVoices> voices_{};
  std::size_t oldest_{0};
  std::size_t place_{0};  // in the masking's loop
  double gain_{0.0};      // of the masking
  bool masked_{false};
  Limiter limiter_;
  std::atomic<std::uint64_t> limited_{0};
};

}  // namespace haptrial::sound
