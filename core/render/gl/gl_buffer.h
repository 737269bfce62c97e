#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/render/gl/gl.h"

namespace haptrial::render {

/// A run of items.
struct ItemRange {
  std::size_t first;
  std::size_t count;
};

/// The numbers as runs, in order, where runs closer than `gap` are one. Sorts the numbers.
std::vector<ItemRange> ranges_of(std::vector<std::uint32_t>& numbers, std::size_t gap);

/// An OpenGL buffer of items of one size that grows as needed; only what changed is sent.
class GlBuffer {
 public:
  GlBuffer(const Gl& gl, std::size_t item_size);
  ~GlBuffer();
  GlBuffer(const GlBuffer&) = delete;
  GlBuffer& operator=(const GlBuffer&) = delete;

  void bind(Gl::Enum target) const;
  /// Sends items; all `count` of them where there was no room.
  /// @param changed  numbers of changed items, in any order, some twice
  /// @param write    puts a run of items as they are now to a place
  /// @returns the bytes sent
  std::size_t update(std::size_t count, std::vector<std::uint32_t> changed,
                     const std::function<void(ItemRange, std::byte*)>& write);
  /// Sends all items.
  std::size_t fill(std::size_t count, const std::function<void(ItemRange, std::byte*)>& write);

 private:
  bool make_room(std::size_t count);
  std::size_t send_in_parts(ItemRange range,
                            const std::function<void(ItemRange, std::byte*)>& write);
  std::size_t send(ItemRange range, const std::function<void(ItemRange, std::byte*)>& write);

  Gl gl_;
  std::size_t item_size_;
  Gl::Name name_{0};
  std::size_t room_{0};  // items
  std::vector<std::byte> staged_;
};

}  // namespace haptrial::render
