#include "protocols/psychophysics/definition/every_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/exception_words.h"
#include "core/scene/scene.h"
#include "protocols/psychophysics/definition/beginning_words.h"
#include "protocols/psychophysics/definition/presented.h"
#include "protocols/psychophysics/definition/read_definition.h"
#include "protocols/psychophysics/definition/stage_warnings.h"
#include "protocols/psychophysics/definition/trial_values.h"
#include "protocols/psychophysics/objects/deformable_bodies.h"
#include "protocols/psychophysics/objects/object_files.h"

namespace haptrial::protocols {
namespace {

constexpr std::size_t kMostAnswers = 256;                      // combinations of answers
constexpr std::size_t kMostValues = 4096;                      // combinations of values of a block
constexpr double kLeastObject = 0.0005, kLargestObject = 2.0;  // the diagonal of its box [m]

std::string words_of(const TrialsDefinition& d, const TrialValues& values) {
  std::string words = fmt::format("block {}", d.order.blocks[values.block].name);
  for (const auto& [name, level] : values.levels) {
    words += fmt::format(", {} = {:g}", name, level);
  }
  for (const GivenValue& value : values.values) {
    words += fmt::format(", {} = {}", value.name, value.formula);
  }
  if (d.groups.size() > 1) {
    words += fmt::format(", group {}", values.group);
  }
  const auto add = [&words](const char* name, int number) {
    words += number > 1 ? fmt::format(", {} {}", name, number) : "";
  };
  add("session", values.session);
  add("participant", values.participant);
  add("trial", values.trial);
  return words + (values.probe.empty() ? "" : fmt::format(", with the probe {}", values.probe));
}

/// The key that bounds an arm.
std::string key_of(const DeviceArm& arm, const char* key) {
  return arm.part == device::Part::kTip ? fmt::format("envelope.{}", key)
                                        : fmt::format("devices.{}.{}", arm.name, key);
}

/// A force that is cut off is not the level that is recorded.
void check_force(const TrialsDefinition& d, const scene::Field& field, const DeviceArm& arm) {
  const device::PartUnits unit = arm.units();
  const double force = scene::traits_of(field).asked_force;
  const double most = std::min(field.limit, arm.limits.max_force);
  if (force > most) {
    throw InputError(
        fmt::format("{}: fields.{} asks for {:g} {}; allowed: at most {:g} [{}], {}", d.file_name,
                    field.name, unit.newton * force, unit.force, unit.newton * most, unit.force,
                    field.limit < arm.limits.max_force ? "its limit" : key_of(arm, "max_force")));
  }
}

void check_forces(const TrialsDefinition& d, const Presented& presented) {
  const std::vector<DeviceArm> arms = d.arms();
  for (std::size_t field = 0; field < presented.fields.size(); ++field) {
    for (std::size_t device = 0; device < arms.size(); ++device) {
      if ((presented.felt[device] >> field & 1U) != 0) {
        check_force(d, presented.fields[field], arms[device]);
      }
    }
  }
}

/// A stage that waits in a region out of reach is aborted for ever.
void check_reach(const TrialsDefinition& d, const Presented& presented) {
  const std::vector<DeviceArm> arms = d.arms();
  for (const NamedStage& stage : presented.stages) {
    for (std::size_t i = 0; i < presented.regions.size(); ++i) {
      const scene::Region& region = presented.regions[i];
      const bool waits = (stage.stage.until.inside >> i & 1U) != 0;
      const double away =
          scene::PlacedShape(region.shape).distance(Eigen::Vector3d::Zero()).distance;
      const DeviceArm& arm = arms[presented.region_devices[i]];
      if (waits && away > arm.limits.workspace_radius) {
        const device::PartUnits unit = arm.units();
        throw InputError(fmt::format(
            "{}: stage {} waits until the tool is inside regions.{}, which is {:.3g} {} from the "
            "origin; allowed: at most {}, {:g} [{}]",
            d.file_name, stage.name, region.name, unit.metre * away, unit.place,
            key_of(arm, "workspace_radius"), unit.metre * arm.limits.workspace_radius, unit.place));
      }
    }
  }
}

/// The diagonal of an object's box [m]; 0: the field is no object, or its mesh is not known.
double object_size(const scene::Field& field) {
  if (const auto* solid = std::get_if<scene::RigidObjectParameters>(&field.kind)) {
    return solid->body ? solid->scale * solid->body->size : 0.0;
  }
  const auto* soft = std::get_if<scene::DeformableObjectParameters>(&field.kind);
  return soft != nullptr && soft->mesh ? soft->mesh->box.diagonal().norm() : 0.0;
}

/// A mesh in millimetres that is taken for one in metres is as large as a house.
void check_objects(const TrialsDefinition& d, const std::vector<scene::Field>& fields) {
  for (const scene::Field& field : fields) {
    const double size = object_size(field);
    if (size > 0.0 && !(size >= kLeastObject && size <= kLargestObject)) {
      const bool soft = std::holds_alternative<scene::DeformableObjectParameters>(field.kind);
      throw InputError(fmt::format(
          "{}: objects.{} is {:.3g} m large; allowed: {:g} to {:g} [m]; {} a mesh in millimetres",
          d.file_name, field.name, size, kLeastObject, kLargestObject,
          soft ? "`haptrial mesh repair --scale 0.001` converts" : "scale = 0.001 takes"));
    }
  }
}

/// The numbers that formulas may take an answer for: each choice, or the ends of a typed one.
std::vector<double> values_of(const TrialQuestion& question) {
  if (!question.has_choices()) {
    return {question.low, question.high};
  }
  std::vector<double> values;
  for (std::size_t i = 0; i < question.choices.size(); ++i) {
    values.push_back(question.first + static_cast<double>(i));
  }
  return values;
}

/// @throws InputError for an answer from which the procedure of a track cannot learn
void check_lesson(const TrialsDefinition& d, const Track& track, double outcome,
                  const std::string& answers) {
  if (std::isfinite(outcome) && !track.learns(outcome)) {
    throw InputError(
        fmt::format("{}: {} learns {:g} from the answer {}; allowed: {}; say what it "
                    "learns with `counts`",
                    d.file_name, track.name, outcome, answers, track.lesson()));
  }
}

/// Every answer must be one from which the procedures can learn, or a session ends at the first
/// other one. @param names  with the values of a trial
void check_answers(const TrialsDefinition& d, const TrialValues& values, Names& names) {
  if (values.levels.empty()) {
    return;  // the block asks no procedure
  }
  std::size_t combinations = 1;
  for (const TrialQuestion& question : d.questions) {
    combinations = std::min(kMostAnswers, combinations * values_of(question).size());
  }
  for (std::size_t c = 0; c < combinations; ++c) {
    std::string answers;
    std::size_t rest = c;
    for (const TrialQuestion& question : d.questions) {
      const std::vector<double> all = values_of(question);
      const double value = all[rest % all.size()];
      rest /= all.size();
      if (!question.is_number()) {
        continue;
      }
      names.set(question.name, value);
      answers += fmt::format("{}{} = {:g}", answers.empty() ? "" : ", ", question.name, value);
    }
    for (const Measure& measure : d.measures) {
      names.set(measure.name, 1.0);  // what a hand will produce is not known
    }
    for (const Track& track : d.tracks) {
      if (!track.counts.empty()) {
        check_lesson(d, track, names.value(track.counts), answers);
      } else if (c == 0 && !d.questions.empty() && !d.questions.front().correct.empty()) {
        check_lesson(d, track, 0.0, "that is wrong");
      }
    }
  }
}

/// The channel to which a value belongs. @param place  of the value among all
const channel::ChannelOptions& channel_of(const TrialsDefinition& d, std::size_t place) {
  auto channel = d.channels.begin();
  while (place >= channel->plan.quantities.size()) {
    place -= channel->plan.quantities.size();
    ++channel;
  }
  return *channel;
}

/// The longest time for which the sine in a channel's place is above a bound [s]
double time_above(const channel::SimulatedInput& sine, double bound) {
  const double above_mean = bound - sine.mean;
  if (!(std::abs(above_mean) < sine.amplitude)) {
    return above_mean < 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
  }
  return std::acos(above_mean / sine.amplitude) / (std::numbers::pi * sine.frequency);
}

/// Adds a sentence on each stage that ends a trial of a dry run, since it waits for a value that
/// the sine in the channel's place never has.
/// @param sentences  each with the words of the first values with which it holds
void note_unreached(const TrialsDefinition& d, const Presented& presented,
                    const TrialValues& values, std::map<std::string, std::string>& sentences) {
  for (const NamedStage& stage : presented.stages) {
    const Until& until = stage.stage.until;
    if (!until.channel || stage.stage.late == Consequence::kGoOn) {
      continue;
    }
    const channel::ChannelOptions& channel = channel_of(d, *until.channel);
    const channel::SimulatedInput& sine = channel.simulated;
    const double longest =
        std::min(time_above(sine, until.above), time_above(sine, 2.0 * sine.mean - until.below));
    if (longest <= 0.0 || longest < until.hold) {
      sentences.emplace(
          fmt::format("stage {} waits for a value of channel {} that a dry run never has{}: it "
                      "goes from {:g} to {:g} there (channels.{}.simulated), so that no trial with "
                      "such a stage gets on",
                      stage.name, channel.name,
                      until.hold > 0.0 ? fmt::format(" for {:g} s", until.hold) : "",
                      sine.mean - sine.amplitude, sine.mean + sine.amplitude, channel.name),
          words_of(d, values));
    }
  }
}

/// Goes through the values that the trials of a definition may have.
class EveryValue {
 public:
  explicit EveryValue(TrialsDefinition& definition)
      : d_(definition),
        handle_(definition),
        picture_(definition),
        lead_(definition),
        ramp_(definition) {}

