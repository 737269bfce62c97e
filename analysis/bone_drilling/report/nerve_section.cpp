#include "analysis/bone_drilling/report/nerve_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "analysis/bone_drilling/report/with_without.h"

namespace haptrial::analysis::drilling {
namespace {

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

FindingRow counts_row(const std::string& condition, const std::string& nerve,
                      const Some& procedures) {
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
  return {plain_finding("condition", "condition", condition),
          plain_finding("nerve", "nerve", nerve),
          plain_finding("procedures", "procedures", procedures.size()),
          plain_finding("drilling_min", "drilling", minutes, "min"),
          plain_finding("bursts", "bursts", sum.bursts),
          plain_finding("trains", "trains", sum.trains),
          plain_finding("responses", "responses", sum.responses),
          plain_finding("train_time_s", "train time", sum.train_time, "s"),
          plain_finding("events_per_minute", "events a minute of drilling",
                        minutes > 0.0 ? sum.events() / minutes : FindingValue(), "1/min")};
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

std::optional<double> quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) {
    return std::nullopt;
  }
  const auto last = static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(share * last + 0.5)];
}

FindingRow reaction_row(const std::string& condition, const Some& procedures) {
  const std::vector<double> times = reactions_of(procedures);
  std::size_t open = 0;
  for (const NerveProcedure* p : procedures) {
    open += p->reactions.size();
  }
  const auto at = [&](double share) {
    const auto value = quantile(times, share);
    return value ? FindingValue(*value) : FindingValue();
  };
  return {plain_finding("condition", "condition", condition),
          plain_finding("reactions", "reactions", times.size()),
          plain_finding("without_lift_off", "without a lift-off", open - times.size()),
          plain_finding("median_s", "median reaction time", at(0.5), "s"),
          plain_finding("first_quartile_s", "first quartile", at(0.25), "s"),
          plain_finding("third_quartile_s", "third quartile", at(0.75), "s")};
}

FindingRow train_row(const std::string& condition, const Some& procedures) {
  const auto count = [&](double low, double high) {
    return std::count_if(procedures.begin(), procedures.end(), [&](const auto* p) {
      return p->train_time() >= low && p->train_time() < high;
    });
  };
  return {plain_finding("condition", "condition", condition),
          plain_finding("below_0.5_s", "procedures below 0.5 s of train time", count(0.0, kLittle)),
          plain_finding("0.5_to_10_s", "0.5 s to 10 s", count(kLittle, kMuch)),
          plain_finding("10_s_and_more", "10 s and more", count(kMuch, 1e9))};
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

void add_on_off(FindingRow& findings, const char* name, const char* title, const char* unit,
                const std::vector<NerveProcedure>& procedures,
                std::optional<double> (*value)(const NerveProcedure&)) {
  const WithWithout difference = with_less_without(values_of(procedures, value));
  std::ranges::move(
      difference_findings(std::string("with_less_without/") + name, title, unit, difference),
      std::back_inserter(findings));
}

NerveDetection all_detection(const std::vector<NerveProcedure>& procedures) {
  NerveDetection sum;
  for (const NerveProcedure& p : procedures) {
    sum.add(p.detection);
  }
  return sum;
}

FindingRow part_row(const char* what, int part, int of) {
  return {plain_finding("what", "the monitor against what was put into the electromyograms", what),
          plain_finding("found", "found", part), plain_finding("of", "of", of),
          plain_finding("share", "share", of > 0 ? 100.0 * part / of : FindingValue(), "%")};
}

void add_detection(FindingList& list, const NerveDetection& d) {
  list.tables.push_back(
      {"detection",
       "",
       {part_row("discharges", d.found, d.planted),
        part_row("of those with a peak above the threshold", d.above_found, d.above),
        part_row("artefacts taken for events", d.artefacts_passed, d.artefacts)}});
  list.tables.push_back(
      {"alarms",
       "",
       {{plain_finding("false_alarms", "false alarms", d.false_alarms),
         plain_finding("hours", "in", d.hours, "h"),
         plain_finding("false_alarms_per_hour", "false alarms an hour",
                       d.hours > 0.0 ? d.false_alarms / d.hours : FindingValue(), "1/h"),
         plain_finding("train_time_counted_s", "train time counted", d.found_train, "s"),
         plain_finding("train_time_planted_s", "planted", d.planted_train, "s")}}});
}

FindingTable timeline_of(const std::vector<NerveProcedure>& procedures) {
  FindingTable table{
      .name = "first_events", .title = "First events of stretches of drilling", .folded = true};
  for (const NerveProcedure& p : procedures) {
    for (const NerveReaction& reaction : p.reactions) {
      table.rows.push_back(
          {plain_finding("participant", "participant", p.participant),
           plain_finding("procedure", "procedure", p.number),
           plain_finding("condition", "condition", p.condition),
           plain_finding("begin_s", "first event at", reaction.begin, "s"),
           plain_finding("lift_off_s", "lift-off after",
                         reaction.lift_off ? FindingValue(*reaction.lift_off) : FindingValue(),
                         "s")});
    }
  }
  return table;
}

}  // namespace

FindingList nerve_findings(const std::vector<NerveProcedure>& procedures) {
  FindingList list{.name = "nerve_monitor", .heading = "Nerve monitor"};
  if (procedures.empty()) {
    return list;
  }
  FindingTable counts{"events", ""}, reactions{"reactions", ""}, trains{"train_times", ""};
  for (const auto& [condition, some] : by_condition(procedures)) {
    for (const NerveCounts& nerve : some.front()->nerves) {
      counts.rows.push_back(counts_row(condition, nerve.nerve, some));
    }
    reactions.rows.push_back(reaction_row(condition, some));
    trains.rows.push_back(train_row(condition, some));
  }
  list.tables = {counts, reactions, trains, timeline_of(procedures)};
  add_detection(list, all_detection(procedures));
  Document words;
  words.paragraph(
      "Nerves, electromyograms and monitor are a model to train with; whoever drills, these are "
      "simulated, and nothing here is a clinical claim. An event is a burst or a train that the "
      "monitor found; its reaction time runs from the first event of a stretch of drilling to the "
      "lift-off that ends it.");
  if (has_both(values_of(procedures, rate_value))) {
    add_on_off(list.findings, "events_per_minute", "events a minute of drilling", "1/min",
               procedures, rate_value);
    add_on_off(list.findings, "train_time", "train time of a procedure", "s", procedures,
               train_value);
    add_on_off(list.findings, "reaction_time", "median reaction time", "s", procedures,
               reaction_value);
    words.paragraph(
        "Monitor on less monitor off, by participants' means: the three results are not adjusted "
        "for each other.");
  }
  list.blocks = words.blocks;
  return list;
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
    const std::optional<double> median = quantile(reactions_of(some), 0.5);
    lines.push_back(fmt::format(
        "{}: {} nerve events in {} procedures, train time {:.1f} s, median "
        "reaction {} s",
        condition, events, some.size(), trains, median ? fmt::format("{:.2f}", *median) : "–"));
  }
  return lines;
}

}  // namespace haptrial::analysis::drilling
