#include "protocols/psychophysics/definition/trials_definition.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/base/counted.h"
#include "core/base/definition/table.h"
#include "core/psychometric/definition/expectation.h"
#include "core/record/rows/trial_rows.h"
#include "protocols/psychophysics/definition/only_seen.h"

namespace haptrial::protocols {

std::vector<const Factor*> TrialsDefinition::varied_in(const Block& block) const {
  std::vector<const Factor*> varied;
  for (const Factor& factor : order.factors) {
    const auto given = [&](const GivenValue& value) { return value.name == factor.name; };
    if (std::none_of(block.values.begin(), block.values.end(), given)) {
      varied.push_back(&factor);
    }
  }
  return varied;
}

std::vector<const Track*> TrialsDefinition::tracks_in(const Block& block) const {
  std::vector<const Track*> asked;
  for (const Track& track : tracks) {
    const bool given = std::ranges::any_of(
        block.values, [&](const GivenValue& value) { return track.sets(value.name); });
    if (block.procedures.empty() && given) {
      return {};
    }
    if (block.procedures.empty() ||
        std::ranges::find(block.procedures, track.name) != block.procedures.end()) {
      asked.push_back(&track);
    }
  }
  return asked;
}

std::vector<const Factor*> TrialsDefinition::varied_by(const Track& track,
                                                       const Block& block) const {
  std::vector<const Factor*> by = varied_in(block);
  std::erase_if(by, [&](const Factor* factor) {
    return std::ranges::find(track.by, factor->name) == track.by.end();
  });
  return by;
}

std::map<std::string, std::string> TrialsDefinition::shown_conditions() const {
  std::map<std::string, std::string> shown;
  if (order.factors.empty()) {
    return shown;
  }
  const std::vector<std::string> written = root().table("factors").keys_as_written();
  const auto place = [&](const GivenValue& value) {
    return std::ranges::find(written, value.name);
  };
  const auto add = [&](const std::vector<const Factor*>& factors) {
    for (std::vector<GivenValue>& combination : crossed(factors)) {
      const std::string recorded = record::condition_label(levels_of(combination));
      std::ranges::sort(combination, {}, place);
      shown.try_emplace(recorded, fmt::format("{}", fmt::join(levels_of(combination), ", ")));
    }
  };
  for (const Block& block : order.blocks) {
    const std::vector<const Track*> asked = tracks_in(block);
    for (const Track* track : asked) {
      add(varied_by(*track, block));
    }
    if (asked.empty()) {
      add(varied_in(block));
    }
  }
  shown.erase("");  // a trial without a combination has the name of its block
  return shown;
}

int TrialsDefinition::combinations(const Track& track, const Block& block) const {
  std::size_t count = 1;
  for (const Factor* factor : varied_by(track, block)) {
    count *= factor->levels.size();
  }
  return static_cast<int>(count);
}

namespace {

/// Count for the session that is asked for; the most of all sessions for 0.
template <class Trials>
int of_sessions(const TrialDesign& design, int session, Trials&& trials) {
  int most = 0;
  for (int each = 1; each <= design.sessions; ++each) {
    if (session == 0 || session == each) {
      int sum = 0;
      for (const std::size_t block : design.blocks_of(each)) {
        sum += trials(design.blocks[block]);
      }
      most = std::max(most, sum);
    }
  }
  return most;
}

}  // namespace

int TrialsDefinition::most_trials(int session) const {
  return of_sessions(order, session, [&](const Block& block) {
    int of_tracks = 0;
    for (const Track* track : tracks_in(block)) {
      of_tracks += track->most_trials * combinations(*track, block);
    }
    if (block.probe && block.trials == 0) {  // beside those of its procedures, on average
      of_tracks +=
          static_cast<int>(std::ceil(of_tracks * block.probe->share / (1.0 - block.probe->share)));
    }
    return block.practice ? 0 : block.trials > 0 ? block.trials : of_tracks;
  });
}

int TrialsDefinition::practice_trials(int session) const {
  return of_sessions(order, session,
                     [](const Block& block) { return block.practice ? block.trials : 0; });
}

namespace {

/// How long each participant's session takes, or each of several sessions.
void add_sessions(const TrialsDefinition& d, std::vector<std::string>& lines) {
  if (d.order.sessions == 1) {
    lines.push_back(fmt::format("about {} per participant, breaks and pages not counted",
                                planned_minutes(d.longest(d.most_trials()))));
    return;
  }
  for (int session = 1; session <= d.order.sessions; ++session) {
    std::vector<std::string> names;
    for (const std::size_t block : d.order.blocks_of(session)) {
      names.push_back(d.order.blocks[block].name);
    }
    lines.push_back(fmt::format("session {}: {}; at most {}, about {}", session,
                                fmt::join(names, ", "),
                                counted(d.most_trials(session), "trial", "trials"),
                                planned_minutes(d.longest(d.most_trials(session)))));
  }
}

}  // namespace

std::vector<std::string> TrialsDefinition::description() const {
  std::vector<std::string> lines{fmt::format(
      "{}: {}{}, at most {}{}, {} Hz", name,
      counted(design.participants, "participant", "participants"),
      order.sessions > 1 ? fmt::format(" with {} sessions each", order.sessions) : "",
      counted(most_trials(), "trial", "trials"),
      practice_trials() > 0 ? fmt::format(" and {} of practice", practice_trials()) : "", rate)};
  lines.push_back(fmt::format("each of {}{}",
                              counted(static_cast<int>(intervals.size()), "interval", "intervals"),
                              questions.empty() ? "" : ", then asks: " + questions.front().text));
  for (const Track& track : tracks) {
    int count = 1;
    for (const Block& block : order.blocks) {
      count = std::max(count, combinations(track, block));
    }
    lines.push_back(
        fmt::format("{}: {} of {}{}, at most {}{}", track.name, track.kind,
                    fmt::join(track.variables(), " and "),
                    track.unit.empty() ? "" : fmt::format(" [{}]", track.unit),
                    counted(track.most_trials, "trial", "trials"),
                    count > 1 ? fmt::format(" in each of {} combinations", count) : ""));
    if (const auto prediction = predicted(track)) {
      lines.push_back(*prediction);
    }
  }
  lines.insert(lines.end(), felt.begin(), felt.end());
  if (markers.used) {
    lines.push_back("markers: " + markers::words_of(marker_meanings()));
  }
  add_sessions(*this, lines);
  return lines;
}

std::vector<markers::MarkerMeaning> TrialsDefinition::marker_meanings() const {
  using record::MarkerOf;
  std::vector<markers::MarkerMeaning> all{{MarkerOf::kTrial, 0, "trial", markers.trial}};
  const auto add = [&](MarkerOf what, std::size_t index, const std::string& word, int code) {
    all.push_back({what, static_cast<std::int16_t>(index), word, code});
  };
  for (std::size_t i = 0; intervals.size() > 1 && i < intervals.size(); ++i) {
    add(MarkerOf::kInterval, i, intervals[i].name, markers.interval + static_cast<int>(i));
  }
  for (std::size_t i = 0; i < stages.size(); ++i) {
    add(MarkerOf::kStage, i, stages[i],
        stage_markers[i] > 0 ? stage_markers[i] : markers.stage + static_cast<int>(i));
  }
  int code = markers.response;
  for (const TrialQuestion& question : questions) {
    const std::string of = questions.size() > 1 ? question.name + " " : "";
    for (const std::string& answer : question.answers()) {
      add(MarkerOf::kResponse, static_cast<std::size_t>(code - markers.response), of + answer,
          code);
      ++code;
    }
  }
  return all;
}

std::string ramped_in(const std::string& what, double ramp) {
  return fmt::format(
      "{}, while the device's force ramps in for {:g} s (envelope.ramp_in), so that the hand feels "
      "less; let another stage come first",
      what, ramp);
}

std::vector<std::string> TrialsDefinition::warnings() const {
  std::vector<std::string> all = unmatched_literals(text);
  all.insert(all.end(), underdamped.begin(), underdamped.end());
  std::ranges::move(only_seen(*this, questions), std::back_inserter(all));
  for (const Track& track : tracks) {
    if (track.warnings) {
      std::ranges::move(track.warnings(track), std::back_inserter(all));
    }
  }
  if (script) {
    all.push_back(fmt::format(
        "{} chooses the levels (level_script); what is said of the procedures holds for levels of "
        "their own, which are presented where it gives none",
        script->file.filename().string()));
  }
  for (const Measure& measure : measures) {
    const double ramp = arms()[measure.device].limits.ramp_in;
    if (measure.stage == 0 && measure.quantity == MeasuredQuantity::kForce && ramp > 0.0) {
      all.push_back(ramped_in(
          fmt::format("measures.{} takes the force that the fields give in the first stage",
                      measure.name),
          ramp));
    }
  }
  if (mirror_left_handed && !channels.empty()) {
    all.push_back(
        "what channels say is not mirrored for left-handed participants "
        "(design.mirror_left_handed): a force or place along x has the other sign for them than "
        "for "
        "right-handed ones, in stages, measures and tables");
  }
  for (const TrialQuestion& question : questions) {
    const bool tells = question.has_limits() || question.feedback != Feedback::kNever;
    if (tells && feedback_time == 0.0) {
      all.push_back(
          fmt::format("the participant is to be told of answers to \"{}\", but "
                      "display.feedback_time is 0 s, so "
                      "that nothing is shown",
                      question.name));
    }
    if (question.again && !order.most_in_a_row.empty()) {
      all.push_back(fmt::format(
          "trials with an answer to \"{}\" that is out of time come again at the end of their "
          "block, in whatever order they come, so that more trials than design.most_in_a_row "
          "says may follow each other there",
          question.name));
    }
  }
  return all;
}

std::vector<ButtonUse> TrialsDefinition::button_uses() const {
  std::vector<ButtonUse> uses;
  for (std::size_t i = 0; i < stage_buttons.size(); ++i) {
    const std::string place = fmt::format("stages[{}]", i + 1);
    uses.push_back({place + ".until.buttons", stage_buttons[i], place});
  }
  const bool several = document != nullptr && root().has("responses");
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const std::string place =
        several ? fmt::format("responses[{}]", i + 1) : std::string("response");
    if (questions[i].mark.by == MarkedBy::kHand) {
      uses.push_back({place + ".buttons", questions[i].mark.buttons, place});
    }
    for (std::size_t c = 0; c < questions[i].means.size(); ++c) {
      uses.push_back({fmt::format("{}.choices[{}].buttons", place, c + 1),
                      questions[i].means[c].buttons, place});
    }
  }
  return uses;
}

bool TrialsDefinition::hears_pointer() const {
  return std::ranges::any_of(
      questions, [](const TrialQuestion& each) { return each.mark.by == MarkedBy::kMouse; });
}

int TrialsDefinition::force_delay(std::size_t arm) const {
  return hands.empty() ? device.force_delay
                       : hands[hands[arm].of].force_delay.value_or(device.force_delay);
}

PedalUse TrialsDefinition::pedal_use() const {
  PedalUse use = PedalUse::kNone;
  for (const TrialQuestion& question : questions) {
    for (const ChoiceMeans& choice : question.means) {
      if (choice.pedal > 0.0) {
        const bool alone = choice.keys == 0 && choice.buttons == 0 && choice.touch.empty();
        use = std::max(use, alone ? PedalUse::kOnly : PedalUse::kBeside);
      }
    }
  }
  return use;
}

double TrialsDefinition::longest(int trials) const {
  constexpr double kAnswer = 2.0;  // [s]
  return trials * (stage_time * static_cast<double>(intervals.size()) +
                   kAnswer * static_cast<double>(questions.size()));
}

}  // namespace haptrial::protocols
