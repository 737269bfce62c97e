#include "core/render/gl/gl_buffer.h"

#include <GL/glcorearb.h>

#include <algorithm>

namespace haptrial::render {
namespace {

constexpr std::size_t kGap = 32;  // items: sending a few more is cheaper than another call

}  // namespace

std::vector<ItemRange> ranges_of(std::vector<std::uint32_t>& numbers, std::size_t gap) {
  std::sort(numbers.begin(), numbers.end());
  std::vector<ItemRange> ranges;
  for (const std::uint32_t number : numbers) {
    if (!ranges.empty() && number <= ranges.back().first + ranges.back().count + gap) {
      ranges.back().count = std::max(ranges.back().count, number + 1 - ranges.back().first);
    } else {
      ranges.push_back({number, 1});
    }
  }
  return ranges;
}

GlBuffer::GlBuffer(const Gl& gl, std::size_t item_size) : gl_(gl), item_size_(item_size) {
  gl_.gen_buffers(1, &name_);
}

GlBuffer::~GlBuffer() { gl_.delete_buffers(1, &name_); }

void GlBuffer::bind(Gl::Enum target) const { gl_.bind_buffer(target, name_); }

std::size_t GlBuffer::update(std::size_t count, std::vector<std::uint32_t> changed,
                             const std::function<void(ItemRange, std::byte*)>& write) {
  bind(GL_ARRAY_BUFFER);
  if (make_room(count)) {
    return send_in_parts({0, count}, write);
  }
  std::erase_if(changed, [&](std::uint32_t number) { return number >= count; });
  std::size_t sent = 0;
  for (const ItemRange& range : ranges_of(changed, kGap)) {
    const std::size_t end = std::min(range.first + range.count, count);
    sent += send_in_parts({range.first, end - range.first}, write);
  }
  return sent;
}

std::size_t GlBuffer::fill(std::size_t count,
                           const std::function<void(ItemRange, std::byte*)>& write) {
  bind(GL_ARRAY_BUFFER);
  make_room(count);
  return send_in_parts({0, count}, write);
}

/// @returns whether nothing is in the buffer any more
bool GlBuffer::make_room(std::size_t count) {
  if (count <= room_) {
    return false;
  }
  room_ = count + count / 8 + kGap;
  gl_.buffer_data(GL_ARRAY_BUFFER, static_cast<std::ptrdiff_t>(room_ * item_size_), nullptr,
                  GL_DYNAMIC_DRAW);
  return true;
}

std::size_t GlBuffer::send_in_parts(ItemRange range,
                                    const std::function<void(ItemRange, std::byte*)>& write) {
  constexpr std::size_t kStaged = 65536;  // items copied at once
  std::size_t sent = 0;
  const std::size_t end = range.first + range.count;
  for (std::size_t first = range.first; first < end; first += kStaged) {
    sent += send({first, std::min(kStaged, end - first)}, write);
  }
  return sent;
}

std::size_t GlBuffer::send(ItemRange range,
                           const std::function<void(ItemRange, std::byte*)>& write) {
  staged_.resize(range.count * item_size_);
  write(range, staged_.data());
  gl_.buffer_sub_data(GL_ARRAY_BUFFER, static_cast<std::ptrdiff_t>(range.first * item_size_),
                      static_cast<std::ptrdiff_t>(staged_.size()), staged_.data());
  return staged_.size();
}

}  // namespace haptrial::render
