#include "core/render/gl/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <utility>

#include "core/base/error.h"

#if defined(__SANITIZE_ADDRESS__)
/// A display's driver that is unloaded takes with it what still points to its memory, and the names
/// by which the leak checker knows it: while leaks are looked for, libraries stay.
extern "C" int dlclose(void* /*library*/) noexcept { return 0; }
#endif

namespace haptrial::render {
namespace {

std::atomic<bool> open_window{false};
std::atomic<bool> display_lost{false};

void* glfw_address(const char* name) { return reinterpret_cast<void*>(glfwGetProcAddress(name)); }

std::string last_error() {
  const char* text = nullptr;
  return glfwGetError(&text) != GLFW_NO_ERROR && text != nullptr ? text : "no reason given";
}

template <class Function>
Function loaded(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_DEFAULT, name));
}

/// Xlib calls exit() when its server is gone, or when another program has destroyed the window.
/// Here the loss is noted instead, and what is drawn goes nowhere. The functions are looked up,
/// since GLFW for Wayland comes without Xlib.
void outlive_display() {
  using Lost = int (*)(void* display);
  using Refused = int (*)(void* display, void* error);
  using Exit = void (*)(void* display, void* with);
  const auto display = loaded<void* (*)()>("glfwGetX11Display");
  const auto on_loss = loaded<Lost (*)(Lost)>("XSetIOErrorHandler");
  const auto on_exit = loaded<void (*)(void*, Exit, void*)>("XSetIOErrorExitHandler");
  const auto on_refusal = loaded<Refused (*)(Refused)>("XSetErrorHandler");
  display_lost = false;
  if (display != nullptr && on_loss != nullptr && on_exit != nullptr && on_refusal != nullptr) {
    on_refusal([](void*, void*) {
      display_lost = true;
      return 0;
    });
    on_loss([](void*) {
      display_lost = true;
      return 0;
    });
    on_exit(
        display(), [](void*, void*) {}, nullptr);
  }
}

/// GLFW is started for one window and ended with it.
class Library {
 public:
  Library() {
    if (open_window.exchange(true)) {
      throw RunError("a window is open already; close it first");
    }
    if (glfwInit() != GLFW_TRUE) {
      const std::string reason = last_error();
      open_window = false;
      throw RunError(fmt::format(
          "no window can be opened ({}); set DISPLAY to the name of a display", reason));
    }
    outlive_display();
  }
  ~Library() {
    glfwTerminate();
    open_window = false;
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
};

GLFWmonitor* chosen_monitor(int number) {
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  if (count < 1) {
    throw RunError("the display has no monitor, so no window can be opened");
  }
  if (number < 0 || number >= count) {
    throw InputError(
        fmt::format("screen.monitor is {}; allowed: 0 to {} on this display", number, count - 1));
  }
  return monitors[number];
}

struct DestroyWindow {
  void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

/// The capital letter, digit or sign that the keyboard's layout gives to a key. A key of another
/// alphabet, and a digit that is typed with Shift, count by their place on a US keyboard.
int character_of(int glfw_key) {
  const char* name = glfwGetKeyName(glfw_key, 0);
  const bool ascii = name != nullptr && name[0] > ' ' && name[0] < 0x7f && name[1] == '\0';
  const bool is_digit_key = glfw_key >= GLFW_KEY_0 && glfw_key <= GLFW_KEY_9;
  if (ascii && (!is_digit_key || is_letter_or_digit(name[0]))) {
    return name[0] >= 'a' && name[0] <= 'z' ? name[0] - 'a' + 'A' : name[0];
  }
  return glfw_key >= GLFW_KEY_SPACE && glfw_key <= GLFW_KEY_GRAVE_ACCENT ? glfw_key
                                                                         : KeyPress::kOther;
}

int key_of(int glfw_key) {
  if (glfw_key >= GLFW_KEY_KP_0 && glfw_key <= GLFW_KEY_KP_9) {
    return '0' + (glfw_key - GLFW_KEY_KP_0);
  }
  switch (glfw_key) {
    case GLFW_KEY_ESCAPE:
      return KeyPress::kEscape;
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER:
      return KeyPress::kEnter;
    case GLFW_KEY_TAB:  // says a spoken text again
      return GLFW_KEY_TAB;
    case GLFW_KEY_BACKSPACE:
      return KeyPress::kBackspace;
    case GLFW_KEY_RIGHT:
      return KeyPress::kRight;
    case GLFW_KEY_LEFT:
      return KeyPress::kLeft;
    case GLFW_KEY_DOWN:
      return KeyPress::kDown;
    case GLFW_KEY_UP:
      return KeyPress::kUp;
    default:
      return character_of(glfw_key);
  }
}

/// A key that is held, with the code that it had when it went down: the layout may change
/// meanwhile.
struct HeldKey {
  int glfw_key;
  int code;
};

}  // namespace

struct Window::Impl {
  Library library;
  std::unique_ptr<GLFWwindow, DestroyWindow> window;
  Gl gl{};
  int width{0};
  int height{0};
  double refresh_rate{0.0};
  std::vector<KeyPress> keys;
  std::vector<HeldKey> held;
  bool repeats{false};  // the newest press is that of a key that was down already
  Pointer pointer;
  std::uint32_t pressed{0};  // buttons that went down in the last poll, and may be up again

