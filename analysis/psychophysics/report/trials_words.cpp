#include "analysis/psychophysics/report/trials_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "analysis/psychophysics/report/report_hierarchical.h"
#include "analysis/statistics/design/design_lines.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis::trials {

const char* const kSimulatedTrials =
    "SIMULATED: the participants of this study are programs. It is a rehearsal of the experiment "
    "and its analysis and proves nothing about people.";

namespace {

/// "6 participants", and why several have no interval.
std::string people_word(const Quantity& q, std::size_t cell) {
  const std::size_t people = q.table.participants(cell);
  return counted(people, "participant") + (people > 1 && !q.means[cell] && mean_of(q, cell)
                                               ? "; no interval, because " + q.means[cell].because()
                                               : "");
}

void say_quantity(const TrialsResult& result, const Quantity& q, std::vector<std::string>& lines) {
  for (std::size_t cell = 0; cell < q.table.cells.size(); ++cell) {
    lines.push_back(
        fmt::format("{}{}: {}{} ({})", capitalized(q.title),
                    result.plan.by.empty() ? std::string() : ", " + q.table.names[cell],
                    mean_word(result, q, cell),
                    q.means[cell] || q.open.empty() ? unit_word(result, q) : std::string(),
                    people_word(q, cell)));
  }
  if (!q.open.empty()) {
    lines.push_back(fmt::format(
        "{}: the answers of {} leave a side of the interval open; they are in no mean and no test",
        capitalized(q.title), fmt::join(q.open, ", ")));
  }
}

using NamesByReason = std::map<std::string, std::vector<std::string>>;

void say_undefined(const NamesByReason& undefined, std::size_t all, const char* what,
                   std::vector<std::string>& lines) {
  for (const auto& [because, names] : undefined) {
    lines.push_back(fmt::format("{} of {} could not be determined, because {} ({})", names.size(),
                                counted(all, what), because, fmt::join(names, "; ")));
  }
}

/// Names the participants whose models are not defined. @param model  the member of a condition
template <class Condition, class Model>
void say_undefined(const std::vector<Condition>& all, Defined<Model> Condition::*model,
                   const char* what, std::vector<std::string>& lines) {
  NamesByReason undefined;
  for (const Condition& one : all) {
    if (!(one.*model)) {
      undefined[(one.*model).because()].push_back(series_name(one.participant, one.condition));
    }
  }
  say_undefined(undefined, all.size(), what, lines);
}

/// Why single estimates are missing or without an interval.
void say_gaps(const TrialsResult& result, std::vector<std::string>& lines) {
  if (result.plan.diffusion) {
    say_undefined(result.timed, &TimedCondition::diffusion, "diffusion model", lines);
  }
  if (result.plan.metacognition) {
    say_undefined(result.detected, &DetectedCondition::meta, "meta-d'", lines);
    say_undefined(result.identified, &IdentifiedCondition::meta, "meta-d'", lines);
  }
  NamesByReason undefined, without;
  for (const FunctionFit& fit : result.fits) {
    const std::string name = series_name(fit.participant, fit.condition);
    if (!fit.stated) {
      undefined[fit.stated.because()].push_back(name);
    } else if (!fit.no_interval.empty()) {
      without[fit.no_interval].push_back(name);
    }
  }
  say_undefined(undefined, result.fits.size(), "function", lines);
  for (const auto& [because, names] : without) {
    lines.push_back(fmt::format("{} of {} without an interval, because {} ({})", names.size(),
                                counted(result.fits.size(), "function"), because,
                                fmt::join(names, "; ")));
  }
}

/// Parameters of surfaces whose posterior the definition's list of values cuts off.
void say_cut_parameters(const TrialsResult& result, std::vector<std::string>& lines) {
  std::map<std::string, std::pair<int, int>> cut;  // of how many
  for (const SurfaceCondition& one : result.surfaces) {
    for (const SurfaceParameter& p :
         one.fit ? one.fit->parameters : std::vector<SurfaceParameter>{}) {
      cut[p.name].first += p.at_edge ? 1 : 0;
      ++cut[p.name].second;
    }
  }
  for (const auto& [name, counts] : cut) {
    if (counts.first > 0) {
      lines.push_back(fmt::format(
          "Parameter {}: its list of values cuts off the posterior in {} of {} fits and decides "
          "the estimate there",
          name, counts.first, counts.second));
    }
  }
}

/// Tracks whose range, and not the answers, settled where they were.
void say_ended_tracks(const TrialsResult& result, std::vector<std::string>& lines) {
  std::vector<std::string> ended;
  for (const TrackEstimate& track : result.tracks) {
    const bool own = !track.estimates.empty() && track.estimates.front().interval;
    if (track.ended_at_range() && !own) {
      ended.push_back(fmt::format("{} {}, {} of {} trials", track.participant, track.track,
                                  track.at_end, track.steps.size()));
    }
  }
  if (!ended.empty()) {
    lines.push_back(fmt::format(
        "{} at an end of the range ({}): their own estimates tell the range, not the participant",
        counted(ended.size(), "track") + (ended.size() == 1 ? " was" : " were"),
        fmt::join(ended, "; ")));
  }
}

void add_tests(const TrialsResult& result, const Quantity& q, bool effects,
               std::vector<std::string>& lines) {
  if (!q.compared || !q.headline) {
    return;
  }
  const auto add = [&](std::vector<std::string> more) {
    for (std::string& line : more) {
      lines.push_back(capitalized(tested_title(result, q)) + ". " + line);
    }
  };
  if (effects) {
    add(effect_lines(q.tests));
  }
  add(planned_lines(q.tests));
  add(unplanned_lines(q.tests));
}

void add_reaching(const ReachingResult& reaching, std::vector<std::string>& lines) {
  for (const ReachContrast& each : reaching.contrasts) {
    if (!each.contrast) {
      continue;
    }
    const TTest& test = each.contrast->test;
    const double scale = each.unit.empty() ? 1.0 : kMillimetres;
    lines.push_back(fmt::format(
        "{}: difference {}{}, 95 % CI {} to {}, {}, {} after Holm's adjustment", each.name,
        number(scale * test.difference), each.unit.empty() ? "" : " mm", number(scale * test.low),
        number(scale * test.high), t_result(test), p_result(each.holm)));
  }
  for (const ReachBlock& block : reaching.blocks) {
    if (block.fit) {
      const ExponentialFit& fit = block.fit->fit;
      lines.push_back(fmt::format("{}: error from {} to {} mm with a time constant of {} cycles",
                                  block.name, number(kMillimetres * fit.at(0.0)),
                                  number(kMillimetres * fit.asymptote), number(fit.time_constant)));
    }
  }
}

void add_cue_lines(const CuePlan& plan, const std::string& unit, const CueStudy& cues,
                   std::vector<std::string>& lines) {
  const std::string first = name_of_cue(plan.first), second = name_of_cue(plan.second);
  for (const CueLevel& level : cues.levels) {
    const std::string at =
        level.level.empty() ? std::string() : fmt::format(" at {} {}", plan.at, level.level);
    const auto mean = [&](Estimated CuePerson::*number, bool geometric) {
      return estimate_word(mean_of(level, number, geometric));
    };
    const auto tested = [](const CueTest& test) {
      return t_result(test.test) + (test.holm ? ", " + p_result(test.holm) + " after Holm" : "");
    };
    lines.push_back(fmt::format("Weight of {}{}: observed {}, predicted {}; {} ({})", first, at,
                                mean(&CuePerson::weight, false),
                                mean(&CuePerson::predicted_weight, false), tested(level.weight),
                                counted(level.people.size(), "participant")));
    lines.push_back(fmt::format(
        "Standard deviation{}{}: {} {}, {} {}, both {}, predicted {}; observed and predicted {}; "
        "both better than the better one {}",
        at, unit.empty() ? "" : " (" + unit + ")", first, mean(&CuePerson::first_sd, true), second,
        mean(&CuePerson::second_sd, true), mean(&CuePerson::both_sd, true),
        mean(&CuePerson::predicted_sd, true), tested(level.log_sd), tested(level.beats_best)));
    if (!level.left_out.empty()) {
      lines.push_back(fmt::format("{} left out{}, for lack of a condition or of a function",
                                  counted(level.left_out.size(), "participant"), at));
    }
  }
  if (cues.levels.empty()) {
    lines.push_back(
        fmt::format("Cues cannot be compared: there are no answers of {}", name_of_cue(plan.both)));
  }
}

}  // namespace

