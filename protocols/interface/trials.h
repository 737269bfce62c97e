#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/record/read/session_reader_forward.h"
#include "core/record/rows/answer_rows.h"
#include "core/record/rows/live_figures.h"
#include "core/record/rows/partner_rows.h"
#include "core/record/rows/rows.h"
#include "core/record/rows/session_types.h"
#include "core/sound/cue.h"
#include "core/stimulus/observer.h"
#include "protocols/definition/schedule.h"
#include "protocols/interface/auxiliary_page.h"
#include "protocols/interface/drawing.h"
#include "protocols/interface/pass.h"
#include "protocols/interface/rig.h"

namespace haptrial::protocols {

class SessionFile;
class SharedSimulation;

/// Place of a session's trials: the runner's message to a protocol.
struct SessionPlace {
  std::string subject;            // identifier
  int participant{0};             // from 0
  std::uint64_t seed{0};          // of the study
  int session{1};                 // of the participant, from 1
  std::uint64_t person_seed{0};   // of the participant, the same in every session
  std::uint64_t session_seed{0};  // of this session
  // Seeds of the hand that holds a virtual device; they differ from the participant's only when a
  // partner leads.
  std::uint64_t hand_person_seed{0};
  std::uint64_t hand_session_seed{0};
  bool real{false};        // on a real clock: a person, or a rehearsal
  bool window{false};      // the participant has a screen
  int frames_per_pass{0};  // pictures of what was shown, into frames_folder
  std::filesystem::path frames_folder;
  AuxiliaryPages auxiliary_pages;  // those of the protocol's that are served
  std::filesystem::path resumed;   // the file of the earlier run; empty: none
  /// Callback to call now and then while something takes seconds: what, and the share that is done.
  /// @throws RunError on an interrupt
  std::function<void(const char* what, double share)> pulse;
  std::function<void()> stop;  // an emergency stop; any thread, also the servo thread
};

/// Gives a place its seeds. @param place  with subject, session and the study's seed
/// @param hand  who holds a virtual device, where it is not the participant; else empty
void give_seeds(SessionPlace& place, std::string_view hand = {});

/// How a trial ended.
enum class TrialEnd : std::uint8_t { kCompleted, kSkipped, kAborted };

/// Outcome of a trial: the next one follows from it.
struct Outcome {
  PlannedTrial trial;
  TrialEnd end{TrialEnd::kCompleted};
  std::vector<record::ResponseRow> responses;  // of its last attempt, in order
};

/// Fate of a trial whose pass was aborted.
enum class AfterAbort : std::uint8_t {
  kAsAsked,  // what experimenter and runner make of it
  kAgain,    // it is presented again
  kSkip,     // it is left
};

/// How many trials there are to be; at most so many where outcomes decide.
struct Extent {
  int trials{0};  // of the study
  int practice{0};
  int blocks{0};
};

/// The trials of one session: which comes next, what each consists of, and what it shows. The
/// runner does the rest. Session's thread. What a pass uses lives until the next make_pass().
class Trials {
 public:
  virtual ~Trials() = default;

  /// @param most  of the study that are to be presented; 0: all
  virtual Extent extent(int most) const = 0;
  /// The trial that follows. A resumed session asks again from the beginning, with the outcomes
  /// that are recorded: the same outcomes lead to the same trials.
  /// @param last  of the trial before; null before the first
  /// @returns nothing when the session is over
  virtual std::optional<PlannedTrial> next(const Outcome* last) = 0;
  /// Whether outcomes can be taken back: those that have gone to another program cannot.
  virtual bool can_take_back() const { return false; }
  /// Forgets the outcome that next() was given last: procedures stand as if it had not been.
  /// Called only where can_take_back(). @returns its trial, which is presented again; nothing if
  /// there was none
  virtual std::optional<PlannedTrial> take_back() { return std::nullopt; }
  /// Whether a resumed session presents trials again that an earlier run had to abort. Not where
  /// later trials followed from the abort.
  virtual bool presents_aborted_again() const { return false; }
  /// Phases of every trial, in order. A trial is done when its last one was completed.
  virtual std::span<const record::Phase> phases() const = 0;

