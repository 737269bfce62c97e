#include "experiments/control/keyboard.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/base/utf8.h"
#include "core/realtime/real_time.h"

namespace haptrial::experiments {
namespace {

constexpr char kEscape = '\x1b';
constexpr int kPriority = 60;  // of SCHED_FIFO, below the servo thread's

// Settings with which a signal handler puts the terminal back.
termios saved;
std::atomic<int> saved_terminal{-1};
static_assert(std::atomic<int>::is_always_lock_free);

constexpr std::array kEndings{SIGHUP, SIGQUIT, SIGABRT, SIGSEGV, SIGBUS,
                              SIGFPE, SIGILL,  SIGINT,  SIGTERM};
std::array<struct sigaction, kEndings.size()> before;

extern "C" void put_back_and_end(int signal) {
  restore_terminal();
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

/// Only signals that nobody else handles: who handles one unwinds, and so comes to the destructor.
void watch_signals() {
  for (std::size_t i = 0; i < kEndings.size(); ++i) {
    ::sigaction(kEndings[i], nullptr, &before[i]);
    if (before[i].sa_handler == SIG_DFL && (before[i].sa_flags & SA_SIGINFO) == 0) {
      struct sigaction ours {};
      ours.sa_handler = put_back_and_end;
      ::sigaction(kEndings[i], &ours, nullptr);
    }
  }
}

void unwatch_signals() {
  for (std::size_t i = 0; i < kEndings.size(); ++i) {
    struct sigaction now {};
    ::sigaction(kEndings[i], nullptr, &now);
    if (now.sa_handler == put_back_and_end) {
      ::sigaction(kEndings[i], &before[i], nullptr);
    }
  }
}

/// Sets the terminal, also from the background, where the system would otherwise suspend the
/// program.
void set_terminal(int terminal, const termios& wanted) {
  sigset_t background;
  sigset_t previous;
  ::sigemptyset(&background);
  ::sigaddset(&background, SIGTTOU);
  ::pthread_sigmask(SIG_BLOCK, &background, &previous);
  ::tcsetattr(terminal, TCSANOW, &wanted);
  ::pthread_sigmask(SIG_SETMASK, &previous, nullptr);
}

}  // namespace

void restore_terminal() noexcept {
  const int error = errno;
  const int terminal = saved_terminal.load();
  if (terminal >= 0) {
    ::tcsetattr(terminal, TCSANOW, &saved);
  }
  errno = error;
}

class Keyboard::Implementation {
 public:
  Implementation(SessionControl& control, int input, int output)
      : control_(control), input_(input), output_(output) {
    int nobody = -1;
    if (!can_read(input) || ::tcgetattr(input, &original_) != 0 ||
        !saved_terminal.compare_exchange_strong(nobody, -2)) {
      return;
    }
    stop_ = ::eventfd(0, EFD_CLOEXEC);
    if (stop_ < 0) {
      saved_terminal.store(-1);
      throw RunError("the keyboard cannot make an event");
    }
    saved = original_;
    [[maybe_unused]] static const int at_exit = std::atexit(restore_terminal);
    saved_terminal.store(input);
    watch_signals();
    termios single = original_;
    single.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    single.c_iflag &= ~static_cast<tcflag_t>(IXON);  // Ctrl-S would hold up whoever prints
    single.c_cc[VMIN] = 1;
    single.c_cc[VTIME] = 0;
    single.c_cc[VSUSP] = _POSIX_VDISABLE;
    set_terminal(input, single);
    follows_ = ::isatty(output) != 0;
    thread_ = std::thread([this] { read_keys(); });
  }

  ~Implementation() {
    if (!active()) {
      return;
    }
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(stop_, &one, sizeof one);
    thread_.join();
    show("");
    set_terminal(input_, original_);
    unwatch_signals();
    saved_terminal.store(-1);
    ::close(stop_);
  }

  bool active() const { return thread_.joinable(); }

 private:
  enum class Mode { kKeys, kConfirmAbort, kNote, kBadTrial, kAnswer };

  /// @returns whether a key came within `milliseconds` (-1: any time).
  bool wait(int milliseconds) {
    std::array<pollfd, 2> watched{{{input_, POLLIN, 0}, {stop_, POLLIN, 0}}};
    int count = 0;
    do {
      count = ::poll(watched.data(), watched.size(), milliseconds);
    } while (count < 0 && errno == EINTR);
    if (watched[1].revents != 0 || count < 0) {
      ended_ = true;
      return false;
    }
    return count > 0;
  }

