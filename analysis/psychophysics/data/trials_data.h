#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/record/rows/object_rows.h"
#include "core/stream/marker_times.h"

namespace haptrial::analysis::trials {

/// A text that many rows repeat, as names of a definition and chosen answers are: kept once in the
/// process and never given back, so that a copy is a number. Any thread.
class Word {
 public:
  Word() noexcept = default;  // empty
  /// @throws std::out_of_range after four million different words
  Word(std::string_view text) : number_(number_of(text)) {}
  Word(const std::string& text) : number_(number_of(text)) {}
  Word(const char* text) : number_(number_of(text)) {}

  const std::string& text() const noexcept;
  operator const std::string&() const noexcept { return text(); }
  operator std::string_view() const noexcept { return text(); }
  bool empty() const noexcept { return number_ == 0; }

  friend bool operator==(Word a, Word b) noexcept { return a.number_ == b.number_; }
  friend bool operator==(Word a, const std::string& b) noexcept { return a.text() == b; }
  friend bool operator==(Word a, const char* b) noexcept { return a.text() == b; }

 private:
  static std::uint32_t number_of(std::string_view text);

  std::uint32_t number_{0};
};

inline constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// A session of the study.
struct StudySession {
  std::string file;  // name without folder
  std::string participant;
  std::string group;  // empty: the study has none
  std::string clock;  // "real" or "simulated"
  bool simulated{false};
  bool pilot{false};
  int session{1};                              // of the participant, from 1
  std::vector<record::ObjectFileRow> files{};  // of objects and sounds, as they were then
  double rate{1000.0};                         // ticks a second [Hz]
  std::size_t planned{0};                      // trials, at most; 0: the file does not say it
  std::string ended_early{};                   // why trials are left; empty: none are
  std::string name{};  // of the session in the definition; empty: it has none
};

/// An answer to one question of a trial.
struct GivenAnswer {
  Word question;
  double value{kNotKnown};          // NaN: the answer is no number
  Word text;                        // the answer as a word
  int correct{-1};                  // 1 right, 0 wrong, -1 not known
  double reaction_time{kNotKnown};  // [s]; NaN: not measured
  Word out_of_time{};               // "too fast" or "too slow"; empty: neither
};

/// Value of a variable of the definition in a trial or in one of its intervals.
struct GivenVariable {
  Word name;
  int interval{0};          // from 1; 0: the whole trial
  double value{kNotKnown};  // in the definition's unit; NaN: it is a word
  Word word;
};

/// Level that a procedure asked for, and the one that was presented.
struct GivenLevel {
  Word track;
  Word variable;
  double asked{kNotKnown};  // [unit of the variable]
  double applied{kNotKnown};
  double outcome{kNotKnown};  // what the procedure learnt; NaN: nothing
};

/// Time of a stage of an interval, in ticks: 16 bytes, as a trial has many.
struct StageTime {
  Word stage;
  std::int16_t interval{1};
  bool reached{true};      // else it ended by its time or was broken off
  bool at_limit{false};    // the force limit was reached
  std::uint32_t ticks{0};  // its duration
  std::uint32_t first{0};  // its first tick, from that of the pass
};

/// How a tool touched a body that gives way, in ticks.
struct TouchedBody {
  Word object;
  std::uint64_t contact{0};
  std::uint64_t inverted{0};  // a tetrahedron would have been inside out: the force was cut
  std::uint64_t crowded{0};   // more places of contact than are computed: felt softer
};

/// How a body that moves did so, in ticks.
struct MovingBody {
  Word object;
  std::uint64_t limited{0};      // the force was cut: it might have given out energy
  std::uint64_t flown_apart{0};  // it was put to rest
};

/// One pass of a trial, with everything that the session file says of it.
struct StudyTrial {
  std::size_t session{0};  // in TrialsData::sessions
  int trial{0};            // as in /trials
  int attempt{1};
  int block{0};
  Word condition;
  Word probe;  // empty: none
  bool practice{false};
  bool completed{true};
  bool damaged{false};             // it lost samples with its file: its answer has had its effect
  bool left_out{false};            // marked as bad, and the definition leaves such trials out
  bool again{false};               // an answer was too fast or too slow, and the trial came again
  double start{0.0};               // since the session's first tick [s]
  std::uint64_t first_sample{0};   // of the pass, in /samples of the session
  double saturated{0.0};           // share of the ticks at the force limit
  std::vector<GivenLevel> levels;  // of a level with several dimensions one each
  std::vector<GivenAnswer> answers;
  std::vector<GivenVariable> variables;
  std::vector<StageTime> stages;
  std::vector<TouchedBody> touched;
  std::vector<MovingBody> moving;

  /// Whether it was a trial of the study: completed, not presented again, and no practice. Levels
  /// of later trials may follow from it.
  bool happened() const { return completed && !again && !practice; }
  /// Whether it is analysed.
  bool counts() const { return happened() && !damaged && !left_out; }
};

/// All passes of a study, session after session, in the order of their recording.
struct TrialsData {
  std::vector<StudySession> sessions;
  std::vector<StudyTrial> trials;
  markers::MarkerLatencies markers;  // of all sessions

  bool simulated() const;
  const StudySession& session_of(const StudyTrial& trial) const { return sessions[trial.session]; }
};

/// The answer to a question, or the first one for an empty name; null: not given.
const GivenAnswer* answer_to(const StudyTrial& trial, const std::string& question);
/// A variable in a trial; null: not there. @param interval  0: the whole trial
const GivenVariable* variable_of(const StudyTrial& trial, const std::string& name,
                                 int interval = 0);

/// The last pass of a stage: an interval that was repeated has others before it; null: the trial
/// has none.
const StageTime* last_stage(const StudyTrial& trial, const std::string& stage);

/// The level of a trial under a factor, as a word: of "group", "condition", "block", "track" and
/// "probe" (empty for none), else of the variable of that name; empty: the trial has none.
std::string factor_level(const TrialsData& data, const StudyTrial& trial,
                         const std::string& factor);

/// Text of a variable as a table shows it: shortest decimals.
std::string word_of(const GivenVariable& variable);

}  // namespace haptrial::analysis::trials
