#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/base/child_process.h"
#include "core/record/read/session_reader_forward.h"

namespace haptrial::protocols {

/// The process of a script that is asked: a line of JSON on its standard input, and a line on its
/// standard output, an object that has a certain key. It begins with the first question, and again
/// after it ended, crashed or was too late. Whatever it does, ask() returns. One thread.
///
/// The deadline counts from when a script that was just started has read its question, so that an
/// interpreter may take its time to start.
class ScriptProcess {
 public:
  static constexpr double kLongestStart = 60.0;  // [s]

  struct Reply {
    std::string line;     // the object with the key; empty: none came
    std::string why_not;  // "it gave no level within 2 s"
  };

  /// @param deadline  for an answer [s]
  /// @param key       that an answer has, and what it is called: "level"
  /// @param longest_start  until it has read its first question [s]
  ScriptProcess(std::filesystem::path file, double deadline, std::string key,
                double longest_start = kLongestStart);
  ~ScriptProcess();

  /// Starts it before the first question. What prevents that is the answer to the question.
  void start_early() noexcept;

  /// @param question  one line, without its end
  /// @param pulse     called now and then while nothing comes; may throw
  Reply ask(const std::string& question, const std::function<void()>& pulse = {});

 private:
  using Clock = std::chrono::steady_clock;

  void start();
  void stop() noexcept;
  void begin_to_wait();
  /// Whether the time for an answer is over.
  bool is_late();
  /// A line that came; nothing if it is late or the process ended.
  std::optional<std::string> next_line(const std::function<void()>& pulse);
  Reply lost();
  Reply late();

  std::filesystem::path file_;
  double deadline_;
  std::string key_;
  double longest_start_;
  bool started_{false};    // it has read a question since it was started
  Clock::time_point end_;  // of the waiting for an answer
  std::unique_ptr<ChildProcess> process_;
  Descriptor to_, from_;
  std::string heard_;  // without a line's end so far
  std::string said_;   // the last line that was no answer
};

struct ScriptPlan;

/// Whether an earlier run of the session kept the script's text.
/// @param event  the kind of event that holds it
/// @throws InputError where its script was another one
bool kept_before(const ScriptPlan& plan, const char* event, const record::SessionReader& earlier);

}  // namespace haptrial::protocols