  HandleText check();

 private:
  /// Something that differs between the trials of a block, and sets its part of their values.
  struct Dimension {
    std::size_t size;
    std::function<void(std::size_t, TrialValues&)> set;
  };

  void check_block(std::size_t block);
  void present(const TrialValues& values);
  void present_interval(Table& root, Names& names, const TrialValues& values, std::size_t place);
  std::pair<std::size_t, double> visit(std::size_t block, const std::vector<Dimension>& dimensions,
                                       const std::function<void(const TrialValues&)>& look) const;
  std::vector<Dimension> levels_of(std::size_t block) const;
  std::vector<Dimension> places_of(std::size_t block) const;
  bool needs(const std::string& track, std::size_t block, const std::vector<Dimension>& dimensions);

  TrialsDefinition& d_;
  HandleReport handle_;
  PictureReport picture_;
  LeadReport lead_;
  RampReport ramp_;
  bool first_{true};                 // nothing was presented yet
  std::vector<std::string> bodies_;  // words about rigid ones
  std::vector<std::string> cut_;     // sentences on blocks that have too many combinations
  std::map<std::string, std::string> unreached_;  // on stages that wait for a channel in vain
  std::set<std::string> read_;                    // names that the block's values depend on
};

constexpr const char* kPlaces[] = {"group", "session", "participant", "trial"};

void EveryValue::present_interval(Table& root, Names& names, const TrialValues& values,
                                  std::size_t place) {
  Presented presented = read_presented(root, names, d_, nullptr);
  root.check();
  scene::Scene(presented.fields, d_.rate);
  check_forces(d_, presented);
  check_objects(d_, presented.fields);
  check_reach(d_, presented);
  handle_.add(presented);
  picture_.add(presented);
  lead_.add(presented);
  ramp_.add(presented);
  note_unreached(d_, presented, values, unreached_);
  prepare_moving_bodies(presented.fields, d_.rate);
  if (std::exchange(first_, false) && place == 0) {
    check_bodies(presented.fields);
    bodies_ = words_of_rigid_objects(presented.fields, d_.rate, d_.hand.damping);
  }
}

void EveryValue::present(const TrialValues& values) {
  Table root = d_.root();
  const std::unique_ptr<Names> names = read_names(root, d_);
  try {
    for (std::size_t place = 0; place < d_.intervals.size(); ++place) {
      give(*names, d_, values);
      give_interval(*names, d_.intervals[values.intervals[place]], place);
      present_interval(root, *names, values, place);
    }
    give(*names, d_, values);
    for (const TrialQuestion& question : d_.questions) {
      if (!question.correct.empty()) {
        right_choice(*names, question);
      }
    }
    check_answers(d_, values, *names);
  } catch (const std::exception& error) {
    const std::string said = sentence_of(error);
    const bool says_where = said.find(d_.file_name + ":") != std::string::npos;
    throw InputError(fmt::format("{}{}\n(with {})", says_where ? "" : d_.file_name + ": ", said,
                                 words_of(d_, values)));
  }
  for (const char* place : kPlaces) {
    if (names->was_read(place)) {
      read_.insert(place);
    }
  }
  for (const auto& [track, level] : values.thresholds) {
    if (names->was_read(threshold_name(track))) {
      read_.insert(threshold_name(track));
    }
  }
}

/// Blocks of a session that come before one in every order.
std::vector<std::size_t> blocks_before(const TrialDesign& order, std::size_t block, int session) {
  const std::vector<std::size_t> all = order.blocks_of(session);
  const auto own = std::ranges::find(all, block);
  std::vector<std::size_t> before;
  for (auto each = all.begin(); each != all.end(); ++each) {
    const bool practice = order.blocks[*each].practice;
    const bool practice_first = practice && !order.blocks[block].practice;
    const bool listed_first = each < own && practice == order.blocks[block].practice;
    if (practice_first || (order.order == Counterbalancing::kFixed && listed_first)) {
      before.push_back(*each);
    }
  }
  return before;
}

/// @throws InputError if a session presents the block without one before it that asks the track
void check_found_before(const TrialsDefinition& d, std::size_t block, const Track& track) {
  for (int session = 1; session <= d.order.sessions; ++session) {
    const std::vector<std::size_t> presented = d.order.blocks_of(session);
    const std::vector<std::size_t> before = blocks_before(d.order, block, session);
    const bool found = std::ranges::any_of(before, [&](std::size_t each) {
      const std::vector<const Track*> asked = d.tracks_in(d.order.blocks[each]);
      return std::ranges::find(asked, &track) != asked.end();
    });
    if (std::ranges::find(presented, block) != presented.end() && !found) {
      throw InputError(fmt::format(
          "{}: block {} uses ${}, but in {} no block before it asks that procedure{}; put "
          "one before it, or state \"{}\" in [variables]",
          d.file_name, d.order.blocks[block].name, threshold_name(track.name),
          d.order.sessions > 1 ? fmt::format("session {}", session) : "the session",
          d.order.order == Counterbalancing::kFixed ? "" : " in every order of the blocks",
          threshold_name(track.name)));
    }
  }
}

TrialValues first_values(const TrialsDefinition& d, std::size_t block) {
  TrialValues values;
  values.block = block;
  values.values = d.order.blocks[block].values;
  values.group = d.groups.empty() ? "" : d.groups.front().name;
  for (std::size_t i = 0; i < d.intervals.size(); ++i) {
    values.intervals.push_back(i);
  }
  return values;
}

/// The ends of the tracks' ranges, the block's factors and its probe.
std::vector<EveryValue::Dimension> EveryValue::levels_of(std::size_t block) const {
  const Block& given = d_.order.blocks[block];
  std::vector<Dimension> all;
  all.push_back({2, [this](std::size_t end, TrialValues& v) { give_corners(d_, end == 1, v); }});
  for (const Factor* factor : d_.varied_in(given)) {
    all.push_back({factor->levels.size(), [factor](std::size_t level, TrialValues& v) {
                     v.values.push_back({factor->name, factor->levels[level]});
                   }});
  }
  if (given.probe) {
    all.push_back({2, [&probe = *given.probe](std::size_t with, TrialValues& v) {
                     if (with == 1) {  // what it gives stands before all else
                       v.probe = probe.name;
                       v.values.insert(v.values.end(), probe.values.begin(), probe.values.end());
                     }
                   }});
  }
  return all;
}

/// The participants and times on which the block's values depend.
std::vector<EveryValue::Dimension> EveryValue::places_of(std::size_t block) const {
  std::vector<Dimension> all;
  if (read_.contains("participant")) {
    all.push_back(
        {static_cast<std::size_t>(d_.order.participants), [this](std::size_t i, TrialValues& v) {
           v.participant = static_cast<int>(i) + 1;
           if (d_.groups.size() > 1) {  // else it is everybody's
             v.group = group_of(d_.groups, static_cast<int>(i));
           }
         }});
  } else if (read_.contains("group")) {
    all.push_back(
        {d_.groups.size(), [this](std::size_t i, TrialValues& v) { v.group = d_.groups[i].name; }});
  }
  if (read_.contains("session")) {
    std::vector<int> sessions;
    for (int session = 1; session <= d_.order.sessions; ++session) {
      const std::vector<std::size_t> blocks = d_.order.blocks_of(session);
      if (std::ranges::find(blocks, block) != blocks.end()) {
        sessions.push_back(session);
      }
    }
    all.push_back(
        {sessions.size(), [sessions](std::size_t i, TrialValues& v) { v.session = sessions[i]; }});
  }
  if (read_.contains("trial")) {
    const int most = d_.order.blocks[block].practice ? d_.practice_trials() : d_.most_trials();
    all.push_back({static_cast<std::size_t>(std::max(1, most)),
                   [](std::size_t i, TrialValues& v) { v.trial = static_cast<int>(i) + 1; }});
  }
  return all;
}

/// Visits every combination. Where there are more than kMostValues, it visits only so many that
/// each value comes once at least.
/// @returns how many were visited, and how many there are
std::pair<std::size_t, double> EveryValue::visit(
    std::size_t block, const std::vector<Dimension>& dimensions,
    const std::function<void(const TrialValues&)>& look) const {
  double all = 1.0;
  std::size_t largest = kMostValues;
  for (const Dimension& dimension : dimensions) {
    all *= static_cast<double>(dimension.size);
    largest = std::max(largest, dimension.size);
  }
  const bool cut = all > static_cast<double>(kMostValues);
  const std::size_t count = cut ? largest : static_cast<std::size_t>(all);
  for (std::size_t c = 0; c < count; ++c) {
    TrialValues values = first_values(d_, block);
    std::size_t rest = c;
    for (const Dimension& dimension : dimensions) {
      dimension.set((cut ? c : rest) % dimension.size, values);
      rest /= dimension.size;
    }
    look(values);
  }
  return {count, all};
}

/// Whether a trial of the block cannot be presented without what a track of another one found.
bool EveryValue::needs(const std::string& track, std::size_t block,
                       const std::vector<Dimension>& dimensions) {
  bool needed = false;
  EveryValue other(d_);
  visit(block, dimensions, [&](const TrialValues& values) {
    if (needed) {
      return;
    }
    TrialValues without = values;
    std::erase_if(without.thresholds, [&](const auto& each) { return each.first == track; });
    try {
      other.present(without);
    } catch (const InputError&) {
      needed = true;
    }
  });
  return needed;
}

void EveryValue::check_block(std::size_t block) {
  read_.clear();
  Block& own = d_.order.blocks[block];
  own.needs.clear();
  std::vector<Dimension> all = levels_of(block);
  const auto present_all = [&] {
    return visit(block, all, [this](const TrialValues& values) { present(values); });
  };
  auto [tried, there_are] = present_all();
  if (const std::vector<Dimension> places = places_of(block); !places.empty()) {
    all.insert(all.end(), places.begin(), places.end());
    std::tie(tried, there_are) = present_all();
  }
  if (static_cast<double>(tried) < there_are) {
    cut_.push_back(fmt::format(
        "block {} has {:.0f} combinations of values, of which {} were checked, each value in some",
        own.name, there_are, tried));
  }
  for (const Track& track : d_.tracks) {
    if (read_.contains(threshold_name(track.name)) && needs(track.name, block, all)) {
      check_found_before(d_, block, track);
      own.needs.push_back(track.name);
    }
  }
}

HandleText EveryValue::check() {
  for (std::size_t block = 0; block < d_.order.blocks.size(); ++block) {
    check_block(block);
  }
  HandleText words = handle_.words();
  for (const auto& said : {picture_.warnings(), lead_.warnings(), ramp_.warnings(), cut_}) {
    words.warnings.insert(words.warnings.end(), said.begin(), said.end());
  }
  for (const auto& [sentence, values] : unreached_) {
    words.warnings.push_back(fmt::format("{} (first with {})", sentence, values));
  }
  words.lines.insert(words.lines.begin(), bodies_.begin(), bodies_.end());
  return words;
}

/// Bodies at rest that may begin where the hand is; those that move are not felt from inside.
std::vector<std::string> beginnings_of_bodies(const TrialsDefinition& d, Presented presented) {
  std::uint64_t resting = 0;
  for (std::size_t i = 0; i < presented.fields.size(); ++i) {
    const auto* body = std::get_if<scene::DeformableObjectParameters>(&presented.fields[i].kind);
    resting |= std::uint64_t{body != nullptr && !body->moves()} << i;
  }
  for (NamedStage& stage : presented.stages) {
    stage.stage.fields &= resting;
  }
  BeginningReport report(d);
  report.add(presented);
  return report.lines();
}

}  // namespace

std::vector<std::string> costs_of_bodies(const TrialsDefinition& d) {
  if (d.objects.empty()) {
    return {};
  }
  Table root = d.root();
  const std::unique_ptr<Names> names = read_names(root, d);
  TrialValues values = first_values(d, 0);
  give_corners(d, false, values);
  for (const Factor* factor : d.varied_in(d.order.blocks.front())) {
    values.values.push_back({factor->name, factor->levels.front()});
  }
  give(*names, d, values);
  give_interval(*names, d.intervals.front(), 0);
  Presented presented = read_presented(root, *names, d, nullptr);
  root.check();
  prepare_bodies(presented.fields, d.rate);
  std::vector<std::string> words = words_of_bodies(presented.fields, d.rate, d.hand.damping);
  for (const std::string& line : beginnings_of_bodies(d, presented)) {
    words.push_back(line);
  }
  return words;
}

HandleText check_every_value(TrialsDefinition& d) { return EveryValue(d).check(); }

}  // namespace haptrial::protocols
