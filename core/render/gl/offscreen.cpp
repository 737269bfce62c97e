#include "core/render/gl/offscreen.h"

#include <GL/osmesa.h>
#include <fmt/format.h>

#include <array>
#include <vector>

#include "core/base/dynamic_library.h"
#include "core/base/error.h"

namespace haptrial::render {
namespace {

constexpr int kBufferChannels = 4;

/// OSMesa, loaded with the first context and never unloaded: it brings LLVM, whose loading takes
/// longer than most commands, and its threads may still run when the program ends.
struct Osmesa {
  DynamicLibrary library{"libOSMesa.so.8", "Debian's package libosmesa6"};
  decltype(&OSMesaCreateContextAttribs) create{};
  decltype(&OSMesaDestroyContext) destroy{};
  decltype(&OSMesaMakeCurrent) make_current{};
  decltype(&OSMesaGetIntegerv) get_integer{};
  decltype(&OSMesaGetProcAddress) get_address{};

  Osmesa() {
    library.get(create, "OSMesaCreateContextAttribs");
    library.get(destroy, "OSMesaDestroyContext");
    library.get(make_current, "OSMesaMakeCurrent");
    library.get(get_integer, "OSMesaGetIntegerv");
    library.get(get_address, "OSMesaGetProcAddress");
  }
};

/// @throws InputError when the library cannot be loaded.
const Osmesa& osmesa() {
  static const Osmesa& loaded = *new Osmesa;
  return loaded;
}

void* osmesa_address(const char* name) {
  return reinterpret_cast<void*>(osmesa().get_address(name));
}

struct DestroyContext {
  void operator()(osmesa_context* context) const { osmesa().destroy(context); }
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
  impl_->context.reset(osmesa().create(kAttributes.data(), nullptr));
  if (!impl_->context) {
    throw RunError("OSMesa gives no OpenGL 3.3 core context, so nothing can be drawn off screen");
  }
  GLint largest = 0;
  osmesa().get_integer(OSMESA_MAX_WIDTH, &largest);
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
  if (osmesa().make_current(impl_->context.get(), impl_->pixels.data(), GL_UNSIGNED_BYTE,
                            impl_->width, impl_->height) != GL_TRUE) {
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
