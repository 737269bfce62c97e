#include "protocols/trials/definition/trials_definition.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/text/counted.h"
#include "protocols/trials/definition/expectation.h"

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

int TrialsDefinition::combinations(const Track& track, const Block& block) const {
  std::size_t count = 1;
  for (const Factor* factor : varied_in(block)) {
    if (std::find(track.by.begin(), track.by.end(), factor->name) != track.by.end()) {
      count *= factor->levels.size();
    }
  }
  return static_cast<int>(count);
}

int TrialsDefinition::most_trials() const {
  int trials = 0;
  for (const Block& block : order.blocks) {
    int of_tracks = 0;
    for (const Track& track : tracks) {
      of_tracks += track.most_trials * combinations(track, block);
    }
    trials += block.practice ? 0 : block.trials > 0 ? block.trials : of_tracks;
  }
  return trials;
}

int TrialsDefinition::practice_trials() const {
  int trials = 0;
  for (const Block& block : order.blocks) {
    trials += block.practice ? block.trials : 0;
  }
  return trials;
}

std::vector<std::string> TrialsDefinition::description() const {
  std::vector<std::string> lines{fmt::format(
      "{}: {}, at most {}{}, {} Hz", name,
      counted(design.participants, "participant", "participants"),
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
        fmt::format("{}: {} of {}{}, at most {}{}", track.name, track.kind, track.variable,
                    track.unit.empty() ? "" : fmt::format(" [{}]", track.unit),
                    counted(track.most_trials, "trial", "trials"),
                    count > 1 ? fmt::format(" in each of {} combinations", count) : ""));
    if (const auto prediction = predicted(track)) {
      lines.push_back(*prediction);
    }
  }
  if (markers.used) {
    lines.push_back("markers: " + markers::words_of(marker_meanings()));
  }
  lines.push_back(fmt::format("about {:.0f} minutes per participant, breaks not counted",
                              longest(most_trials()) / 60.0));
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
  for (const Question& question : questions) {
    const std::string of = questions.size() > 1 ? question.name + " " : "";
    for (const std::string& answer : question.answers()) {
      add(MarkerOf::kResponse, static_cast<std::size_t>(code - markers.response), of + answer,
          code);
      ++code;
    }
  }
  return all;
}

std::vector<std::string> TrialsDefinition::warnings() const { return restless; }

double TrialsDefinition::longest(int trials) const {
  constexpr double kAnswer = 2.0;  // [s]
  return trials * (stage_time * static_cast<double>(intervals.size()) +
                   kAnswer * static_cast<double>(questions.size()));
}

}  // namespace haptrial::protocols
