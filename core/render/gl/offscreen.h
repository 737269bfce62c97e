#pragma once

#include <memory>

#include "core/render/gl/gl.h"
#include "core/render/gl/image.h"

namespace haptrial::render {

/// An OpenGL 3.3 core context that draws into memory, without a screen or a graphics card (OSMesa).
/// Several may live at once; each is used by one thread at a time, on which it must be current.
class OffscreenContext {
 public:
  /// Makes itself current on this thread.
  /// @param width, height  [px].
  /// @throws RunError when OSMesa offers no such context or picture size; InputError naming the package
  ///         when the library is not installed.
  OffscreenContext(int width, int height);
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  /// Later OpenGL calls of this thread go to this context.
  void make_current();
  const Gl& gl() const noexcept;
  int width() const noexcept;   // [px]
  int height() const noexcept;  // [px]

  /// Picture that was drawn so far; makes itself current. @throws RunError when drawing failed.
  Image read();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::render
