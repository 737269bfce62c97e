#include "analysis/bone_drilling/report/nerve_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "analysis/bone_drilling/metrics/procedure.h"
#include "core/base/definition/given_in.h"
#include "core/bone/nerve/nerve_rows.h"
#include "core/bone/record/drilling_tables.h"
#include "core/record/read/session_reader.h"
#include "core/record/read/tick_rows.h"

namespace haptrial::analysis::drilling {
namespace {

using Kind = record::NerveEventRow::Kind;

constexpr double kLifted = 0.1;           // without drilling, that ends a stretch of it [s]
constexpr double kTolerance = 0.010;      // between an event and what was planted [s]
constexpr std::uint64_t kAtOnce = 65536;  // rows of /tool

/// The ticks [first, last] of one pass.
struct Stretch {
  std::uint64_t first{0};
  std::uint64_t last{0};
};

class Session {
 public:
  explicit Session(const record::SessionReader& file)
      : file_(file),
        rate_(file.info().rate),
        channels_(file.rows<record::NerveChannelRow>()),
        events_(file.rows<record::NerveEventRow>()),
        thresholds_(file.rows<record::NerveThresholdRow>()),
        discharges_(file.rows<record::NerveDischargeRow>()) {}

  NerveProcedure procedure(int trial, const std::vector<CountedPass>& passes) const;

 private:
  std::vector<bool> drills(const Stretch& pass) const;
  void count(const Stretch& pass, NerveProcedure& p) const;
  void react(const Stretch& pass, NerveProcedure& p) const;
  void hold_against(const Stretch& pass, NerveProcedure& p) const;
  double found_train(const Stretch& pass) const;
  double planted_train(const Stretch& pass) const;
  double threshold_at(std::int32_t channel, std::uint64_t tick) const;
  bool meet(const record::NerveEventRow& event, const record::NerveDischargeRow& planted) const;
  double seconds(std::uint64_t ticks) const { return static_cast<double>(ticks) / rate_; }

