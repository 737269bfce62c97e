#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial {

/// A file descriptor that is closed at the end. Negative: none.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) noexcept : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept;
  Descriptor& operator=(Descriptor&& other) noexcept;
  int get() const noexcept { return number_; }
  void close() noexcept;

 private:
  int number_;
};

/// Both ends of a pipe. @throws std::system_error
struct Pipe {
  Pipe();
  Descriptor from, to;
};

/// A program to start: it gets these, the environment, and no other descriptor of this process.
struct Program {
  std::vector<std::string> words;  // its name, found along PATH, and its arguments
  std::filesystem::path folder{};  // in which it runs; empty: that of this process
  int input{-1};                   // a descriptor; -1: nothing to read
  int output{-1};                  // receives standard output and errors; -1: nobody does
};

/// A process beside this one. Waited for at the latest at the end, then killed. One thread.
class ChildProcess {
 public:
  /// The program leads a process group, which is ended with it. A key such as Ctrl-C, which signals
  /// the group of a terminal, does not reach it.
  /// @throws std::system_error if the program cannot be started.
  explicit ChildProcess(const Program& program);
  /// A copy of this process, which does the work and ends with status 0, or 1 where the work
  /// throws. What crashes in it leaves no core file and nothing on the screen.
  /// @throws std::system_error where there is no process to be had.
  explicit ChildProcess(const std::function<void()>& work);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void kill() noexcept;
  /// Asks the program, with its process group, to end (SIGTERM). Nothing after wait().
  void ask_to_end() noexcept;
  /// Waits for the end. @returns the exit status; -1 after a crash or a kill. Again the same.
  int wait() noexcept;

 private:
  void signal(int number) noexcept;
  pid_t process_{-1};
  bool leads_group_{false};
  int status_{-1};
};

/// @returns whether all bytes went; no, without a signal, if the reader of a pipe has left.
bool write_fully(int to, const void* bytes, std::size_t count) noexcept;

/// @returns how many bytes came; fewer than `count` if the other end was closed.
std::size_t read_fully(int from, void* bytes, std::size_t count) noexcept;

/// Whether a program of this name is found along PATH.
bool is_installed(std::string_view program);

/// Takes what comes, piece by piece, until the other end is closed or `take` returns false.
/// @param go_on  asked ten times a second; false ends the reading. Empty: never asked
void read_pieces(int from, const std::function<bool(std::string_view)>& take,
                 const std::function<bool()>& go_on = {});

/// All that comes until the other end is closed.
/// @param go_on  as of read_pieces()
std::string read_to_end(int from, const std::function<bool()>& go_on = {});

}  // namespace haptrial
