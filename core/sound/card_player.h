#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <thread>

namespace haptrial::sound {

/// Feeds a sound card of ALSA's from a thread of its own: 5 ms at a time, at most 20 ms ahead.
class CardPlayer {
 public:
  static constexpr double kRate = 48'000.0;  // [Hz]

  /// Makes the next samples, those of all channels at an instant beside each other; called on the
  /// player's thread.
  using Fill = std::function<void(std::span<float>)>;
  /// Called on the same thread when the card has taken what `fill` made.
  using Handed = std::function<void()>;

  /// @param device  a name of ALSA's ("default", "hw:0")
  /// @throws RunError with a sentence if there is no such card, as on a server.
  /// @param channels  of the card, from the first
  CardPlayer(const std::string& device, Fill fill, Handed handed = {}, unsigned channels = 1);
  ~CardPlayer();
  CardPlayer(const CardPlayer&) = delete;
  CardPlayer& operator=(const CardPlayer&) = delete;

  /// Instants whose samples were handed to the card, and how often it ran out of them. Any thread.
  std::uint64_t played() const noexcept { return played_.load(std::memory_order_relaxed); }
  std::uint64_t gaps() const noexcept { return gaps_.load(std::memory_order_relaxed); }
  /// Whether the card was lost: nothing is played any more. Any thread.
  bool lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

 private:
  struct Card;
  void run(const std::stop_token& stop);
  bool write(std::span<const float> part, const std::stop_token& stop);

  Fill fill_;
  Handed handed_;
  unsigned channels_;
  std::unique_ptr<Card> card_;
  std::atomic<std::uint64_t> played_{0};
  std::atomic<std::uint64_t> gaps_{0};
  std::atomic<bool> lost_{false};
  std::jthread thread_;  // last: it ends before what it uses
};

}  // namespace haptrial::sound