  void read_keys() {
    const realtime::RealTimeScope ahead_of_others(kPriority);
    std::array<char, 64> keys;
    while (!ended_) {
      constexpr int kBetweenStatus = 1000;  // [ms]
      if (!wait(follows_ ? kBetweenStatus : -1)) {
        show_status();
        continue;
      }
      const ssize_t count = ::read(input_, keys.data(), keys.size());
      if (count <= 0) {
        ended_ = count == 0 || errno != EINTR;
        continue;
      }
      take(without_rest({keys.data(), static_cast<std::size_t>(count)}));
    }
  }

  /// An arrow key is an escape too. A terminal sends it whole; where a slow line tore it apart its
  /// escape has stopped the session, since a stop does not wait, and the rest means nothing.
  std::string_view without_rest(std::string_view keys) {
    constexpr std::chrono::milliseconds kTorn{50};
    const bool torn = std::chrono::steady_clock::now() - escaped_ < kTorn;
    escaped_ = {};
    return torn && !keys.empty() && is_introducer(keys.front()) ? after_sequence(keys) : keys;
  }

  static bool is_introducer(char key) { return key == '[' || key == 'O'; }
  static std::string_view after_sequence(std::string_view keys) {
    const auto end = keys.find_first_not_of("[O0123456789;");
    return end == std::string_view::npos ? "" : keys.substr(end + 1);
  }

  /// How a drilling stands: one line that is written over, where somebody looks at it.
  void show_status() {
    if (ended_ || mode_ != Mode::kKeys) {
      return;
    }
    const SessionStatus status = control_.status();
    if (status.asked.number > shown_) {
      show_asked(status.asked);
    }
    if (status.figures && (status.state == "running" || status.state == "practice")) {
      say(fit((status.simulated ? "SIMULATED " : "") + status.figures->line));
      status_shown_ = true;
    }
  }

