#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/record/drilling_types.h"
#include "core/record/session_types.h"
#include "core/stimulus/observer.h"
#include "experiments/rig.h"
#include "experiments/screen.h"
#include "experiments/session.h"
#include "protocols/pass.h"
#include "protocols/schedule.h"
#include "protocols/session_task.h"

namespace haptrial::experiments {

class SessionRecord;

/// What the trials of a protocol consist of; the session does the rest. Session's thread. What a
/// pass uses lives until the next make_pass().
class Trials {
 public:
  virtual ~Trials() = default;

  virtual std::vector<protocols::PlannedTrial> plan() const = 0;
  /// Of every trial, in order. A trial is done when its last one was completed.
  virtual std::span<const record::Phase> phases() const = 0;
  /// The bones of a session that drills, for its file; else nothing.
  virtual std::optional<std::vector<record::BoneRecord>> bones() const { return std::nullopt; }
  /// Virtual device and virtual participant.
  virtual std::unique_ptr<Rig> virtual_rig(std::uint64_t session_seed) const = 0;
  /// Who sees every tick beside the screen and the participant: for pictures, for sound.
  virtual std::vector<stimulus::Observer*> observers() = 0;

  /// Before the first attempt at a trial.
  virtual void prepare(const protocols::PlannedTrial& trial, SessionRecord& record) = 0;
  /// Before each attempt. @param anew  from the beginning; else where it was broken off, if the
  /// protocol can
  virtual void begin_attempt(const protocols::PlannedTrial& trial, bool anew) = 0;
  /// What the participant's screen shows during the trial.
  virtual void show(Screen& screen) = 0;
  /// @param trial  as planned; what its row is to say else may be changed
  virtual protocols::Pass& make_pass(protocols::PlannedTrial& trial, record::Phase phase,
                                     SessionRecord& record) = 0;
  /// What the present attempt drills; else null.
  virtual std::shared_ptr<const bone::BoneModel> bone() const { return nullptr; }
  /// After a pass, before its row of /trials. @param row  its number
  virtual void close_pass(SessionRecord& record, std::int32_t row) = 0;
  /// Pictures of the last pass.
  virtual void draw_pictures(const protocols::PlannedTrial& trial, record::Phase phase) = 0;
  /// Why a pass ended as aborted by itself.
  virtual const char* why_aborted() const = 0;
  /// Sentences for the end of the session.
  virtual std::vector<std::string> notices() const { return {}; }
};

/// The trials of a request. @param session_seed  of the participant
std::unique_ptr<Trials> make_trials(const SessionRequest& request, std::uint64_t session_seed);

}  // namespace haptrial::experiments
