#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace haptrial::tutoring {

/// Bytes of a length that is not known before, without memory of their own elsewhere.
/// @tparam kMost  the longest
template <class Byte, std::size_t kMost>
class Packet {
 public:
  static constexpr std::size_t kMostBytes = kMost;
  Packet() = default;
  explicit Packet(std::size_t size) noexcept : size_(size) {}
  void resize(std::size_t size) noexcept { size_ = size; }  // at most kMost
  Byte* data() noexcept { return bytes_.data(); }
  const Byte* data() const noexcept { return bytes_.data(); }
  std::size_t size() const noexcept { return size_; }
  Byte* begin() noexcept { return data(); }
  Byte* end() noexcept { return data() + size_; }
  const Byte* begin() const noexcept { return data(); }
  const Byte* end() const noexcept { return data() + size_; }
  Byte& operator[](std::size_t i) noexcept { return bytes_[i]; }
  const Byte& operator[](std::size_t i) const noexcept { return bytes_[i]; }

 private:
  std::array<Byte, kMost> bytes_{};
  std::size_t size_{0};
};

}  // namespace haptrial::tutoring
