#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/definition/table.h"
#include "core/record/rows/object_rows.h"
#include "core/record/rows/trial_rows.h"
#include "protocols/interface/session_file.h"
#include "protocols/interface/trials.h"
#include "protocols/psychophysics/body_report.h"
#include "protocols/psychophysics/definition/presented.h"
#include "protocols/psychophysics/live_trials.h"
#include "protocols/psychophysics/presentation/trial_pass.h"
#include "protocols/psychophysics/sequence/trial_sequence.h"
#include "protocols/psychophysics/session_scripts.h"
#include "protocols/psychophysics/studied_definition.h"

namespace haptrial::protocols {

class TrialsRig;

/// The names of the blocks of a session, in the order in which they come.
std::vector<std::string> blocks_of(const TrialsDefinition& definition, const SessionPlace& place);

/// The trials of one session as a definition states them.
class DefinedTrials final : public Trials {
 public:
  DefinedTrials(const StudiedDefinition& definition, const SessionPlace& place);

  Extent extent(int most) const override;
  std::optional<PlannedTrial> next(const Outcome* last) override;
  bool can_take_back() const override { return !scripts_.any(); }
  std::optional<PlannedTrial> take_back() override;
  std::span<const record::Phase> phases() const override;
  std::unique_ptr<Rig> virtual_rig() const override;
  record::TableList tables() const override;
  std::vector<record::Rows> first_rows() const override;
  void check_resumed(const record::SessionReader& file) const override;
  void prepare(const PlannedTrial& trial, SessionFile& file) override;
  MakeDrawing drawing() override;
  std::vector<sound::Cue> varied_cues() const override { return varied_cues_; }
  Pass& make_pass(PlannedTrial& trial, const record::Phase& phase) override;
  std::vector<record::ResponseRow> responses() override;
  void close_pass(SessionFile& file, std::int32_t row) override;
  void empty_logs(SessionFile& file) override { kept_.empty(file); }
  std::uint64_t dropped() const override { return kept_.dropped(); }
  std::string why_aborted() const override;
  std::optional<record::LiveState> live() const override { return live_.state(); }
  std::vector<std::string> take_warnings() override { return scripts_.take_warnings(); }
  std::string why_given_up() const override;
  std::vector<std::string> notices() const override;

  /// Repeats a recorded session: bodies of their own rate have no thread, and were late in the next
  /// pass as these rows of /late_windows say.
  void repeat(std::vector<record::LateWindowRow> late) {
    late_again_ = std::move(late);
    repeats_ = true;
  }
  /// The pass that make_pass() made last, and names of the stages of its intervals.
  TrialPass& pass() { return *pass_; }
  const TrialPass& pass() const { return *pass_; }
  const std::vector<std::vector<NamedStage>>& stages() const { return stages_; }

 private:
  void number_bodies(const std::vector<scene::Field>& fields, std::vector<StageSight>& sights);
  void be_late_again(std::size_t interval, std::vector<scene::Field>& fields) const;
  std::optional<Cursor> cursor_of(const Presented& presented, std::size_t place) const;
  IntervalRun make_interval(std::size_t place, RandomStream& random);
  int sound_of_interval(int sound) const;
  std::vector<PresentedQuestion> make_questions();
  std::vector<TakenMeasure> take_measures() const;
  void note_variables(std::size_t interval, std::vector<record::VariableRow>& rows) const;
  double outcome_of(const std::vector<record::ResponseRow>& responses);
  bool comes_again(const std::vector<record::ResponseRow>& responses) const;
  std::vector<TouchedPlace> places_of(const TrialQuestion& question) const;
  void keep_level(SessionFile& file, std::int32_t row);
  void keep_adaptation(SessionFile& file, std::int32_t row) const;
  bool adapts() const { return rig_ != nullptr && d_.observer.adaptation.has_value(); }

  const StudiedDefinition& d_;
  SessionPlace place_;
  Table root_;
  std::unique_ptr<Names> names_;
  SessionScripts scripts_;
  std::optional<TrialSequence> sequence_;  // made anew where an outcome is taken back
  std::vector<Outcome> outcomes_;          // that led it to the present trial
  NextTrial current_;
  LiveTrials live_;
  mutable std::unique_ptr<SimulatedAnswer> said_;  // of a virtual participant
  mutable TrialsRig* rig_{nullptr};                // likewise; the runner's
  std::optional<TargetLog> targets_;               // none: nothing that is seen moves by itself
  std::optional<CursorLog> cursors_;               // none: there is no cursor
  std::optional<ContactLog> contacts_;             // none: none are recorded
  KeptLogs kept_;                                  // of these
  std::shared_ptr<SeenBodies> bodies_{std::make_shared<SeenBodies>()};  // for the screen
  std::vector<record::ObjectFileRow> object_files_;
  std::vector<record::ArmRow> arms_;  // none where every arm is a tip
  BodyReport touched_bodies_;
  std::vector<record::LateWindowRow> late_again_;
  bool repeats_{false};
  std::unique_ptr<TrialPass> pass_;
  std::vector<std::vector<NamedStage>> stages_;  // of each interval of the pass
  std::vector<scene::Region> regions_;           // of the last interval
  std::vector<std::size_t> region_devices_;      // likewise
  std::vector<record::VariableRow> variables_;   // of the pass
  std::vector<sound::Cue> varied_cues_;          // of its intervals, one after the other
  std::vector<int> right_;                       // choice of each question; -1: none
};

}  // namespace haptrial::protocols
