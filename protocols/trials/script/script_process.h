#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/base/files/child_process.h"

namespace haptrial::protocols {

/// The process of a script that is asked: a line of JSON on its standard input, and a line on its
/// standard output, an object that has a certain key. It begins with the first question, and again
/// after it ended, crashed or was too late. Whatever it does, ask() returns. One thread.
class ScriptProcess {
 public:
  struct Reply {
    std::string line;     // the object with the key; empty: none came
    std::string why_not;  // "it gave no level within 2 s"
  };

  /// @param deadline  for an answer [s]
  /// @param key       that an answer has, and what it is called: "level"
  ScriptProcess(std::filesystem::path file, double deadline, std::string key);
  ~ScriptProcess();

  /// @param question  one line, without its end
  /// @param pulse     called now and then while nothing comes; may throw
  Reply ask(const std::string& question, const std::function<void()>& pulse = {});

 private:
  using Clock = std::chrono::steady_clock;

  void start();
  void stop() noexcept;
  /// A line that came; nothing at the deadline, or where the process ended.
  std::optional<std::string> line_before(Clock::time_point end, const std::function<void()>& pulse);
  Reply lost();

  std::filesystem::path file_;
  double deadline_;
  std::string key_;
  std::unique_ptr<ChildProcess> process_;
  Descriptor to_, from_;
  std::string heard_;  // without a line's end so far
  std::string said_;   // the last line that was no answer
};

}  // namespace haptrial::protocols