std::string estimate_word(const Estimated& e) {
  return number_with_interval(e.value, e.low, e.high);
}

namespace {

std::uint64_t ticks_in_contact(const StudyTrial& trial) {
  std::uint64_t sum = 0;
  for (const TouchedBody& body : trial.touched) {
    sum += body.contact;
  }
  return sum;
}

/// Ticks on which bodies that give way were not felt as they should be.
/// @param bodies  of a trial, and a count of each
template <class Body>
void add_touched(const TrialsData& data, std::vector<Body> StudyTrial::*bodies,
                 std::uint64_t Body::*ticks, const char* what, std::vector<std::string>& lines) {
  std::uint64_t sum = 0, contact = 0;
  std::size_t trials = 0;
  for (const StudyTrial& trial : data.trials) {
    const std::uint64_t before = sum;
    for (const Body& body : trial.*bodies) {
      sum += body.*ticks;
    }
    contact += ticks_in_contact(trial);
    trials += sum > before ? 1 : 0;
  }
  if (sum > 0) {
    lines.push_back(
        fmt::format("In {}, on {} of {} ticks in contact with a body that gives way ({}), {}.",
                    counted(trials, "trial"), sum, contact,
                    percent(static_cast<double>(sum) /
                            static_cast<double>(std::max<std::uint64_t>(contact, 1))),
                    what));
  }
}

}  // namespace

