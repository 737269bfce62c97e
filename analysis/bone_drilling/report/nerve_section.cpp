#include "analysis/bone_drilling/report/nerve_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "analysis/bone_drilling/report/with_without.h"

namespace haptrial::analysis::drilling {
namespace {

using Row = std::vector<std::string>;
using Some = std::vector<const NerveProcedure*>;

constexpr double kLittle = 0.5;  // train time, below which palsy is rare (Prell et al. 2007) [s]
constexpr double kMuch = 10.0;   // above which it is common [s]

/// Procedures by condition in the order of first appearance, "monitor on" first.
std::vector<std::pair<std::string, Some>> by_condition(
    const std::vector<NerveProcedure>& procedures) {
  std::vector<std::pair<std::string, Some>> groups;
  for (const NerveProcedure& p : procedures) {
    auto at = std::find_if(groups.begin(), groups.end(),
                           [&](const auto& group) { return group.first == p.condition; });
    if (at == groups.end()) {
      at = groups.insert(p.given ? groups.begin() : groups.end(), {p.condition, {}});
    }
    at->second.push_back(&p);
  }
  return groups;
}

Row counts_row(const std::string& condition, const std::string& nerve, const Some& procedures) {
  NerveCounts sum;
  double minutes = 0.0;
  for (const NerveProcedure* p : procedures) {
    minutes += p->drilling / 60.0;
    for (const NerveCounts& each : p->nerves) {
      if (each.nerve == nerve) {
        sum.bursts += each.bursts;
        sum.trains += each.trains;
        sum.responses += each.responses;
        sum.train_time += each.train_time;
      }
    }
  }
  return {condition,
          nerve,
          std::to_string(procedures.size()),
          fmt::format("{:.1f}", minutes),
          std::to_string(sum.bursts),
          std::to_string(sum.trains),
          std::to_string(sum.responses),
          fmt::format("{:.1f}", sum.train_time),
          minutes > 0.0 ? fmt::format("{:.2f}", sum.events() / minutes) : "–"};
}

std::vector<double> reactions_of(const Some& procedures) {
  std::vector<double> times;
  for (const NerveProcedure* p : procedures) {
    for (const NerveReaction& reaction : p->reactions) {
      if (reaction.lift_off) {
        times.push_back(*reaction.lift_off);
      }
    }
  }
  std::sort(times.begin(), times.end());
  return times;
}

std::string quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) {
    return "–";
  }
  const auto last = static_cast<double>(sorted.size() - 1);
  return fmt::format("{:.2f}", sorted[static_cast<std::size_t>(share * last + 0.5)]);
}

Row reaction_row(const std::string& condition, const Some& procedures) {
  const std::vector<double> times = reactions_of(procedures);
  std::size_t open = 0;
  for (const NerveProcedure* p : procedures) {
    open += p->reactions.size();
  }
  return {condition,
          std::to_string(times.size()),
          std::to_string(open - times.size()),
          quantile(times, 0.5),
          quantile(times, 0.25),
          quantile(times, 0.75)};
}

Row train_row(const std::string& condition, const Some& procedures) {
  const auto count = [&](double low, double high) {
    return std::to_string(std::count_if(procedures.begin(), procedures.end(), [&](const auto* p) {
      return p->train_time() >= low && p->train_time() < high;
    }));
  };
  return {condition, count(0.0, kLittle), count(kLittle, kMuch), count(kMuch, 1e9)};
}

std::optional<double> reaction_value(const NerveProcedure& p) { return p.reaction(); }
std::optional<double> train_value(const NerveProcedure& p) { return p.train_time(); }
std::optional<double> rate_value(const NerveProcedure& p) {
  return p.drilling > 0.0 ? std::optional(60.0 * p.events() / p.drilling) : std::nullopt;
}

std::vector<GivenValue> values_of(const std::vector<NerveProcedure>& procedures,
                                  std::optional<double> (*value)(const NerveProcedure&)) {
  std::vector<GivenValue> values;
  for (const NerveProcedure& p : procedures) {
    values.push_back({p.participant, p.given, value(p)});
  }
  return values;
}

std::string on_off_word(const std::vector<NerveProcedure>& procedures,
                        std::optional<double> (*value)(const NerveProcedure&), const char* unit) {
  return difference_word(with_less_without(values_of(procedures, value)), unit);
}