  /// Virtual devices and virtual participant.
  virtual std::unique_ptr<Rig> virtual_rig() const = 0;
  /// Observers of every tick beside the screen and the participant: for pictures, for sound.
  virtual std::vector<stimulus::Observer*> observers() { return {}; }
  /// Log of every tick beside the samples; null: none.
  virtual TickLog* tick_log() { return nullptr; }
  /// Hands over what its own logs hold. Called often; before the samples of the same ticks are
  /// handed over.
  virtual void empty_logs(SessionFile& file) { static_cast<void>(file); }
  /// Records that a log had no room for.
  virtual std::uint64_t dropped() const { return 0; }

  /// The tables of the protocol's own, in the order in which the file has them; with
  /// record::responses_table() if anything is asked.
  virtual record::TableList tables() const { return {}; }
  /// Rows that the file has from the beginning; what they point to lives as long as the trials.
  virtual std::vector<record::Rows> first_rows() const { return {}; }
  /// @throws InputError if what an earlier run recorded cannot be gone on with
  virtual void check_resumed(const record::SessionReader& file) const { static_cast<void>(file); }

  /// Prepares a trial; called before the first attempt at it.
  virtual void prepare(const PlannedTrial& trial, SessionFile& file) {
    static_cast<void>(trial);
    static_cast<void>(file);
  }
  /// Begins an attempt; called before each. @param anew  from the beginning; else where it was
  /// broken off, if the protocol can
  virtual void begin_attempt(const PlannedTrial& trial, bool anew) {
    static_cast<void>(trial);
    static_cast<void>(anew);
  }
  /// Drawing of the participant's screen during the trial.
  virtual MakeDrawing drawing() = 0;
  /// Whether a pass begins only when the screen has shown the first picture of drawing().
  virtual bool waits_for_picture() const { return false; }
  /// @param trial  as planned; what its row is to say else may be changed
  virtual Pass& make_pass(PlannedTrial& trial, const record::Phase& phase) = 0;
  /// The sounds of the pass that make_pass() made last whose numbers follow from the trial. In its
  /// onsets their numbers come behind those of the definition's own sounds.
  virtual std::vector<sound::Cue> varied_cues() const { return {}; }
  /// The answers of the pass that ended last; their trial, pass and place in time are filled in.
  virtual std::vector<record::ResponseRow> responses() { return {}; }
  /// Closes a pass; called after it, before its row of /trials. @param row  its number
  virtual void close_pass(SessionFile& file, std::int32_t row) {
    static_cast<void>(file);
    static_cast<void>(row);
  }
  /// Pictures of the last pass.
  virtual void draw_pictures(const PlannedTrial& trial, const record::Phase& phase) {
    static_cast<void>(trial);
    static_cast<void>(phase);
  }
  /// Why a pass ended as aborted by itself.
  virtual std::string why_aborted() const = 0;
  /// The same pass: who decides about it may be somebody far away.
  virtual AfterAbort after_abort() const { return AfterAbort::kAsAsked; }
  /// A partner in another session, if there is one.
  virtual std::optional<record::PartnerState> partner() { return std::nullopt; }
  /// Takes the lead of both hands, or hands it over.
  virtual void take_lead(bool take) { static_cast<void>(take); }
  /// The simulation whose messages must not be lost on the way, if there is a world that both sides
  /// work on; asked before the first trial of a session that is linked to another. @param
  /// leads  this side's is the world
  virtual SharedSimulation* share_world(bool leads) {
    static_cast<void>(leads);
    return nullptr;
  }
  /// How the session stands, in the words of the study; nothing: only what every session has.
  virtual std::optional<record::LiveState> live() const { return std::nullopt; }
  /// Sentences for an experimenter who can still do something about it, since the last call; asked
  /// often.
  virtual std::vector<std::string> take_warnings() { return {}; }
  /// Why trials were given up before all were done; empty: they were not.
  virtual std::string why_given_up() const { return {}; }
  /// Sentences for the end of the session.
  virtual std::vector<std::string> notices() const { return {}; }
};

/// Trials whose order is known from the beginning, whatever comes of them.
class FixedPlan {
 public:
  explicit FixedPlan(std::vector<PlannedTrial> plan);
  Extent extent(int most) const;
  const std::vector<PlannedTrial>& trials() const { return plan_; }
  std::optional<PlannedTrial> next() {
    return at_ < plan_.size() ? std::optional(plan_[at_++]) : std::nullopt;
  }

 private:
  std::vector<PlannedTrial> plan_;
  std::size_t at_{0};
};

}  // namespace haptrial::protocols
