#include "tests/support/virtual_display.h"

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

extern char** environ;

namespace haptrial::test {
namespace {

constexpr const char* kServer = "/usr/bin/Xvfb";
constexpr int kPatience = 20000;  // [ms]

/// The few functions of Xlib that are needed, from the library that the window uses too.
class X {
 public:
  X() : library_(dlopen("libX11.so.6", RTLD_NOW)) {
    if (library_ == nullptr) {
      throw std::runtime_error(dlerror());
    }
    display_ = get<decltype(&XOpenDisplay)>("XOpenDisplay")(nullptr);
    if (display_ == nullptr) {
      throw std::runtime_error("the display does not answer");
    }
    // A session may close its window before the last event reaches it; Xlib would end the test.
    before_ =
        get<decltype(&XSetErrorHandler)>("XSetErrorHandler")([](Display*, XErrorEvent* error) {
          if (error->error_code != BadWindow) {
            std::abort();
          }
          return 0;
        });
  }
  ~X() {
    get<decltype(&XCloseDisplay)>("XCloseDisplay")(display_);  // sends what is not sent yet
    get<decltype(&XSetErrorHandler)>("XSetErrorHandler")(before_);
    dlclose(library_);
  }
  X(const X&) = delete;
  X& operator=(const X&) = delete;

  template <class Function>
  Function get(const char* name) const {
    return reinterpret_cast<Function>(dlsym(library_, name));
  }
  Display* display() const { return display_; }
  Window root() const { return get<decltype(&XDefaultRootWindow)>("XDefaultRootWindow")(display_); }
  Atom atom(const char* name) const {
    return get<decltype(&XInternAtom)>("XInternAtom")(display_, name, False);
  }

  Window find(const std::string& title) const {
    const auto release = get<decltype(&XFree)>("XFree");
    Window parent = 0;
    Window top = 0;
    Window* windows = nullptr;
    unsigned count = 0;
    get<decltype(&XQueryTree)>("XQueryTree")(display_, root(), &top, &parent, &windows, &count);
    Window found = 0;
    for (unsigned i = 0; i < count; ++i) {
      char* name = nullptr;
      get<decltype(&XFetchName)>("XFetchName")(display_, windows[i], &name);
      if (name != nullptr && title == name) {
        found = windows[i];
      }
      release(name);
    }
    release(windows);
    if (found == 0) {
      throw std::runtime_error("no window is called " + title);
    }
    return found;
  }
  void send(Window window, long mask, XEvent& event) const {
    get<decltype(&XSendEvent)>("XSendEvent")(display_, window, False, mask, &event);
  }

 private:
  void* library_;
  Display* display_{nullptr};
  XErrorHandler before_{nullptr};  // that of a window in this process
};

Time next_time() {
  static Time time = 1000;  // the window takes an event as new only if its time is
  return time += 10;
}

void send_key(const std::string& title, unsigned long keysym, int type, long mask) {
  const X x;
  XEvent event{};
  event.xkey.type = type;
  event.xkey.display = x.display();
  event.xkey.window = x.find(title);
  event.xkey.root = x.root();
  event.xkey.same_screen = True;
  event.xkey.keycode = x.get<decltype(&XKeysymToKeycode)>("XKeysymToKeycode")(x.display(), keysym);
  event.xkey.time = next_time();
  x.send(event.xkey.window, mask, event);
}

void send_button(const std::string& title, unsigned button, int type, long mask) {
  const X x;
  XEvent event{};
  event.xbutton.type = type;
  event.xbutton.display = x.display();
  event.xbutton.window = x.find(title);
  event.xbutton.root = x.root();
  event.xbutton.button = button;
  event.xbutton.time = next_time();
  event.xbutton.same_screen = True;
  x.send(event.xbutton.window, mask, event);
}

/// The number that the server writes when it is ready.
std::string display_number(int from) {
  std::string number;
  pollfd wait{from, POLLIN, 0};
  while (poll(&wait, 1, kPatience) > 0) {
    char letter = 0;
    if (read(from, &letter, 1) != 1 || letter == '\n') {
      break;
    }
    number += letter;
  }
  return number;
}

}  // namespace

VirtualDisplay::VirtualDisplay(int width, int height) : width_(width), height_(height) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error("no pipe");
  }
  constexpr int kChildEnd = 3;
  const std::string size = std::to_string(width) + "x" + std::to_string(height) + "x24";
  std::vector<std::string> words{kServer,  "-displayfd",   "3",         "-screen", "0",       size,
                                 "-fbdir", folder_.path(), "-nolisten", "tcp",     "-noreset"};
  std::vector<char*> arguments;
  for (std::string& word : words) {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], kChildEnd);
  const int failed = posix_spawn(&server_, kServer, &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  const std::string number = failed == 0 ? display_number(ends[0]) : "";
  close(ends[0]);
  if (number.empty()) {
    throw std::runtime_error("Xvfb did not start");
  }
  setenv("DISPLAY", (":" + number).c_str(), 1);
}

