#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "core/record/rows/answer_rows.h"
#include "core/record/rows/trial_rows.h"
#include "protocols/psychophysics/definition/question.h"
#include "protocols/psychophysics/definition/script_plan.h"
#include "protocols/psychophysics/presentation/trial_view.h"
#include "protocols/psychophysics/sequence/script_process.h"

namespace haptrial::protocols {

/// Event of a session whose virtual participant answers by a script: its text.
inline constexpr const char* kDecisionScriptEvent = "decision_script";

/// A trial as the script is told of it.
struct TrialToDecide {
  int trial{1};  // of the study, or of practice
  bool practice{false};
  std::span<const record::VariableRow> variables;  // of the pass
};

/// Answers of a script (docs/guide-own-experiment.md) in place of a virtual participant's own.
/// Session's thread.
class ScriptedDecisions {
 public:
  /// @param plan   outlives it
  /// @param seed   of the participant; the script's own random numbers are to follow from it
  /// @param pulse  called while the script thinks; may throw
  ScriptedDecisions(const ScriptPlan& plan, std::string subject, std::uint64_t seed,
                    std::function<void()> pulse);
  ~ScriptedDecisions();

  /// @throws InputError where it gives no answer, or one that the question does not allow
  LeftDecision::Answer decide(const TrialToDecide& trial, const TrialQuestion& question,
                              const LeftDecision::DecisionRequest& asked);
  /// Tells the script the answers in a trial that counts, from then on.
  void told(int trial, bool practice, std::span<const record::ResponseRow> responses);

 private:
  struct History;
  std::string line_of(const TrialToDecide& trial, const TrialQuestion& question,
                      const LeftDecision::DecisionRequest& asked) const;

  const ScriptPlan& plan_;
  std::string subject_;
  std::uint64_t seed_;
  std::function<void()> pulse_;
  ScriptProcess process_;
  std::unique_ptr<History> history_;
};

}  // namespace haptrial::protocols
