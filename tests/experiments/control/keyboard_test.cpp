#include "experiments/control/keyboard.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "experiments/console/console_messages.h"

namespace haptrial::experiments {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A terminal whose keys the test presses. The program behind it is a child with the terminal as
/// its own, as under a shell.
class Terminal {
 public:
  /// @param program  runs in the child on the terminal; its result is the exit status.
  explicit Terminal(int (*program)()) {
    std::array<int, 2> go{};
    if (::pipe(go.data()) != 0) {
      throw std::runtime_error("no pipe");
    }
    child_ = ::forkpty(&screen_, nullptr, nullptr, nullptr);
    ::close(go[child_ == 0 ? 1 : 0]);
    if (child_ == 0) {
      char nothing = 0;
      ::_exit(::read(go[0], &nothing, 1) == 0 ? program() : 99);  // waits for the close below
    }
    first_modes_ = local_modes();
    ::close(go[1]);
  }
  ~Terminal() {
    if (child_ > 0) {
      ::kill(child_, SIGKILL);
      ::waitpid(child_, nullptr, 0);
    }
    ::close(screen_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void press(const std::string& keys) const {
    ASSERT_EQ(::write(screen_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  }

  /// Waits until this comes to the screen; earlier finds are behind. @returns false if the program
  /// ended before.
  bool shows(const std::string& text) {
    for (;;) {
      if (const auto at = screen_text_.find(text); at != std::string::npos) {
        screen_text_.erase(0, at + text.size());
        return true;
      }
      std::array<char, 512> piece;
      const ssize_t count = ::read(screen_, piece.data(), piece.size());
      if (count <= 0) {
        return false;
      }
      screen_text_.append(piece.data(), static_cast<std::size_t>(count));
    }
  }

  tcflag_t local_modes() const {
    termios modes{};
    ::tcgetattr(screen_, &modes);
    return modes.c_lflag;
  }

  tcflag_t first_modes() const { return first_modes_; }  // before the program ran

  void signal(int number) const { ::kill(child_, number); }

  int wait_for_end() {
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = -1;
    return status;
  }

  const std::string& rest() const { return screen_text_; }

 private:
  int screen_{-1};
  pid_t child_{-1};
  tcflag_t first_modes_{0};
  std::string screen_text_;
};

void print(const std::string& text) {
  [[maybe_unused]] const ssize_t written = ::write(1, text.data(), text.size());
}

/// Prints each message that the session would get as "<pause>", and follows start and pause.
int session_with_keyboard(bool exits) {
  SessionControl control;
  SessionStatus status;
  status.state = "instructions";
  control.publish(status);
  {
    const Keyboard keyboard(control, 0, -1);
    print(keyboard.active() ? "<active>" : "<quiet>");
    for (bool goes_on = true; goes_on;) {
      for (const auto& message : control.take()) {
        const std::string name = message.is_note ? message.text : name_of(message.request);
        if (name == "start" || name == "pause") {
          status.state = name == "start" ? "running" : "paused";
        } else if (name == "emergency_stop") {
          status.state = "stopped";
        } else if (name == "clear") {
          status.state = "paused";
        }
        control.publish(status);
        print("<" + name + ">");
        if (name == "abort" && exits) {
          std::exit(5);
        }
        goes_on = goes_on && name != "abort";
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  print("<left>");
  return 7;
}

int session() { return session_with_keyboard(false); }
int session_that_exits() { return session_with_keyboard(true); }

class KeyboardTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (::access("/dev/pts/ptmx", F_OK) != 0) {
      GTEST_SKIP() << "no pseudo-terminals here: /dev/pts is not mounted";
    }
  }
  void expect(const std::string& keys, const std::string& message) {
    terminal_.press(keys);
    EXPECT_TRUE(terminal_.shows("<" + message + ">")) << keys << ": " << terminal_.rest();
  }

  Terminal terminal_{session};
};

TEST_F(KeyboardTest, KeysAskWhatTheirNamesSay) {
  ASSERT_TRUE(terminal_.shows("<active>"));
  expect(" ", "start");
  expect(" ", "pause");
  expect(" ", "start");
  expect("p", "pause");
  expect("r", "repeat");
  expect("s", "skip");
  expect("nhand slips\r", "hand slips");
  expect("\x1b", "emergency_stop");
  expect("c", "clear");
  expect("ay", "abort");
  EXPECT_TRUE(terminal_.shows("<left>"));
  EXPECT_EQ(WEXITSTATUS(terminal_.wait_for_end()), 7);
}

TEST_F(KeyboardTest, SpaceNeitherStartsNorPausesWhatIsStopped) {
  ASSERT_TRUE(terminal_.shows("<active>"));
  expect("\x1b", "emergency_stop");
  terminal_.press("   x?1\t");
  expect("c", "clear");  // nothing before it
  EXPECT_EQ(terminal_.rest().find('<'), std::string::npos);
  expect(" ", "start");
}

TEST_F(KeyboardTest, AbortNeedsItsYes) {
  ASSERT_TRUE(terminal_.shows("<active>"));
  terminal_.press("ap");
  expect("r", "repeat");
  terminal_.press("an");  // no, and not a note
  expect("s", "skip");
  terminal_.press("a");
  expect("\x1b", "emergency_stop");
  terminal_.press("y");
  expect("c", "clear");
}

TEST_F(KeyboardTest, ANoteIsEditedAndGivenUp) {
  ASSERT_TRUE(terminal_.shows("<active>"));
  expect(
      "nabx\x7f"
      "c p\r",
      "abc p");
  expect("n\xC3\xA4\xC3\xB6\x7f!\r", "\xC3\xA4!");  // a whole letter goes
  terminal_.press("n\x7f\r");                       // empty: none
  terminal_.press("nhalf");
  expect("\x1b", "emergency_stop");  // also amid a note
  expect("c", "clear");
}

TEST_F(KeyboardTest, ArrowKeysAreNoEscape) {
  ASSERT_TRUE(terminal_.shows("<active>"));
  terminal_.press("\x1b[A\x1b[1;5C\x1bOP\x1b[3~");
  expect("r", "repeat");
  EXPECT_EQ(terminal_.rest().find('<'), std::string::npos);
  expect("\x1b\x1b\x1b", "emergency_stop");
  EXPECT_TRUE(terminal_.shows("<emergency_stop>"));
  EXPECT_TRUE(terminal_.shows("<emergency_stop>"));
}

TEST_F(KeyboardTest, AnArrowKeyThatASlowLineTearsApartStopsAndAsksNothingElse) {
  ASSERT_TRUE(terminal_.shows("<active>"));
  expect("\x1b", "emergency_stop");  // which is not kept waiting for the rest
  terminal_.press("[1;5Cr");
  EXPECT_TRUE(terminal_.shows("<repeat>")) << terminal_.rest();
  EXPECT_EQ(terminal_.rest().find('<'), std::string::npos) << "nothing but the key behind it";
}

TEST_F(KeyboardTest, TheTerminalIsPutBackAtTheEnd) {
  ASSERT_TRUE(terminal_.shows("<active>"));
  EXPECT_EQ(terminal_.local_modes() & (ICANON | ECHO), 0u);
  EXPECT_NE(terminal_.local_modes() & ISIG, 0u) << "Ctrl-C interrupts";
  terminal_.press("\x1a\x13");  // Ctrl-Z, Ctrl-S
  expect("r", "repeat");
  terminal_.press("ay");
  ASSERT_TRUE(terminal_.shows("<left>"));
  EXPECT_EQ(terminal_.local_modes(), terminal_.first_modes());
}

TEST_F(KeyboardTest, TheTerminalIsPutBackWhenALibraryEndsTheProgram) {
  Terminal terminal(session_that_exits);
  ASSERT_TRUE(terminal.shows("<active>"));
  terminal.press("ay");
  EXPECT_EQ(WEXITSTATUS(terminal.wait_for_end()), 5);
  EXPECT_EQ(terminal.local_modes(), terminal.first_modes());
}

TEST_F(KeyboardTest, TheTerminalIsPutBackByEverySignalThatEnds) {
  std::vector<int> numbers{SIGINT, SIGTERM, SIGHUP, SIGQUIT};
#if !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)  // which handle these themselves
  numbers.insert(numbers.end(), {SIGABRT, SIGSEGV});
#endif
  for (const int number : numbers) {
    Terminal terminal(session);
    ASSERT_TRUE(terminal.shows("<active>"));
    ASSERT_EQ(terminal.local_modes() & ICANON, 0u);
    terminal.signal(number);
    const int status = terminal.wait_for_end();
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == number) << number;
    EXPECT_NE(terminal.local_modes() & ICANON, 0u) << number;
    EXPECT_NE(terminal.local_modes() & ECHO, 0u) << number;
  }
}

TEST(KeyboardWithoutTerminalTest, IsQuiet) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  ASSERT_EQ(::write(pipe[1], "  ay", 4), 4);
  SessionControl control;
  {
    const Keyboard keyboard(control, pipe[0], -1);
    EXPECT_FALSE(keyboard.active());
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_THAT(control.take(), IsEmpty());
  ::close(pipe[0]);
  ::close(pipe[1]);
}

/// A keyboard that shows its notes on a screen that nobody reads. @returns 0 when the emergency
/// stop came all the same.
int keyboard_on_a_full_screen() {
  std::array<int, 2> screen{};
  if (::pipe2(screen.data(), O_NONBLOCK) != 0) {
    return 1;
  }
  const std::array<char, 4096> ink{};
  while (::write(screen[1], ink.data(), ink.size()) > 0) {
  }
  ::fcntl(screen[1], F_SETFL, 0);  // from now on a write would wait
  SessionControl control;
  const Keyboard keyboard(control, 0, screen[1]);
  print("<active>");
  for (;;) {
    for (const auto& message : control.take()) {
      if (!message.is_note && message.request == Request::kEmergencyStop) {
        return 0;
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

/// Answers each emergency stop at once, as a servo thread would. @returns 0 when it was let go.
int instant_stops() {
  SessionControl control;
  control.on_emergency([] { print("<now>"); });
  const Keyboard keyboard(control, 0, -1);
  print("<active>");
  for (;;) {
    for (const auto& message : control.take()) {
      if (message.request == Request::kAbort) {
        return 0;
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

TEST(KeyboardWithoutTerminalTest, EscapeDoesNotWaitForTheRestOfAnArrowKey) {
  if (::access("/dev/pts/ptmx", F_OK) != 0) {
    GTEST_SKIP() << "no pseudo-terminals here: /dev/pts is not mounted";
  }
  Terminal terminal(instant_stops);
  ASSERT_TRUE(terminal.shows("<active>"));
  for (int i = 0; i < 20; ++i) {
    terminal.press("\x1b");  // with nothing after it, which would end a wait
    ASSERT_TRUE(terminal.shows("<now>"));
  }
  terminal.press("ay");
  EXPECT_EQ(terminal.wait_for_end(), 0);
}

int keyboard_beside_a_drilling() {
  SessionControl control;
  SessionStatus status;
  status.state = "running";
  status.simulated = true;
  status.figures.emplace();
  status.figures->line = "procedure 3: 0:00, 7 voxels";
  const Keyboard keyboard(control);
  for (;;) {
    control.publish(status);
    for (const auto& message : control.take()) {
      if (message.request == Request::kAbort) {
        return 0;
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

TEST(KeyboardWithoutTerminalTest, ALineSaysHowADrillingStands) {
  if (::access("/dev/pts/ptmx", F_OK) != 0) {
    GTEST_SKIP() << "no pseudo-terminals here: /dev/pts is not mounted";
  }
  Terminal terminal(keyboard_beside_a_drilling);
  ASSERT_TRUE(terminal.shows("\rSIMULATED procedure 3: 0:00"));
  ASSERT_TRUE(terminal.shows("7 voxels"));
  ASSERT_TRUE(terminal.shows("\rSIMULATED procedure 3")) << "written over";
  terminal.press("p");
  ASSERT_TRUE(terminal.shows("\r\npause")) << "on a line of its own";
  terminal.press("a");
  ASSERT_TRUE(terminal.shows("stop the session?"));
  terminal.press("y");
  EXPECT_EQ(terminal.wait_for_end(), 0);
}

TEST(KeyboardWithoutTerminalTest, AScreenThatHangsKeepsNoKeyWaiting) {
  if (::access("/dev/pts/ptmx", F_OK) != 0) {
    GTEST_SKIP() << "no pseudo-terminals here: /dev/pts is not mounted";
  }
  Terminal terminal(keyboard_on_a_full_screen);
  ASSERT_TRUE(terminal.shows("<active>"));
  terminal.press("nnote");
  terminal.press("\x1b");
  EXPECT_EQ(terminal.wait_for_end(), 0);
}

/// A second one leaves the terminal to the first; afterwards it is free again.
int two_keyboards() {
  SessionControl control;
  bool right = true;
  for (int i = 0; i < 2; ++i) {
    const Keyboard first(control, 0, -1);
    const Keyboard second(control, 0, -1);
    right = right && first.active() && !second.active();
  }
  return right ? 0 : 1;
}

TEST(KeyboardWithoutTerminalTest, OnlyOneReads) {
  Terminal terminal(two_keyboards);
  EXPECT_EQ(terminal.wait_for_end(), 0);
}

}  // namespace
}  // namespace haptrial::experiments