VirtualDisplay::~VirtualDisplay() {
  unsetenv("DISPLAY");
  end();
}

void VirtualDisplay::end() {
  if (server_ > 0) {
    kill(server_, SIGTERM);
    waitpid(std::exchange(server_, -1), nullptr, 0);
  }
}

std::vector<std::uint8_t> VirtualDisplay::screenshot() const {
  // An XWD file: big-endian words (0 the header's size, 12 bytes a row, 19 colours), then 12 bytes
  // a colour, then the pixels: blue, green, red and one unused.
  std::ifstream in(folder_ / "Xvfb_screen0", std::ios::binary);
  const std::vector<char> file{std::istreambuf_iterator<char>(in), {}};
  const auto word = [&file](std::size_t i) {
    std::size_t value = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      value = value << 8 | static_cast<unsigned char>(file.at(4 * i + k));
    }
    return value;
  };
  const std::size_t pixels = word(0) + 12 * word(19);
  std::vector<std::uint8_t> rgb;
  for (std::size_t y = 0; y < static_cast<std::size_t>(height_); ++y) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(width_); ++x) {
      for (const std::size_t channel : {2, 1, 0}) {
        rgb.push_back(static_cast<std::uint8_t>(file.at(pixels + y * word(12) + 4 * x + channel)));
      }
    }
  }
  return rgb;
}

void VirtualDisplay::relabel_keys(
    const std::vector<std::pair<unsigned long, unsigned long>>& labels) const {
  const X x;
  std::vector<KeyCode> keys;
  for (const auto& [from, to] : labels) {
    keys.push_back(x.get<decltype(&XKeysymToKeycode)>("XKeysymToKeycode")(x.display(), from));
  }
  for (std::size_t i = 0; i < labels.size(); ++i) {
    KeySym typed = labels[i].second;
    x.get<decltype(&XChangeKeyboardMapping)>("XChangeKeyboardMapping")(x.display(), keys[i], 1,
                                                                       &typed, 1);
  }
}

void VirtualDisplay::press_key(const std::string& title, unsigned long keysym) const {
  hold_key(title, keysym);
  release_key(title, keysym);
}

void VirtualDisplay::try_key(const std::string& title, unsigned long keysym) const {
  try {
    press_key(title, keysym);
  } catch (const std::exception&) {  // no such window
  }
}

void VirtualDisplay::hold_key(const std::string& title, unsigned long keysym) const {
  send_key(title, keysym, KeyPress, KeyPressMask);
}

void VirtualDisplay::release_key(const std::string& title, unsigned long keysym) const {
  send_key(title, keysym, KeyRelease, KeyReleaseMask);
}

void VirtualDisplay::press_button(const std::string& title, unsigned button) const {
  send_button(title, button, ButtonPress, ButtonPressMask);
}

void VirtualDisplay::release_button(const std::string& title, unsigned button) const {
  send_button(title, button, ButtonRelease, ButtonReleaseMask);
}

void VirtualDisplay::ask_to_close(const std::string& title) const {
  const X x;
  XEvent event{};
  event.xclient.type = ClientMessage;
  event.xclient.window = x.find(title);
  event.xclient.message_type = x.atom("WM_PROTOCOLS");
  event.xclient.format = 32;
  event.xclient.data.l[0] = static_cast<long>(x.atom("WM_DELETE_WINDOW"));
  x.send(event.xclient.window, NoEventMask, event);
}

void VirtualDisplay::destroy_window(const std::string& title) const {
  const X x;
  x.get<decltype(&XDestroyWindow)>("XDestroyWindow")(x.display(), x.find(title));
}

void VirtualDisplay::move_pointer(int px, int py) const {
  const X x;
  x.get<decltype(&XWarpPointer)>("XWarpPointer")(x.display(), None, x.root(), 0, 0, 0, 0, px, py);
}

}  // namespace haptrial::test
