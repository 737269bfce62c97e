#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "experiments/control/session_controller.h"
#include "experiments/runner/session_record.h"
#include "protocols/interface/trials.h"

namespace haptrial::experiments {

/// Takes back the last answer of a session when the experimenter asks for it: that of the present
/// trial if it has one, else that of the trial before in the same block. Its passes are recorded as
/// taken back at once, so that a session that is killed goes on in the same way. Session's thread.
class LastAnswer {
 public:
  /// All of them outlive it.
  struct Parts {
    protocols::Trials& trials;
    SessionRecord& record;
    SessionController& controller;
  };
  /// The trial that follows.
  enum class Next : std::uint8_t { kAsPlanned, kSameTrial, kTrialBefore };

  explicit LastAnswer(const Parts& parts) : p_(parts) {}

  /// @returns the number of the attempt that begins
  int begin_attempt(const protocols::PlannedTrial& trial);
  void add_pass(std::int32_t row) { now_.passes.push_back(row); }
  /// Notes that the present pass was answered.
  void note_answer();
  /// Makes the present trial the trial before. @param completed  else nothing can be taken back
  void end_trial(bool completed);
  /// Lets nothing be taken back any more: a block is over.
  void forget();

  /// The present trial was completed, and the experimenter repeats it all the same.
  void repeat();
  /// Carries out a request, outside a pass. Called often.
  void see_to_request();
  Next next() const { return next_; }
  /// Whether an answer was taken back, and the session is to go on with its trial.
  bool goes_back() const { return next_ == Next::kTrialBefore && !p_.controller.requests().abort; }
  /// Goes back to the trial before, once goes_back() says so.
  std::optional<protocols::PlannedTrial> go_back();

 private:
  struct Attempt {
    std::int32_t trial{0};
    bool practice{false};
    std::vector<std::int32_t> passes;  // rows of /trials
    bool answered{false};
  };
  void record(const Attempt& attempt, const std::string& why);
  void show();

  Parts p_;
  Attempt now_;
  std::optional<Attempt> before_;
  std::map<std::tuple<std::int32_t, bool, std::string>, int> attempts_;  // by trial, so far
  Next next_{Next::kAsPlanned};
};

}  // namespace haptrial::experiments