  void open(const WindowOptions& options);
  void listen();
  void point_at(double x, double y);
  static Impl& of(GLFWwindow* window) {
    return *static_cast<Impl*>(glfwGetWindowUserPointer(window));
  }
};

void Window::Impl::open(const WindowOptions& options) {
  GLFWmonitor* monitor = chosen_monitor(options.monitor);
  const GLFWvidmode* mode = glfwGetVideoMode(monitor);
  refresh_rate = std::max(0, mode->refreshRate);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_RESIZABLE, GLFW_FALSE);
  glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);  // the experimenter may use another monitor
  glfwWindowHint(GLFW_DEPTH_BITS, 24);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_RED_BITS, mode->redBits);  // as the monitor has them: no mode is changed
  glfwWindowHint(GLFW_GREEN_BITS, mode->greenBits);
  glfwWindowHint(GLFW_BLUE_BITS, mode->blueBits);
  glfwWindowHint(GLFW_REFRESH_RATE, mode->refreshRate);
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  const bool full = options.full_screen;
  window.reset(glfwCreateWindow(full ? mode->width : options.width,
                                full ? mode->height : options.height, options.title.c_str(),
                                full ? monitor : nullptr, nullptr));
  if (!window) {
    throw RunError(fmt::format("no window with OpenGL 3.3 can be opened: {}", last_error()));
  }
  if (!full) {
    int x = 0;
    int y = 0;
    glfwGetMonitorPos(monitor, &x, &y);
    glfwSetWindowPos(window.get(), x + std::max(0, (mode->width - options.width) / 2),
                     y + std::max(0, (mode->height - options.height) / 2));
  }
  listen();
  glfwShowWindow(window.get());
  glfwSetInputMode(window.get(), GLFW_CURSOR, GLFW_CURSOR_HIDDEN);
  glfwMakeContextCurrent(window.get());
  gl = load_gl(&glfw_address);
  glfwSwapInterval(options.refresh_lock ? 1 : 0);
  glfwGetFramebufferSize(window.get(), &width, &height);
  double x = 0.0;
  double y = 0.0;
  glfwGetCursorPos(window.get(), &x, &y);
  point_at(x, y);
  glfwGetError(nullptr);  // an answer that is not needed (swap interval) is no failure
}

void Window::Impl::listen() {
  glfwSetWindowUserPointer(window.get(), this);
  glfwSetKeyCallback(window.get(), [](GLFWwindow* w, int key, int, int action, int) {
    if (action == GLFW_RELEASE) {  // also when another window takes the keyboard
      std::erase_if(of(w).held, [key](const HeldKey& each) { return each.glfw_key == key; });
      return;
    }
    of(w).repeats = action == GLFW_REPEAT;
    if (action == GLFW_PRESS) {
      of(w).keys.push_back({key_of(key)});
      of(w).held.push_back({key, key_of(key)});
    }
  });
  glfwSetCharCallback(window.get(), [](GLFWwindow* w, unsigned int character) {
    if (!of(w).repeats) {  // a finger that rests on a key makes no number longer
      of(w).keys.push_back({KeyPress::kOther, static_cast<char32_t>(character)});
    }
  });
  glfwSetCursorPosCallback(window.get(),
                           [](GLFWwindow* w, double x, double y) { of(w).point_at(x, y); });
  glfwSetScrollCallback(window.get(),
                        [](GLFWwindow* w, double, double y) { of(w).pointer.wheel += y; });
  glfwSetMouseButtonCallback(window.get(), [](GLFWwindow* w, int button, int action, int) {
    const std::uint32_t bit = button < 32 ? 1u << button : 0u;
    std::uint32_t& buttons = of(w).pointer.buttons;
    buttons = action == GLFW_PRESS ? buttons | bit : buttons & ~bit;
    of(w).pressed |= action == GLFW_PRESS ? bit : 0u;
  });
}

/// GLFW counts in the window's own units; some displays give these several pixels.
void Window::Impl::point_at(double x, double y) {
  int units = 0;
  glfwGetWindowSize(window.get(), &units, nullptr);
  const double scale = units > 0 ? static_cast<double>(width) / units : 1.0;
  pointer.position = {scale * x, scale * y};
}

Window::Window(const WindowOptions& options) : impl_(std::make_unique<Impl>()) {
  impl_->open(options);
}

Window::~Window() = default;

const Gl& Window::gl() const noexcept { return impl_->gl; }
int Window::width() const noexcept { return impl_->width; }
int Window::height() const noexcept { return impl_->height; }
double Window::refresh_rate() const noexcept { return impl_->refresh_rate; }

void Window::poll() {
  impl_->pressed = 0;
  glfwPollEvents();
  if (display_lost) {
    throw RunError("the display is gone: its server ended, or the window was killed");
  }
}

void Window::swap() {
  glfwSwapBuffers(impl_->window.get());
  impl_->gl.finish();  // else the driver may queue pictures, and the time would not be that of one
}

Image Window::read() { return read_frame(impl_->gl, impl_->width, impl_->height); }

bool Window::close_asked() const { return glfwWindowShouldClose(impl_->window.get()) != 0; }
std::vector<KeyPress> Window::take_keys() { return std::exchange(impl_->keys, {}); }
std::vector<int> Window::held_keys() const {
  std::vector<int> codes;
  for (const HeldKey& key : impl_->held) {
    codes.push_back(key.code);
  }
  return codes;
}
Pointer Window::pointer() const {
  Pointer pointer = impl_->pointer;
  pointer.buttons |= impl_->pressed;
  return pointer;
}

}  // namespace haptrial::render
