#pragma once

#include <sys/types.h>

#include <functional>
#include <source_location>
#include <string>
#include <utility>
#include <vector>

#include "tests/experiments/command.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::test {

/// The built command while it runs, with a person who watches it and meddles. What it printed stays
/// in a folder of its own. A command that outlives this is killed. Waits have no limit (wait.h).
class LiveCommand {
 public:
  enum class Where { kBackground, kTerminal };

  /// Whether the system has pseudo-terminals.
  static bool has_terminals();

  /// @param arguments  of `haptrial`, as a shell takes them
  /// @param before  shell lines run before it in the same process: "ulimit -f 300"
  /// @param where  on a terminal of its own, whose keys press() presses, or in the background
  /// @throws std::runtime_error where it cannot be started
  explicit LiveCommand(const std::string& arguments, const std::string& before = "",
                       Where where = Where::kBackground);
  ~LiveCommand();
  LiveCommand(const LiveCommand&) = delete;
  LiveCommand& operator=(const LiveCommand&) = delete;

  std::string output();  // standard output so far; on a terminal, all that it shows
  std::string errors();  // standard error so far; on a terminal, nothing
  /// Waits until the condition holds. @returns false if the command ended before it did.
  bool reaches(const std::function<bool()>& condition,
               const std::source_location& where = std::source_location::current());
  /// Waits for the first line of the output that starts so. @returns it without that start; "" if
  /// the command ended without it.
  std::string line_after(const std::string& start);

  void signal(int number) const;
  void press(const std::string& keys) const;  // on the terminal
  bool takes_lines() const;                   // whether the terminal shows and edits what is typed
  void hang_up();                             // the terminal's window is closed
  bool runs();

  /// Waits for its end. @returns what it gave.
  CommandResult wait();

 private:
  void start_on_terminal(const std::string& script);
  void start_in_background(const std::string& script);
  std::string last_words();
  void read_screen();
  bool reap(int options);

  TemporaryFolder folder_;
  pid_t process_{-1};
  int screen_{-1};  // the terminal's other end
  std::string shown_;
  int status_{-1};
};

/// The shipped definition with other values, each given as its line: {"speed", "speed = 0.05"}.
std::string shipped_with_all(const std::vector<std::pair<std::string, std::string>>& lines);

/// The lines that make a pass last about three seconds and a trial six.
std::vector<std::pair<std::string, std::string>> brisk_lines();
/// The shipped study with these, and others: for sessions in whose passes nobody does anything.
std::string brisk_text(std::vector<std::pair<std::string, std::string>> more = {});
/// The shipped study with runs of several minutes: whoever acts within one is in time on any
/// machine.
std::string attended_text(std::vector<std::pair<std::string, std::string>> more = {});

}  // namespace haptrial::test
