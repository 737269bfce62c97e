#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>

namespace haptrial::stimulus {

/// The participant's picture at one instant: a value of a type that the protocol owns, its view.
/// The screen, pictures and virtual participants get it whole; the code that draws a protocol knows
/// its type.
///
/// A view is plain data of at most kRoom bytes with `bool engaged() const`: whether the participant
/// has something to do. Servo thread: copying neither allocates nor throws.
class Shown {
 public:
  static constexpr std::size_t kRoom = 2048;

  /// Nothing but where the tool is: between passes.
  Shown() noexcept = default;
  explicit Shown(const Eigen::Vector3d& where) noexcept : tool(where) {}
  Shown(const Shown& other) noexcept { *this = other; }
  Shown& operator=(const Shown& other) noexcept {
    tool = other.tool;
    type_ = other.type_;
    size_ = other.size_;
    engaged_ = other.engaged_;
    std::memmove(room_.data(), other.room_.data(), size_);
    return *this;
  }
  template <class View>
  requires(!std::is_same_v<View, Shown> && !std::is_convertible_v<View, Eigen::Vector3d>)
      Shown(const View& view)
  noexcept  // implicit: a view is shown as it is
      : type_(&kType<View>), size_(sizeof(View)), engaged_(view.engaged()) {
    static_assert(sizeof(View) <= kRoom && alignof(View) <= kAlignment);
    static_assert(std::is_trivially_destructible_v<View>, "a view is plain data");
    std::memcpy(room_.data(), static_cast<const void*>(&view), sizeof(View));
    if constexpr (requires { tool = view.tool; }) {
      tool = view.tool;
    }
  }

  /// The view; null if it is of another type, or there is none.
  template <class View>
  const View* as() const noexcept {
    return type_ == &kType<View> ? reinterpret_cast<const View*>(room_.data()) : nullptr;
  }
  bool engaged() const noexcept { return engaged_; }

  Eigen::Vector3d tool{Eigen::Vector3d::Zero()};  // of the first device, p_W [m]

 private:
  template <class View>
  static constexpr char kType = 0;
  static constexpr std::size_t kAlignment = 16;

  // Copied and filled many times a tick: no more of it than the view takes is ever touched.
  alignas(kAlignment) std::array<std::byte, kRoom> room_;
  const char* type_{nullptr};
  std::size_t size_{0};  // of the view
  bool engaged_{false};
};

}  // namespace haptrial::stimulus
