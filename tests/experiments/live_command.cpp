#include "tests/experiments/live_command.h"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <spawn.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <regex>
#include <stdexcept>

#include "tests/experiments/shipped.h"
#include "tests/support/wait.h"

extern char** environ;

namespace haptrial::test {

bool LiveCommand::has_terminals() { return ::access("/dev/pts/ptmx", F_OK) == 0; }

LiveCommand::LiveCommand(const std::string& arguments, const std::string& before, Where where) {
  const std::string script = (folder_ / "script").string();
  write_text(script, before + "\nexec '" HAPTRIAL_BINARY_DIR "/haptrial' " + arguments + "\n");
  if (where == Where::kTerminal) {
    start_on_terminal(script);
  } else {
    start_in_background(script);
  }
}

void LiveCommand::start_on_terminal(const std::string& script) {
  process_ = ::forkpty(&screen_, nullptr, nullptr, nullptr);
  if (process_ == 0) {
    ::execl("/bin/bash", "bash", script.c_str(), nullptr);
    ::_exit(127);
  }
  if (process_ < 0) {
    throw std::runtime_error("no terminal for the command");
  }
  ::fcntl(screen_, F_SETFD, FD_CLOEXEC);
}

void LiveCommand::start_in_background(const std::string& script) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  constexpr int kNew = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, (folder_ / "output").c_str(), kNew, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, (folder_ / "errors").c_str(), kNew, 0600);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t signals;
  sigemptyset(&signals);
  for (const int each : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) {
    sigaddset(&signals, each);  // whoever runs the tests may ignore them
  }
  posix_spawnattr_setsigdefault(&attributes, &signals);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  std::string shell = "bash";
  std::string file = script;
  std::array<char*, 3> words{shell.data(), file.data(), nullptr};
  const int failed =
      posix_spawn(&process_, "/bin/bash", &actions, &attributes, words.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) {
    process_ = -1;
    throw std::runtime_error("the command cannot be started");
  }
}

LiveCommand::~LiveCommand() {
  if (runs()) {
    ::kill(process_, SIGKILL);
    reap(0);
  }
  hang_up();
}

void LiveCommand::read_screen() {
  pollfd watched{screen_, POLLIN, 0};
  std::array<char, 4096> piece;
  while (screen_ >= 0 && ::poll(&watched, 1, 0) > 0) {
    const ssize_t count = ::read(screen_, piece.data(), piece.size());
    if (count <= 0) {
      return;  // nobody is at the other end any more
    }
    shown_.append(piece.data(), static_cast<std::size_t>(count));
  }
}

std::string LiveCommand::output() {
  read_screen();
  return shown_ + read_text(folder_ / "output");
}

std::string LiveCommand::errors() { return read_text(folder_ / "errors"); }

bool LiveCommand::reaches(const std::function<bool()>& condition,
                          const std::source_location& where) {
  bool holds = false;
  wait_until(
      [&] {
        read_screen();  // a full terminal would hold it up
        const bool ended = !runs();
        holds = condition();
        return holds || ended;
      },
      where, [this] { return last_words(); });
  return holds;
}

/// The end of what the command has said.
std::string LiveCommand::last_words() {
  constexpr std::size_t kMost = 500;
  const std::string all = output() + "\n" + errors() + "\n";
  return all.substr(all.size() - std::min(kMost, all.size()));
}

std::string LiveCommand::line_after(const std::string& start) {
  std::string found;
  reaches([&] {
    std::string all = output();
    all.insert(all.begin(), '\n');
    const auto at = all.find("\n" + start);
    const auto from = at + 1 + start.size();
    const auto end = at == std::string::npos ? at : all.find_first_of("\r\n", from);
    if (end != std::string::npos) {
      found = all.substr(from, end - from);
    }
    return !found.empty();
  });
  return found;
}

void LiveCommand::signal(int number) const { ::kill(process_, number); }

void LiveCommand::press(const std::string& keys) const {
  if (::write(screen_, keys.data(), keys.size()) != static_cast<ssize_t>(keys.size())) {
    throw std::runtime_error("the terminal takes no keys");
  }
}

bool LiveCommand::takes_lines() const {
  termios modes{};
  ::tcgetattr(screen_, &modes);
  return (modes.c_lflag & ICANON) != 0 && (modes.c_lflag & ECHO) != 0;
}

void LiveCommand::hang_up() {
  if (screen_ >= 0) {
    read_screen();
    ::close(screen_);
    screen_ = -1;
  }
}

/// @returns whether it has ended.
bool LiveCommand::reap(int options) {
  int status = 0;
  if (process_ > 0 && ::waitpid(process_, &status, options) == process_) {
    process_ = -1;
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  return process_ < 0;
}

bool LiveCommand::runs() { return !reap(WNOHANG); }

CommandResult LiveCommand::wait() {
  reaches([] { return false; });
  return {status_, output(), errors()};
}

std::string shipped_with_all(const std::vector<std::pair<std::string, std::string>>& lines) {
  std::string text = shipped_text();
  for (const auto& [key, line] : lines) {
    const std::regex whole_line("(^|\n)" + key + " *=[^\n]*");
    if (!std::regex_search(text, whole_line)) {
      throw std::invalid_argument("the shipped definition has no key " + key);
    }
    text =
        std::regex_replace(text, whole_line, "$1" + line, std::regex_constants::format_first_only);
  }
  return text;
}

std::vector<std::pair<std::string, std::string>> brisk_lines() {
  return {{"length_x", "length_x = 0.06"},
          {"range_z", "range_z = 0.03"},
          {"speed", "speed = 0.06"},
          {"approach_speed", "approach_speed = 0.3"},
          {"wait", "wait = 0.2"},
          {"recovery", "recovery = 0.3"},
          {"bump_width_min", "bump_width_min = 0.3"},
          {"bump_width_max", "bump_width_max = 0.5"},
          {"ramp", "ramp = 0.3"}};
}

std::string attended_text(std::vector<std::pair<std::string, std::string>> more) {
  more.insert(more.begin(), {"speed", "speed = 0.0002"});
  return brisk_text(std::move(more));
}

std::string brisk_text(std::vector<std::pair<std::string, std::string>> more) {
  auto lines = brisk_lines();
  // Tests change the conditions: nothing is planned about those that are gone.
  lines.insert(lines.end(), {{"planned", ""}, {"reference", ""}});
  lines.insert(lines.end(), more.begin(), more.end());
  return shipped_with_all(lines);
}

}  // namespace haptrial::test
