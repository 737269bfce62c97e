#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace haptrial::subject {

/// A virtual surgeon works on bone within 3 mm below the surface that it had, down to 8 mm, deeper,
/// or with the fine burr on bone near structures.
enum class SurgeonWork : std::uint8_t { kCortex, kMiddle, kDeep, kFine };

/// Work that a virtual surgeon began.
struct BegunWork {
  double time{0.0};  // of the procedure [s]
  SurgeonWork work{SurgeonWork::kCortex};
};

/// A virtual surgeon's work in order, each piece noted where it differs from the one before: the
/// truth that a division into phases is held against. One thread: the simulated clock's.
class WorkLog {
 public:
  static constexpr std::size_t kMost = 16384;  // pieces of a procedure; later ones are left out

  WorkLog() { begun_.reserve(kMost); }
  /// No allocation.
  void note(double time, SurgeonWork work) noexcept {
    if ((begun_.empty() || begun_.back().work != work) && begun_.size() < kMost) {
      begun_.push_back({time, work});
    }
  }
  /// Gives what was noted, and forgets it.
  std::vector<BegunWork> take() {
    std::vector<BegunWork> taken(begun_);
    begun_.clear();
    return taken;
  }

 private:
  std::vector<BegunWork> begun_;
};

}  // namespace haptrial::subject
