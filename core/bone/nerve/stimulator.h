#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/bone/nerve/nerve_rows.h"

namespace haptrial::nerve {

inline constexpr double kLeastStimulus = 0.05e-3;  // that a probe gives [A]
inline constexpr double kMostStimulus = 3e-3;      // [A]

/// Finds the least current that a nerve answers to, as a surgeon's monitor does: halves the bracket
/// between a current that was answered and one that was not.
class ThresholdSearch {
 public:
  /// Currents [A]; the ends of what a probe gives.
  explicit ThresholdSearch(double least = kLeastStimulus, double most = kMostStimulus) noexcept
      : low_(least), high_(most), next_(most) {}
  double current() const noexcept { return next_; }  // of the next pulse [A]
  void tell(bool answered) noexcept;
  bool done() const noexcept { return done_; }
  /// Whether even the strongest pulse was not answered, or the weakest one was.
  bool out_of_range() const noexcept { return out_of_range_; }
  double threshold() const noexcept { return high_; }  // [A], within 5 % once done

 private:
  double low_;
  double high_;
  double next_;
  int told_{0};
  bool done_{false};
  bool out_of_range_{false};
};

/// The current of the probe's next pulse [A]: the servo thread reads what a technician sets.
using PulseCurrent = std::shared_ptr<std::atomic<float>>;

/// A nerve's threshold as a search found it.
struct FoundThreshold {
  std::size_t channel{0};
  double current{0.0};       // [A]
  bool out_of_range{false};  // answered to the weakest pulse, or not to the strongest
};

/// The probe's pulses under a technician's control: sets their current, or lets a search find the
/// least one that a channel answers. An answer to a pulse that comes while another event of the
/// channel goes on could not be told from it: the search waits for a pulse in quiet. The thread
/// that makes electromyograms; allocates rows.
class Stimulator {
 public:
  /// @param rate  of ticks [Hz]
  Stimulator(PulseCurrent current, double rate) : current_(std::move(current)), rate_(rate) {}

  /// Sets the current and ends a search. @param current  kLeastStimulus to kMostStimulus, else
  /// taken as the nearer [A]
  void set(double current) noexcept;
  void search(std::size_t channel) noexcept;

  /// Follows a tick; call after every one.
  /// @param pulse  that began with it [A], 0: none
  /// @param quiet  no event of the searched channel went on when the tick began
  /// @param ended  events that ended in it
  void follow(std::uint64_t sequence, double pulse, bool quiet,
              std::span<const record::NerveEventRow> ended,
              std::vector<record::NerveStimulusRow>& rows);

  double current() const noexcept { return current_->load(std::memory_order_relaxed); }  // [A]
  /// The channel whose threshold is being looked for.
  std::optional<std::size_t> searching() const noexcept { return channel_; }
  const std::optional<FoundThreshold>& found() const noexcept { return found_; }

 private:
  void give(double current) noexcept;
  void conclude(std::uint64_t sequence, std::vector<record::NerveStimulusRow>& rows);

  PulseCurrent current_;
  double rate_;
  bool set_{false};  // since the tick before
  bool begun_{false};
  std::optional<std::size_t> channel_;
  std::optional<ThresholdSearch> search_;
  std::optional<std::uint64_t> pulse_;  // tick of the one whose answer is awaited
  bool answered_{false};
  std::optional<FoundThreshold> found_;
};

}  // namespace haptrial::nerve