NerveDetection all_detection(const std::vector<NerveProcedure>& procedures) {
  NerveDetection sum;
  for (const NerveProcedure& p : procedures) {
    sum.add(p.detection);
  }
  return sum;
}

std::string part_of(int part, int of) {
  return of > 0 ? fmt::format("{} of {} ({:.1f} %)", part, of, 100.0 * part / of) : "none planted";
}

Row result_row(const char* what, const std::string& result) { return {what, result}; }

void add_detection(Document& document, const NerveDetection& d) {
  document.table(
      {"the monitor against what was put into the electromyograms", "result"},
      {result_row("discharges found", part_of(d.found, d.planted)),
       result_row("of those with a peak above the threshold", part_of(d.above_found, d.above)),
       result_row("false alarms",
                  fmt::format("{} in {:.2f} h, {:.1f} an hour", d.false_alarms, d.hours,
                              d.hours > 0.0 ? d.false_alarms / d.hours : 0.0)),
       result_row("artefacts taken for events", part_of(d.artefacts_passed, d.artefacts)),
       result_row("train time", fmt::format("{:.2f} s counted, {:.2f} s planted", d.found_train,
                                            d.planted_train))});
}

}  // namespace

void add_nerve_section(Document& document, const std::vector<NerveProcedure>& procedures,
                       bool simulated) {
  if (procedures.empty()) {
    return;
  }
  document.heading(simulated ? "Nerve monitor (simulated)" : "Nerve monitor");
  document.paragraph(
      "Nerves, electromyograms and monitor are a model to train with; whoever drills, these are "
      "simulated, and nothing here is a clinical claim. An event is a burst or a train that the "
      "monitor found; its reaction time runs from the first event of a stretch of drilling to the "
      "lift-off that ends it.");
  std::vector<Row> counts, reactions, trains;
  for (const auto& [condition, some] : by_condition(procedures)) {
    for (const NerveCounts& nerve : some.front()->nerves) {
      counts.push_back(counts_row(condition, nerve.nerve, some));
    }
    reactions.push_back(reaction_row(condition, some));
    trains.push_back(train_row(condition, some));
  }
  document.table({"condition", "nerve", "procedures", "drilling [min]", "bursts", "trains",
                  "responses", "train time [s]", "events a minute of drilling"},
                 counts);
  document.table({"condition", "reactions", "without a lift-off", "median reaction time [s]",
                  "first quartile", "third quartile"},
                 reactions);
  document.table(
      {"condition", "procedures below 0.5 s of train time", "0.5 s to 10 s", "10 s and more"},
      trains);
  if (has_both(values_of(procedures, rate_value))) {
    document.table(
        {"monitor on less monitor off, participants' means", "result"},
        {result_row("events a minute of drilling", on_off_word(procedures, rate_value, "1/min")),
         result_row("train time of a procedure", on_off_word(procedures, train_value, "s")),
         result_row("median reaction time", on_off_word(procedures, reaction_value, "s"))});
    document.paragraph("The three results are not adjusted for each other.");
  }
  std::vector<Row> timeline;
  for (const NerveProcedure& p : procedures) {
    for (const NerveReaction& reaction : p.reactions) {
      timeline.push_back({p.participant, std::to_string(p.number), p.condition,
                          fmt::format("{:.2f}", reaction.begin),
                          reaction.lift_off ? fmt::format("{:.2f}", *reaction.lift_off) : "–"});
    }
  }
  document.table(
      {"participant", "procedure", "condition", "first event at [s]", "lift-off after [s]"},
      timeline, "First events of stretches of drilling");
  add_detection(document, all_detection(procedures));
}

std::vector<std::string> nerve_lines(const std::vector<NerveProcedure>& procedures) {
  std::vector<std::string> lines;
  for (const auto& [condition, some] : by_condition(procedures)) {
    int events = 0;
    double trains = 0.0;
    for (const NerveProcedure* p : some) {
      events += p->events();
      trains += p->train_time();
    }
    lines.push_back(
        fmt::format("{}: {} nerve events in {} procedures, train time {:.1f} s, median "
                    "reaction {} s",
                    condition, events, some.size(), trains, quantile(reactions_of(some), 0.5)));
  }
  return lines;
}

}  // namespace haptrial::analysis::drilling
