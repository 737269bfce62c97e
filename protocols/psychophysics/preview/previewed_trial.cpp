#include "protocols/psychophysics/preview/previewed_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "protocols/psychophysics/definition/read_definition.h"
#include "protocols/psychophysics/presentation/stage_sight.h"

namespace haptrial::protocols {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

std::map<std::string, std::string> values_in_words(const Names& names) {
  std::map<std::string, std::string> words;
  for (const auto& [name, value] : names.known()) {
    words[name] = names.word_of(value).value_or(fmt::format("{:.4g}", value));
  }
  return words;
}

/// The place that the first stage waits for, or that of the hand before the trial.
Eigen::Vector3d start_of(const TrialsDefinition& d, const Presented& presented) {
  for (const NamedStage& stage : presented.stages) {
    for (std::size_t i = 0; i < presented.regions.size(); ++i) {
      const bool waits = (stage.stage.until.inside >> i & 1U) != 0;
      if (waits && presented.region_devices[i] == 0) {
        return scene::place_inside(presented.regions[i].shape);
      }
    }
  }
  return d.hands.empty() ? Eigen::Vector3d::Zero() : d.hands.front().start;
}

/// Goes through the session up to the trial as if no procedure learned anything.
std::optional<NextTrial> trial_at(TrialSequence& sequence, int number) {
  std::optional<NextTrial> next = sequence.next();
  for (int at = 1; next && at < number; ++at) {
    sequence.conclude(true, kNothing, false);
    next = sequence.next();
  }
  return next;
}

/// Everything of a trial that its names and its seed settle.
class TrialReader {
 public:
  TrialReader(const StudiedDefinition& d, const NextTrial& next)
      : d_(d), next_(next), root_(d.root()), names_(read_names(root_, d)) {}

  void read(PreviewedTrial& trial) {
    give(*names_, d_, next_.values);
    common_ = values_in_words(*names_);
    trial.values.assign(common_.begin(), common_.end());
    RandomStream random(next_.plan.stimulus_seed, "durations");
    for (std::size_t place = 0; place < next_.values.intervals.size(); ++place) {
      trial.intervals.push_back(interval(place, random));
    }
    give(*names_, d_, next_.values);
    for (const TrialQuestion& question : d_.questions) {
      trial.questions.push_back(asked(question, trial.intervals.back().presented));
    }
  }

 private:
  PreviewedInterval interval(std::size_t place, RandomStream& random) {
    const Interval& stated = d_.intervals[next_.values.intervals[place]];
    give(*names_, d_, next_.values);
    give_interval(*names_, stated, place);
    PreviewedInterval shown;
    shown.name = stated.name;
    for (const auto& [name, word] : values_in_words(*names_)) {
      const auto same = common_.find(name);
      if (name != "interval" && (same == common_.end() || same->second != word)) {
        shown.values.emplace_back(name, word);
      }
    }
    shown.presented = read_presented(root_, *names_, d_, &random);
    root_.check();
    const std::uint64_t seed =
        derived_seed(next_.plan.stimulus_seed, fmt::format("dots {}", place));
    for (std::size_t i = 0; i < shown.presented.stages.size(); ++i) {
      shown.stages.push_back(previewed_stage(d_, shown.presented, i));
      shown.sights.push_back(sight_of(shown.presented.stages[i], shown.presented, *names_, seed));
    }
    shown.start = start_of(d_, shown.presented);
    return shown;
  }

  PreviewedQuestion asked(const TrialQuestion& question, const Presented& last) const {
    PreviewedQuestion shown{&question};
    shown.right = question.correct.empty() ? -1 : right_choice(*names_, question);
    shown.feedback = question.feedback == Feedback::kAlways ||
                     (question.feedback == Feedback::kPractice && next_.plan.practice);
    for (const ChoiceMeans& means : question.means) {
      const auto region = std::ranges::find(last.regions, means.touch, &scene::Region::name);
      if (!means.touch.empty() && region != last.regions.end()) {
        const auto index = static_cast<std::size_t>(region - last.regions.begin());
        shown.sight.marks.push_back(mark_to_touch(region->shape, last.region_devices[index]));
      }
    }
    shown.sight.hand = !shown.sight.marks.empty();
    return shown;
  }

  const StudiedDefinition& d_;
  const NextTrial& next_;
  Table root_;
  std::unique_ptr<Names> names_;
  std::map<std::string, std::string> common_;  // values throughout the trial
};

}  // namespace

PreviewedTrial previewed_trial(const StudiedDefinition& d, const SessionPlace& place, int number) {
  PreviewedTrial trial;
  trial.number = number;
  trial.most = d.most_trials(place.session) + d.practice_trials(place.session);
  TrialSequence sequence(d, identity_of(d, place));
  const std::optional<NextTrial> next =
      number >= 1 && number <= trial.most ? trial_at(sequence, number) : std::nullopt;
  if (!next) {
    throw InputError(fmt::format(
        "--trial is {}; allowed: 1 to {}, the trials of session {} of {} with those of practice",
        number, trial.most, place.session, d.file_name));
  }
  trial.next = *next;
  if (next->track >= 0) {
    trial.track = sequence.running()[static_cast<std::size_t>(next->track)].name;
  }
  TrialReader(d, trial.next).read(trial);
  return trial;
}

}  // namespace haptrial::protocols