Estimated estimated(const psychometric::Estimate& e) {
  return e.interval ? Estimated{e.value, e.interval->low, e.interval->high} : Estimated{e.value};
}

std::string percent(double share) { return fmt::format("{:.3g} %", 100.0 * share); }

std::string series_name(const std::string& participant, const std::string& condition) {
  return condition.empty() ? participant : participant + ", " + condition;
}

const char* method_of(const FunctionFit& fit) { return fit.adaptive ? "posterior" : "likelihood"; }

std::string mean_word(const TrialsResult& result, const Quantity& q, std::size_t cell) {
  const auto& mean = q.means[cell];
  const psychometric::Axis& axis = result.plan.function.axis;
  const auto level = [&](double value) { return q.on_axis ? axis.level(value) : value; };
  if (!mean) {
    const auto value = mean_of(q, cell);
    if (!value) {
      return "no mean, because " + mean.because();
    }
    return number(level(*value));
  }
  const double low = level(mean->low), high = level(mean->high);
  return fmt::format("{}, 95 % CI {} to {}", number_within(level(mean->mean), low, high),
                     number(low), number(high));
}

std::string tested_title(const TrialsResult& result, const Quantity& q) {
  const bool same = !q.on_axis || q.unit == result.plan.function.axis.unit;
  return q.title + (same ? "" : ", in " + q.unit);
}

std::string unit_word(const TrialsResult& result, const Quantity& q) {
  const std::string& unit = q.on_axis ? result.plan.function.axis.unit : q.unit;
  return unit.empty() ? std::string() : " " + unit;
}

namespace {

/// "2 of 40 planned trials of 1 participant" where a session ended early, else "40 trials of …".
std::string trials_line(const TrialsResult& result) {
  std::size_t done = 0, planned = 0;
  for (const ParticipantTrials& person : result.participants) {
    done += person.counted;
    planned += person.planned;
  }
  const bool early = std::ranges::any_of(
      result.data.sessions, [](const StudySession& s) { return !s.ended_early.empty(); });
  return fmt::format("{} of {}{}",
                     early && planned > 0 ? fmt::format("{} of {} planned trials", done, planned)
                                          : counted(done, "trial"),
                     counted(result.participants.size(), "participant"),
                     result.simulated() ? " (simulated)" : "");
}

void say_unused(const TrialsResult& result, std::vector<std::string>& lines) {
  std::size_t all = 0;
  for (const ParticipantTrials& person : result.participants) {
    all += person.counted;
  }
  for (const UnusedTrials& unused : result.unused) {
    lines.push_back(fmt::format("{} of {} {} not analysed, because {}", unused.count,
                                counted(all, "trial"), unused.count == 1 ? "is" : "are",
                                unused.because));
  }
}

}  // namespace

std::vector<std::string> summary_lines(const TrialsResult& result) {
  std::vector<std::string> lines{trials_line(result)};
  say_unused(result, lines);
  for (const StudySession& session : result.data.sessions) {
    if (!session.ended_early.empty()) {
      lines.push_back(fmt::format("trials are missing: {} {}", session.file, session.ended_early));
    }
  }
  if (result.cues) {
    add_cue_lines(*result.plan.cues, result.plan.function.axis.x_unit(), *result.cues, lines);
  }
  for (const Quantity& q : result.quantities) {
    if (q.headline && q.name != "log_width" && !result.cues) {  // beside cues, a table says it
      say_quantity(result, q, lines);
    }
    lines.insert(lines.end(), q.missing.begin(), q.missing.end());
  }
  for (const Quantity& q : result.quantities) {
    add_tests(result, q, !result.cues, lines);
  }
  if (result.hierarchical) {
    lines.push_back(hierarchical_sentence(result));
  }
  if (result.reaching) {
    add_reaching(*result.reaching, lines);
  }
  say_gaps(result, lines);
  say_cut_parameters(result, lines);
  say_ended_tracks(result, lines);
  return lines;
}

std::vector<std::string> body_lines(const TrialsResult& result) {
  std::vector<std::string> lines;
  add_touched(result.data, &StudyTrial::touched, &TouchedBody::inverted,
              "the hand pressed it deeper than its elements can follow, and the force did not grow",
              lines);
  add_touched(result.data, &StudyTrial::touched, &TouchedBody::crowded,
              "the ball lay on more places than are computed, and the body may have been felt "
              "softer",
              lines);
  add_touched(result.data, &StudyTrial::moving, &MovingBody::limited,
              "the force was cut, as it might have given out more energy than the hand had given",
              lines);
  add_touched(result.data, &StudyTrial::moving, &MovingBody::flown_apart,
              "the body flew apart and was put to rest", lines);
  return lines;
}

}  // namespace haptrial::analysis::trials
