#pragma once

#include <Eigen/Geometry>
#include <atomic>
#include <cstdint>
#include <memory>

namespace haptrial::bone {

/// Rigid poses that one thread writes, never waiting, and any number of threads read whole, without
/// a lock: a reader that met a change takes the poses again.
class WorldPoses {
 public:
  explicit WorldPoses(int capacity)
      : capacity_(capacity),
        numbers_(std::make_unique<std::atomic<double>[]>(
            static_cast<std::size_t>(capacity * kNumbers))) {}

  int capacity() const noexcept { return capacity_; }

  /// Publishes the first `count` poses at once. Writer; wait-free.
  /// @param pose_of  Eigen::Isometry3d(int)
  template <class PoseOf>
  void write(int count, PoseOf&& pose_of) noexcept {
    const std::uint32_t odd = sequence_.load(std::memory_order_relaxed) + 1;
    sequence_.store(odd, std::memory_order_relaxed);
    // Each number is released after the odd sequence: who sees one, sees that it is odd.
    for (int i = 0; i < count; ++i) {
      const Eigen::Isometry3d pose = pose_of(i);
      for (int n = 0; n < kNumbers; ++n) {
        at(i, n).store(pose.matrix()(n % 3, n / 3), std::memory_order_release);
      }
    }
    sequence_.store(odd + 1, std::memory_order_release);
  }

  /// Copies the first `count` poses, all of the same instant. Any thread.
  /// @param take  void(int, const Eigen::Isometry3d&); may be called again for the same poses
  template <class Take>
  void read(int count, Take&& take) const {
    while (true) {
      const std::uint32_t before = sequence_.load(std::memory_order_acquire);
      for (int i = 0; i < count && before % 2 == 0; ++i) {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        for (int n = 0; n < kNumbers; ++n) {
          pose.matrix()(n % 3, n / 3) = at(i, n).load(std::memory_order_acquire);
        }
        take(i, pose);
      }
      if (before % 2 == 0 && sequence_.load(std::memory_order_relaxed) == before) {
        return;
      }
    }
  }

 private:
  static constexpr int kNumbers = 12;
  std::atomic<double>& at(int pose, int number) const noexcept {
    return numbers_[static_cast<std::size_t>(pose * kNumbers + number)];
  }

  int capacity_;
  std::unique_ptr<std::atomic<double>[]> numbers_;
  std::atomic<std::uint32_t> sequence_{0};  // odd while the writer writes
};

}  // namespace haptrial::bone
