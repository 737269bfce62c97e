#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "core/psychometric/procedure/procedure.h"
#include "protocols/psychophysics/sequence/script_process.h"

namespace haptrial::protocols {

/// A script that is asked for levels: a line with "level" is its answer. One thread.
class LevelScript {
 public:
  struct Answer {
    std::optional<psychometric::Level> level;
    std::string why_not;  // "it gave no level within 2 s"
  };

  /// @param deadline, longest_start  as of ScriptProcess [s]
  LevelScript(std::filesystem::path file, double deadline,
              double longest_start = ScriptProcess::kLongestStart);

  void start_early() noexcept { process_.start_early(); }

  /// @param question    one line, without its end
  /// @param dimensions  of the level
  /// @param pulse       called now and then while nothing comes; may throw
  Answer ask(const std::string& question, std::size_t dimensions,
             const std::function<void()>& pulse = {});

 private:
  ScriptProcess process_;
};

}  // namespace haptrial::protocols