  const record::SessionReader& file_;
  double rate_;
  std::vector<record::NerveChannelRow> channels_;
  std::vector<record::NerveEventRow> events_;
  std::vector<record::NerveThresholdRow> thresholds_;
  std::vector<record::NerveDischargeRow> discharges_;
};

/// A field that may hold a comma.
std::string field(const std::string& text) {
  return text.find_first_of(",\"\n") == std::string::npos ? text : fmt::format("\"{}\"", text);
}

bool within(const Stretch& pass, std::uint64_t tick) {
  return tick >= pass.first && tick <= pass.last;
}

std::vector<bool> Session::drills(const Stretch& pass) const {
  std::vector<bool> all(pass.last - pass.first + 1, false);
  for (std::uint64_t first = pass.first; first <= pass.last; first += kAtOnce) {
    const std::uint64_t count = std::min(kAtOnce, pass.last - first + 1);
    for (const auto& row :
         record::rows_of_ticks(file_, record::table_of<record::ToolRow>(), first, count)) {
      all[row.sequence - pass.first] = row.power && row.immersed > 0 && row.mode == 0;
    }
  }
  return all;
}

bool Session::meet(const record::NerveEventRow& event,
                   const record::NerveDischargeRow& planted) const {
  const auto near = static_cast<std::uint64_t>(kTolerance * rate_);
  return (planted.channel < 0 || planted.channel == event.channel) &&
         event.begin <= planted.end + near && event.end + near >= planted.sequence;
}

double Session::threshold_at(std::int32_t channel, std::uint64_t tick) const {
  double threshold = 0.0;
  for (const record::NerveThresholdRow& row : thresholds_) {
    threshold = row.channel == channel && row.sequence <= tick ? row.threshold : threshold;
  }
  return threshold;
}

void Session::count(const Stretch& pass, NerveProcedure& p) const {
  for (const record::NerveEventRow& event : events_) {
    const auto channel = static_cast<std::size_t>(event.channel);
    if (!within(pass, event.begin) || channel >= channels_.size() ||
        event.kind == Kind::kArtefact) {
      continue;
    }
    const auto at = std::find_if(p.nerves.begin(), p.nerves.end(), [&](const NerveCounts& nerve) {
      return nerve.nerve == channels_[channel].nerve;
    });
    if (at == p.nerves.end()) {
      continue;
    }
    at->bursts += event.kind == Kind::kBurst ? 1 : 0;
    at->trains += event.kind == Kind::kTrain ? 1 : 0;
    at->responses += event.kind == Kind::kResponse ? 1 : 0;
    at->train_time += event.train_time;
  }
}

/// Adds the reaction from the first event of a stretch of drilling to its end.
void Session::react(const Stretch& pass, NerveProcedure& p) const {
  const std::vector<bool> works = drills(pass);
  p.drilling += seconds(static_cast<std::uint64_t>(std::count(works.begin(), works.end(), true)));
  const auto lifted = static_cast<std::uint64_t>(kLifted * rate_);
  std::vector<std::uint64_t> begins;
  for (const record::NerveEventRow& event : events_) {
    const bool counts = event.kind == Kind::kBurst || event.kind == Kind::kTrain;
    if (counts && within(pass, event.begin)) {
      begins.push_back(event.begin - pass.first);
    }
  }
  std::sort(begins.begin(), begins.end());
  std::uint64_t free_from = 0;
  for (const std::uint64_t begin : begins) {
    if (begin < free_from || begin >= works.size() || !works[begin]) {
      continue;
    }
    std::uint64_t last = begin;  // tick of drilling
    std::uint64_t at = begin;
    while (at < works.size() && at - last <= lifted) {
      last = works[at] ? at : last;
      ++at;
    }
    NerveReaction reaction{p.duration + seconds(begin), std::nullopt};
    if (at - last > lifted) {
      reaction.lift_off = seconds(last + 1 - begin);
    }
    p.reactions.push_back(reaction);
    free_from = at;
  }
}

double Session::found_train(const Stretch& pass) const {
  double sum = 0.0;
  for (const record::NerveEventRow& event : events_) {
    sum += within(pass, event.begin) && event.kind != Kind::kArtefact ? event.train_time : 0.0;
  }
  return sum;
}

/// Trains that overlap in one channel are one.
double Session::planted_train(const Stretch& pass) const {
  std::map<std::int32_t, std::uint64_t> until;  // by channel
  std::uint64_t sum = 0;
  for (const record::NerveDischargeRow& row : discharges_) {
    if (row.kind == Kind::kTrain && within(pass, row.sequence)) {
      std::uint64_t& end = until[row.channel];
      const std::uint64_t begin = std::max(row.sequence, end);
      sum += row.end > begin ? row.end - begin : 0;
      end = std::max(end, row.end);
    }
  }
  return seconds(sum);
}

void Session::hold_against(const Stretch& pass, NerveProcedure& p) const {
  NerveDetection d;
  d.hours = seconds(pass.last + 1 - pass.first) / 3600.0;
  d.found_train = found_train(pass);
  d.planted_train = planted_train(pass);
  const auto taken = [&](const record::NerveDischargeRow& planted) {
    return std::any_of(events_.begin(), events_.end(), [&](const record::NerveEventRow& event) {
      return event.kind != Kind::kArtefact && meet(event, planted);
    });
  };
  const auto is_of = [&](const record::NerveEventRow& event, bool artefacts) {
    return std::any_of(discharges_.begin(), discharges_.end(),
                       [&](const record::NerveDischargeRow& row) {
                         return (row.kind == Kind::kArtefact) == artefacts && meet(event, row);
                       });
  };
  for (const record::NerveDischargeRow& row : discharges_) {
    if (!within(pass, row.sequence) || row.kind == Kind::kArtefact) {
      d.artefacts += within(pass, row.sequence) ? 1 : 0;
      continue;
    }
    const bool found = taken(row);
    const bool above = row.amplitude > threshold_at(row.channel, row.sequence);
    ++d.planted;
    d.found += found ? 1 : 0;
    d.above += above ? 1 : 0;
    d.above_found += above && found ? 1 : 0;
  }
  for (const record::NerveEventRow& event : events_) {
    if (within(pass, event.begin) && event.kind != Kind::kArtefact && !is_of(event, false)) {
      ++d.false_alarms;
      d.artefacts_passed += is_of(event, true) ? 1 : 0;
    }
  }
  p.detection.add(d);
}

NerveProcedure Session::procedure(int trial, const std::vector<CountedPass>& passes) const {
  NerveProcedure p;
  p.session = file_.path().filename().string();
  p.participant = file_.info().subject;
  p.number = trial;
  p.simulated = file_.info().simulated;
  p.condition = passes.back().pass.condition;
  for (const record::NerveChannelRow& channel : channels_) {
    if (p.nerves.empty() || p.nerves.back().nerve != channel.nerve) {
      p.nerves.push_back({channel.nerve});
    }
  }
  for (const CountedPass& each : passes) {
    const Stretch pass{each.pass.first_sample, each.pass.last_sample};
    if (pass.last < pass.first) {
      continue;
    }
    count(pass, p);
    react(pass, p);
    hold_against(pass, p);
    p.duration += seconds(pass.last + 1 - pass.first);
  }
  return p;
}

}  // namespace

void NerveDetection::add(const NerveDetection& other) {
  planted += other.planted;
  found += other.found;
  above += other.above;
  above_found += other.above_found;
  artefacts += other.artefacts;
  artefacts_passed += other.artefacts_passed;
  false_alarms += other.false_alarms;
  planted_train += other.planted_train;
  found_train += other.found_train;
  hours += other.hours;
}

int NerveProcedure::events() const {
  int sum = 0;
  for (const NerveCounts& nerve : nerves) {
    sum += nerve.events();
  }
  return sum;
}

double NerveProcedure::train_time() const {
  double sum = 0.0;
  for (const NerveCounts& nerve : nerves) {
    sum += nerve.train_time;
  }
  return sum;
}

std::optional<double> NerveProcedure::reaction() const {
  std::vector<double> times;
  for (const NerveReaction& reaction : reactions) {
    if (reaction.lift_off) {
      times.push_back(*reaction.lift_off);
    }
  }
  if (times.empty()) {
    return std::nullopt;
  }
  std::sort(times.begin(), times.end());
  const std::size_t middle = times.size() / 2;
  return times.size() % 2 == 1 ? times[middle] : 0.5 * (times[middle - 1] + times[middle]);
}

std::vector<NerveProcedure> load_nerves(const record::SessionReader& file,
                                        const std::string& group) {
  if (!file.has(record::table_of<record::NerveEventRow>())) {
    return {};
  }
  const Session session(file);
  std::vector<NerveProcedure> procedures;
  for (const auto& [trial, passes] : counted_passes(file)) {
    procedures.push_back(session.procedure(trial, passes));
    procedures.back().group = group;
    procedures.back().given = !says_off(procedures.back().condition, "monitor");
  }
  return procedures;
}

std::string nerves_csv(const std::vector<NerveProcedure>& procedures) {
  std::string text =
      "session,participant,group,procedure,simulated,condition,duration_s,drilling_s,nerve,bursts,"
      "trains,responses,train_time_s,reaction_s\n";
  for (const NerveProcedure& p : procedures) {
    const std::optional<double> reaction = p.reaction();
    for (const NerveCounts& nerve : p.nerves) {
      text += fmt::format("{},{},{},{},{},{},{:.3f},{:.3f},{},{},{},{},{:.3f},{}\n",
                          field(p.session), field(p.participant), field(p.group), p.number,
                          p.simulated ? 1 : 0, field(p.condition), p.duration, p.drilling,
                          field(nerve.nerve), nerve.bursts, nerve.trains, nerve.responses,
                          nerve.train_time, reaction ? fmt::format("{:.3f}", *reaction) : "");
    }
  }
  return text;
}

}  // namespace haptrial::analysis::drilling
