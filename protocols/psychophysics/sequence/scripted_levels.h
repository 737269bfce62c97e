#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/psychometric/procedure/procedure.h"
#include "core/record/read/session_reader_forward.h"
#include "protocols/psychophysics/definition/script_plan.h"
#include "protocols/psychophysics/definition/trials_definition.h"
#include "protocols/psychophysics/sequence/level_chooser.h"
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

/// Kind of the event of a level that is not the script's own, which says why.
inline constexpr const char* kScriptTrouble = "level_script_failed";

/// Levels of a script (docs/guide-own-experiment.md), or of the procedures where it gives none.
/// What an earlier run of the session presented is not asked again.
class ScriptedLevels final : public LevelChooser {
 public:
  /// The deadline where nobody waits: a busy machine is not to change a dry run. [s]
  static constexpr double kPatient = 60.0;

  /// @param real   a person waits
  /// @param pulse  called while the script thinks; may throw
  ScriptedLevels(const ScriptPlan& plan, std::string subject, bool real,
                 std::function<void()> pulse);

  /// Starts the script while nobody waits for it yet.
  void start_early() noexcept { script_.start_early(); }

  /// Takes the levels of an earlier run. @throws InputError where its script was another one
  void recall(const record::SessionReader& earlier);
  bool recalled() const { return recalled_; }

  psychometric::Level choose(const LevelQuestion& question) override;
  void told(const std::string& name, const psychometric::Outcome& outcome) override;

  /// Why levels are not the script's: a sentence each, of the trials since the last call.
  std::vector<std::string> take_troubles();
  int asked() const { return asked_; }
  int left() const { return left_; }  // trials with the procedure's own level

 private:
  std::string line_of(const LevelQuestion& question) const;

  const ScriptPlan& plan_;
  std::string subject_;
  std::function<void()> pulse_;
  LevelScript script_;
  std::map<std::string, std::vector<psychometric::Outcome>> history_;  // by track
  std::map<int, psychometric::Level> earlier_;                         // by trial
  bool recalled_{false};
  std::vector<std::string> troubles_;
  int asked_{0}, left_{0};
};

}  // namespace haptrial::protocols
