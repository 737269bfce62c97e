#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/base/files/child_process.h"
#include "core/psychometric/procedure/procedure.h"

namespace haptrial::protocols {

/// The process of a script that is asked for levels: a line of JSON on its standard input, and a
/// line with "level" on its standard output. It begins with the first question, and again after it
/// ended, crashed or was too late. Whatever it does, ask() returns. One thread.
class LevelScript {
 public:
  struct Answer {
    std::optional<psychometric::Level> level;
    std::string why_not;  // "it gave no level within 2 s"
  };

  /// @param deadline  for an answer [s]
  LevelScript(std::filesystem::path file, double deadline);
  ~LevelScript();

  /// @param question    one line, without its end
  /// @param dimensions  of the level
  /// @param pulse       called now and then while nothing comes; may throw
  Answer ask(const std::string& question, std::size_t dimensions,
             const std::function<void()>& pulse = {});

 private:
  using Clock = std::chrono::steady_clock;

  void start();
  void stop() noexcept;
  /// A line that came; nothing at the deadline, or where the process ended.
  std::optional<std::string> line_before(Clock::time_point end, const std::function<void()>& pulse);
  Answer lost();

  std::filesystem::path file_;
  double deadline_;
  std::unique_ptr<ChildProcess> process_;
  Descriptor to_, from_;
  std::string heard_;  // without a line's end so far
  std::string said_;   // the last line that was no answer
};

}  // namespace haptrial::protocols
