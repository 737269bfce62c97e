#include "core/render/gl/offscreen.h"

#include <GL/osmesa.h>
#include <fmt/format.h>

#include <array>
#include <vector>

#include "core/base/error.h"

namespace haptrial::render {
namespace {

constexpr int kBufferChannels = 4;

void* osmesa_address(const char* name) {
  return reinterpret_cast<void*>(OSMesaGetProcAddress(name));
}

struct DestroyContext {
  void operator()(osmesa_context* context) const { OSMesaDestroyContext(context); }
};

}  // namespace

struct OffscreenContext::Impl {
  int width;
  int height;
  std::vector<unsigned char> pixels;  // drawn into by OSMesa; outlives the context
  std::unique_ptr<osmesa_context, DestroyContext> context;
  Gl gl{};
};

OffscreenContext::OffscreenContext(int width, int height)
    : impl_(std::make_unique<Impl>(Impl{width, height, {}, nullptr})) {
  constexpr std::array kAttributes{OSMESA_FORMAT,
                                   OSMESA_RGBA,
                                   OSMESA_DEPTH_BITS,
                                   24,
                                   OSMESA_PROFILE,
                                   OSMESA_CORE_PROFILE,
                                   OSMESA_CONTEXT_MAJOR_VERSION,
                                   3,
                                   OSMESA_CONTEXT_MINOR_VERSION,
                                   3,
                                   0};
  impl_->context.reset(OSMesaCreateContextAttribs(kAttributes.data(), nullptr));
  if (!impl_->context) {
    throw RunError("OSMesa gives no OpenGL 3.3 core context, so nothing can be drawn off screen");
  }
  GLint largest = 0;
  OSMesaGetIntegerv(OSMESA_MAX_WIDTH, &largest);
  if (width < 1 || height < 1 || width > largest || height > largest) {
    throw RunError(
        fmt::format("a picture of {} x {} pixels cannot be drawn off screen; allowed: "
                    "1 to {} pixels a side",
                    width, height, largest));
  }
  impl_->pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                       kBufferChannels);
  make_current();
  impl_->gl = load_gl(&osmesa_address);
}

OffscreenContext::~OffscreenContext() = default;

void OffscreenContext::make_current() {
  if (OSMesaMakeCurrent(impl_->context.get(), impl_->pixels.data(), GL_UNSIGNED_BYTE, impl_->width,
                        impl_->height) != GL_TRUE) {
    throw RunError(fmt::format("OSMesa cannot draw into a picture of {} x {} pixels", impl_->width,
                               impl_->height));
  }
}

const Gl& OffscreenContext::gl() const noexcept { return impl_->gl; }
int OffscreenContext::width() const noexcept { return impl_->width; }
int OffscreenContext::height() const noexcept { return impl_->height; }

Image OffscreenContext::read() {
  make_current();
  return read_frame(impl_->gl, impl_->width, impl_->height);
}

}  // namespace haptrial::render
