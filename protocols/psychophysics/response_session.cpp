#include "protocols/psychophysics/response_session.h"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <span>
#include <utility>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/subject/perceiver/level_observer.h"
#include "protocols/psychophysics/definition/read_definition.h"
#include "protocols/psychophysics/subject/decider.h"

namespace haptrial::protocols {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

void refuse_depth(const StudiedDefinition& d, const std::string& why) {
  throw InputError(fmt::format("{}: {}; simulate full sessions instead (depth = \"sessions\")",
                               d.file_name, why));
}

void check_hands(const StudiedDefinition& d) {
  const ObserverPlan& plan = d.observer;
  if (!plan.people) {
    refuse_depth(d, "without [observer] nobody knows how participants answer");
  }
  if (plan.adaptation || plan.sight || d.devices() > 1) {
    refuse_depth(d, "virtual participants who adapt, see or use several devices need a hand");
  }
  if (plan.script) {
    refuse_depth(d, "observer.script answers by what a hand felt");
  }
  if (!d.measures.empty()) {
    refuse_depth(d, "[measures] are of what a hand does");
  }
  if (d.questions.empty()) {
    refuse_depth(d, "nothing is asked, so responses alone say nothing");
  }
}

/// The force of the press by which something is felt; otherwise the default.
double press_of(const ObserverPlan& plan, double otherwise) {
  for (const StageAction& action : plan.actions) {
    const auto* press = std::get_if<subject::Press>(&action.probe);
    if (press != nullptr && (plan.stage.empty() || action.stage == plan.stage)) {
      return press->force;
    }
  }
  return otherwise;
}

}  // namespace

/// One participant in one session.
class ResponseSession::SimulatedSession {
 public:
  SimulatedSession(const ResponseSession& s, const SessionPlace& place)
      : s_(s),
        owned_(s.names_->take()),
        names_(*owned_),
        sequence_(s.d_, identity_of(s.d_, place)),
        person_(derived_seed(place.hand_person_seed, "subject")),
        seed_(derived_seed(place.hand_session_seed, "subject")),
        senses_(s.d_.observer.people->draw_senses(person_)),
        judgement_(s.d_.observer.people->draw_judgement(person_)),
        levels_(senses_, s.d_.observer.senses, {s.press_}, judgement_, seed_),
        decider_(s.d_.observer, judgement_, seed_) {}

  ~SimulatedSession() { s_.names_->give_back(std::move(owned_)); }
  SimulatedSession(const SimulatedSession&) = delete;
  SimulatedSession& operator=(const SimulatedSession&) = delete;

  std::vector<AnsweredTrial> run() {
    std::vector<AnsweredTrial> trials;
    while (const std::optional<NextTrial> next = sequence_.next()) {
      trials.push_back(answer(*next));
    }
    return trials;
  }

 private:
  AnsweredTrial answer(const NextTrial& next) {
    AnsweredTrial done{next.plan, next.values.probe, {}, {}, {}};
    const int number = next.plan.trial + (next.plan.practice ? kPracticeNumbers : 0);
    give(names_, s_.d_, next.values);
    for (const std::string& name : s_.wanted_) {
      done.variables.push_back(variable(name));
    }
    const std::size_t intervals = std::min(next.values.intervals.size(), kMostIntervals);
    for (std::size_t i = 0; i < intervals; ++i) {
      give_interval(names_, s_.d_.intervals[next.values.intervals[i]], i);
      RandomStream noise = sense_stream(seed_, number, static_cast<int>(i));
      percepts_[i] = levels_.percept(names_.value(s_.met_), subject::draw_noise(noise));
    }
    give(names_, s_.d_, next.values);
    ask(number, intervals, done.answers);
    const double outcome = learnt(next, done.answers);
    note_levels(next, outcome, done.levels);
    sequence_.conclude(true, outcome, done.answers.front().correct == 1);
    return done;
  }

  record::VariableRow variable(const std::string& name) const {
    const double value = names_.value("$" + name);
    const auto word = names_.word_of(value);
    return {0, 0, name, word ? kNothing : value, word.value_or("")};
  }

  void ask(int number, std::size_t intervals, std::vector<record::ResponseRow>& answers) {
    decider_.begin_trial(number);
    for (const TrialQuestion& question : s_.d_.questions) {
      const bool first = answers.empty();
      const Decider::DecidedAnswer said =
          decider_.decide(question, first, std::span(percepts_.data(), intervals));
      record::ResponseRow& row = answers.emplace_back();
      row.question = question.name;
      const questions::Answer given = given_answer(question, said.choice, said.draft);
      row.value = given.value;
      row.text = given.text;
      if (!question.correct.empty()) {
        row.correct = right_choice(names_, question) == said.choice ? 1 : 0;
      }
    }
  }

  /// Value that the procedure learns, as DefinedTrials::outcome_of().
  double learnt(const NextTrial& next, const std::vector<record::ResponseRow>& answers) {
    if (next.track < 0) {
      return kNothing;
    }
    const Track& track = *sequence_.running()[static_cast<std::size_t>(next.track)].track;
    if (track.counts.empty()) {
      return answers.front().correct >= 0 ? answers.front().correct : kNothing;
    }
    for (const record::ResponseRow& row : answers) {
      names_.set(row.question, row.value);
    }
    return names_.value(track.counts);
  }

  void note_levels(const NextTrial& next, double outcome, std::vector<record::LevelRow>& levels) {
    if (next.track < 0) {
      return;
    }
    const RunningTrack& running = sequence_.running()[static_cast<std::size_t>(next.track)];
    const std::vector<std::string> variables = running.track->variables();
    for (std::size_t i = 0; i < variables.size(); ++i) {
      levels.push_back({0, running.name, variables[i], next.asked[i], next.applied[i], outcome});
    }
  }

  const ResponseSession& s_;
  std::unique_ptr<Names> owned_;
  Names& names_;
  TrialSequence sequence_;
  std::uint64_t person_, seed_;
  subject::SenseParameters senses_;
  subject::JudgementParameters judgement_;
  subject::LevelObserver levels_;
  Decider decider_;
  std::array<double, kMostIntervals> percepts_{};
};

ResponseSession::ResponseSession(const StudiedDefinition& definition, std::string met,
                                 std::vector<std::string> wanted)
    : d_(definition), met_(std::move(met)), wanted_(std::move(wanted)) {
  check_hands(d_);
  press_ = press_of(d_.observer, press_);
  Table root = d_.root();
  names_ = std::make_unique<NamesPool>(std::move(*read_names(root, d_)));
  root.check();
}

void ResponseSession::check_met() const {
  SessionPlace place;
  place.subject = "S01";
  give_seeds(place);
  TrialSequence sequence(d_, identity_of(d_, place));
  if (const auto next = sequence.next()) {
    std::unique_ptr<Names> owned = names_->take();
    Names& names = *owned;
    give(names, d_, next->values);
    give_interval(names, d_.intervals[next->values.intervals.front()], 0);
    static_cast<void>(names.value(met_));
  }
}

std::vector<AnsweredTrial> ResponseSession::answered(const SessionPlace& place) const {
  return SimulatedSession(*this, place).run();
}

}  // namespace haptrial::protocols
