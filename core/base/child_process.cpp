#include "core/base/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <system_error>
#include <utility>

extern char** environ;

namespace haptrial {
namespace {

[[noreturn]] void fail(int error, const std::string& what) {
  throw std::system_error(error, std::generic_category(), what);
}

/// The streams and the folder of a program to be started.
class Actions {
 public:
  explicit Actions(const Program& program) {
    posix_spawn_file_actions_init(&actions_);
    if (!program.folder.empty()) {
      posix_spawn_file_actions_addchdir_np(&actions_, program.folder.c_str());
    }
    join(STDIN_FILENO, program.input, O_RDONLY);
    join(STDOUT_FILENO, program.output, O_WRONLY);
    posix_spawn_file_actions_adddup2(&actions_, STDOUT_FILENO, STDERR_FILENO);
    // Libraries open files without close-on-exec: HDF5 the session.
    posix_spawn_file_actions_addclosefrom_np(&actions_, STDERR_FILENO + 1);
  }
  ~Actions() { posix_spawn_file_actions_destroy(&actions_); }
  Actions(const Actions&) = delete;
  Actions& operator=(const Actions&) = delete;
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  void join(int stream, int descriptor, int mode) {
    if (descriptor < 0) {
      posix_spawn_file_actions_addopen(&actions_, stream, "/dev/null", mode, 0);
    } else {
      posix_spawn_file_actions_adddup2(&actions_, descriptor, stream);
    }
  }

  posix_spawn_file_actions_t actions_;
};

/// The program becomes the leader of a process group.
class GroupAttributes {
 public:
  GroupAttributes() {
    posix_spawnattr_init(&attributes_);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETPGROUP);
    posix_spawnattr_setpgroup(&attributes_, 0);
  }
  ~GroupAttributes() { posix_spawnattr_destroy(&attributes_); }
  GroupAttributes(const GroupAttributes&) = delete;
  GroupAttributes& operator=(const GroupAttributes&) = delete;
  const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_;
};

void crash_quietly() {
  const rlimit none{};
  setrlimit(RLIMIT_CORE, &none);
  for (const int crash : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE}) {
    std::signal(crash, SIG_DFL);
  }
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);  // libraries chatter
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
}

/// Keeps the signal of a reader that has left from ending this process; the write fails instead.
class WithoutPipeSignal {
 public:
  WithoutPipeSignal() {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~WithoutPipeSignal() {
    const timespec now{};
    while (sigtimedwait(&pipe_, nullptr, &now) == SIGPIPE) {
    }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  WithoutPipeSignal(const WithoutPipeSignal&) = delete;
  WithoutPipeSignal& operator=(const WithoutPipeSignal&) = delete;

 private:
  sigset_t pipe_, before_;
};

}  // namespace

Descriptor::Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  if (this != &other) {
    close();
    number_ = std::exchange(other.number_, -1);
  }
  return *this;
}

void Descriptor::close() noexcept {
  if (number_ >= 0) {
    ::close(std::exchange(number_, -1));
  }
}

Pipe::Pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    fail(errno, "pipe");
  }
  from = Descriptor(ends[0]);
  to = Descriptor(ends[1]);
}

ChildProcess::ChildProcess(const Program& program) {
  std::vector<std::string> words = program.words;
  std::vector<char*> arguments;
  for (std::string& word : words) {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  const Actions actions(program);
  const GroupAttributes attributes;
  const int error = posix_spawnp(&process_, words.front().c_str(), actions.get(), attributes.get(),
                                 arguments.data(), environ);
  if (error != 0) {
    process_ = -1;
    fail(error, words.front());
  }
  leads_group_ = true;
}

ChildProcess::ChildProcess(const std::function<void()>& work) {
  process_ = fork();
  if (process_ < 0) {
    fail(errno, "fork");
  }
  if (process_ == 0) {
    crash_quietly();
    try {
      work();
    } catch (...) {
      _exit(1);
    }
    _exit(0);
  }
}

ChildProcess::~ChildProcess() {
  kill();
  wait();
}

void ChildProcess::kill() noexcept { signal(SIGKILL); }

void ChildProcess::ask_to_end() noexcept { signal(SIGTERM); }

void ChildProcess::signal(int number) noexcept {
  if (process_ > 0) {
    ::kill(leads_group_ ? -process_ : process_, number);
  }
}

int ChildProcess::wait() noexcept {
  if (process_ > 0) {
    if (leads_group_) {  // whose number is taken as long as its leader is not waited for
      siginfo_t ended{};
      while (waitid(P_PID, static_cast<id_t>(process_), &ended, WEXITED | WNOWAIT) != 0 &&
             errno == EINTR) {
      }
      kill();
    }
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  return status_;
}

bool write_fully(int to, const void* bytes, std::size_t count) noexcept {
  const WithoutPipeSignal quiet;
  const char* at = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t done = write(to, at, count);
    if (done < 0 && errno == EINTR) {
      continue;
    }
    if (done <= 0) {
      return false;
    }
    at += done;
    count -= static_cast<std::size_t>(done);
  }
  return true;
}

std::size_t read_fully(int from, void* bytes, std::size_t count) noexcept {
  char* at = static_cast<char*>(bytes);
  std::size_t came = 0;
  while (came < count) {
    const ssize_t now = read(from, at + came, count - came);
    if (now < 0 && errno == EINTR) {
      continue;
    }
    if (now <= 0) {
      break;
    }
    came += static_cast<std::size_t>(now);
  }
  return came;
}

bool is_installed(std::string_view program) {
  const char* path = std::getenv("PATH");
  const std::string folders = path != nullptr ? path : "/usr/bin:/bin";
  for (std::size_t from = 0; from <= folders.size();) {
    const std::size_t to = std::min(folders.find(':', from), folders.size());
    const auto file = std::filesystem::path(folders.substr(from, to - from)) / program;
    if (access(file.c_str(), X_OK) == 0) {
      return true;
    }
    from = to + 1;
  }
  return false;
}

void read_pieces(int from, const std::function<bool(std::string_view)>& take,
                 const std::function<bool()>& go_on) {
  constexpr int kPause = 100;  // [ms]
  std::array<char, 4096> piece;
  auto asked = std::chrono::steady_clock::now();
  for (;;) {
    pollfd wait{from, POLLIN, 0};
    const int ready = go_on ? poll(&wait, 1, kPause) : 1;
    const auto now = std::chrono::steady_clock::now();
    if (go_on && (ready <= 0 || now - asked > std::chrono::milliseconds(kPause))) {
      asked = now;
      if (!go_on()) {
        return;
      }
    }
    if (ready == 0 || (ready < 0 && errno == EINTR)) {
      continue;
    }
    const ssize_t size = read(from, piece.data(), piece.size());
    if (size < 0 && errno == EINTR) {
      continue;
    }
    if (size <= 0 || !take({piece.data(), static_cast<std::size_t>(size)})) {
      return;
    }
  }
}

std::string read_to_end(int from, const std::function<bool()>& go_on) {
  std::string text;
  const auto keep = [&](std::string_view piece) {
    text += piece;
    return true;
  };
  read_pieces(from, keep, go_on);
  return text;
}

}  // namespace haptrial