  /// Cut to the terminal's width: a line that wraps could not be written over.
  std::string fit(std::string line) const {
    winsize size{};
    if (::ioctl(output_, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 && line.size() >= size.ws_col) {
      line.resize(size.ws_col - 1U);
    }
    return "\r" + line + "\x1b[K";
  }

  void take(std::string_view keys) {
    while (!keys.empty()) {
      const char key = keys.front();
      keys.remove_prefix(1);
      if (key == kEscape && !keys.empty() && is_introducer(keys.front())) {
        keys = after_sequence(keys);
      } else if (key == kEscape) {
        escaped_ = std::chrono::steady_clock::now();
        control_.ask(Request::kEmergencyStop, RequestSource::kTerminal);
        leave_mode();
        show("emergency stop\n");
      } else {
        take_key(key);
      }
    }
  }

  void take_key(char key) {
    switch (mode_) {
      case Mode::kKeys:
        command(key);
        break;
      case Mode::kConfirmAbort:
        mode_ = Mode::kKeys;
        if (key == 'y' || key == 'Y') {
          ask(Request::kAbort, "stopped: resume the session with --resume\n");
        } else if (key == 'e' || key == 'E') {
          ask(Request::kEnd, "ended for good\n");
        } else {
          show("not aborted\n");
        }
        break;
      case Mode::kNote:
      case Mode::kBadTrial:
      case Mode::kAnswer:
        type(key);
        break;
    }
  }

  /// Shows a page's question, so that it can be answered here: once by itself, and whenever Enter
  /// asks.
  void show_asked(const AskedItem& asked) {
    shown_ = asked.number;
    std::string lines = asked.title + (asked.title.empty() ? "" : "\n") + asked.text + "\n";
    for (std::size_t i = 0; i < asked.choices.size(); ++i) {
      lines += "  " + std::to_string(i + 1) + "  " + asked.choices[i] + "\n";
    }
    if (!asked.picture_file.empty()) {
      lines += "  (picture: " + asked.picture_file + ")\n";
    }
    if (!asked.low_end.empty()) {
      lines += "  " + asked.low_end + " ... " + asked.high_end + "\n";
    }
    if (!asked.given.empty()) {
      lines += "  answer so far: " + asked.given + "\n";
    }
    lines += asked.back ? "Backspace: back\n" : "";
    show(lines + (asked.consents
                      ? "The participant answers in the window. If a paper form is signed: Enter, "
                        "then 1: and the reason\n"
                      : "Enter: answer\n"));
  }

  void begin_answer() {
    const AskedItem asked = control_.status().asked;
    if (asked.number == 0) {
      return;
    }
    if (!asked.asks) {
      control_.answer(asked.number, "", RequestSource::kTerminal);
      return;
    }
    answered_ = asked.number;
    note_.clear();
    mode_ = Mode::kAnswer;
    show("answer: ");
  }

  void command(char key) {
    switch (key) {
      case ' ':
        start_or_pause();
        break;
      case '\n':
      case '\r':
        begin_answer();
        break;
      case '\b':
      case '\x7f':
        if (control_.status().asked.back) {
          ask(Request::kBack, "back\n");
        }
        break;
      case 'p':
        ask(Request::kPause, "pause\n");
        break;
      case 'r':
        ask(Request::kRepeatTrial, "repeat this trial\n");
        break;
      case 'u':
        if (control_.status().can_take_back) {
          ask(Request::kTakeBack, "take back the last answer\n");
        }
        break;
      case 's':
        ask(Request::kSkipTrial, "skip this trial\n");
        break;
      case 'c':
        ask(Request::kClear, "clear\n");
        break;
      case 'a':
        mode_ = Mode::kConfirmAbort;
        show("stop the session? y: for now (it can be resumed), e: for good, any other key: no ");
        break;
      case 'n':
        mode_ = Mode::kNote;
        note_.clear();
        show("note: ");
        break;
      case 'b':
        mode_ = Mode::kBadTrial;
        note_.clear();
        show("why the trial is bad: ");
        break;
      default:
        break;
    }
  }

  void start_or_pause() {
    const std::string state = control_.status().state;
    if (state == "running" || state == "practice") {
      ask(Request::kPause, "pause\n");
    } else if (state != "stopped" && state != "ended") {
      ask(Request::kStart, "start\n");
    }
  }

  void type(char key) {
    constexpr std::size_t kLongest = 500;
    if (key == '\n' || key == '\r') {
      if (mode_ == Mode::kAnswer) {
        control_.answer(answered_, note_, RequestSource::kTerminal);
      } else if (!note_.empty()) {
        control_.note(note_, mode_ == Mode::kBadTrial);
      }
      leave_mode();
    } else if (key == '\x7f' || key == '\b') {
      erase_last();
    } else if ((key >= 0 && key < ' ') || note_.size() >= kLongest) {
      return;
    } else {
      note_ += key;
      show({&key, 1});
    }
  }

  void erase_last() {
    if (note_.empty()) {
      return;
    }
    note_.resize(whole_characters(note_, note_.size() - 1));
    show("\b \b");
  }

  void leave_mode() {
    if (mode_ != Mode::kKeys) {
      show("\n");
    }
    mode_ = Mode::kKeys;
    note_.clear();
  }

  void ask(Request request, std::string_view what) {
    control_.ask(request, RequestSource::kTerminal);
    show(what);
  }

  void show(std::string_view text) {
    if (std::exchange(status_shown_, false)) {
      say("\n");
    }
    say(text);
  }

  /// Writes only if there is room: a screen that hangs must not keep the next key waiting.
  void say(std::string_view text) const {
    pollfd room{output_, POLLOUT, 0};
    if (output_ >= 0 && ::poll(&room, 1, 0) == 1) {
      [[maybe_unused]] const ssize_t written = ::write(output_, text.data(), text.size());
    }
  }

  SessionControl& control_;
  int input_;
  int output_;
  int stop_{-1};
  bool follows_{false};  // the output is a terminal
  bool status_shown_{false};
  bool ended_{false};
  Mode mode_{Mode::kKeys};
  int shown_{0};     // the last question of a page that was printed
  int answered_{0};  // the one that is being answered
  std::string note_;
  std::chrono::steady_clock::time_point escaped_{};  // the last key was an escape
  termios original_{};
  std::thread thread_;
};

Keyboard::Keyboard(SessionControl& control, int input, int output)
    : implementation_(std::make_unique<Implementation>(control, input, output)) {}

Keyboard::~Keyboard() = default;

bool Keyboard::can_read(int input) {
  return ::isatty(input) != 0 && ::tcgetpgrp(input) == ::getpgrp();
}

bool Keyboard::active() const { return implementation_->active(); }

const char* Keyboard::help() {
  return "space start/pause   p pause   r repeat this trial   s skip   u take back the last "
         "answer\n"
         "n note   b bad trial   a abort\n"
         "Escape EMERGENCY STOP   c clear   Enter answer a page";
}

}  // namespace haptrial::experiments
