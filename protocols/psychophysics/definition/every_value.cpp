#include "protocols/psychophysics/definition/every_value.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/exception_words.h"
#include "core/scene/scene.h"
#include "protocols/psychophysics/definition/lead_words.h"
#include "protocols/psychophysics/definition/picture_words.h"
#include "protocols/psychophysics/definition/presented.h"
#include "protocols/psychophysics/definition/read_definition.h"
#include "protocols/psychophysics/definition/trial_values.h"
#include "protocols/psychophysics/objects/deformable_bodies.h"
#include "protocols/psychophysics/objects/rigid_objects.h"

namespace haptrial::protocols {
namespace {

constexpr std::size_t kMostCombinations = 256;
constexpr double kLeastObject = 0.0005, kLargestObject = 2.0;  // the diagonal of its box [m]

std::string words_of(const TrialsDefinition& d, const TrialValues& values) {
  std::string words = fmt::format("block {}", d.order.blocks[values.block].name);
  for (const auto& [name, level] : values.levels) {
    words += fmt::format(", {} = {:g}", name, level);
  }
  for (const GivenValue& value : values.values) {
    words += fmt::format(", {} = {}", value.name, value.formula);
  }
  return words;
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

/// A mesh in millimetres that is taken for one in metres is as large as a house.
void check_objects(const TrialsDefinition& d, const std::vector<scene::Field>& fields) {
  for (const scene::Field& field : fields) {
    const auto* solid = std::get_if<scene::RigidObjectParameters>(&field.kind);
    const double size = solid != nullptr && solid->body ? solid->scale * solid->body->size : 0.0;
    if (size > 0.0 && !(size >= kLeastObject && size <= kLargestObject)) {
      throw InputError(fmt::format(
          "{}: objects.{} is {:.3g} m large; allowed: {:g} to {:g} [m]; scale = 0.001 takes a mesh "
          "in millimetres",
          d.file_name, field.name, size, kLeastObject, kLargestObject));
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
    combinations = std::min(kMostCombinations, combinations * values_of(question).size());
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

/// @param first  bodies that give way are checked, and rigid ones described
/// @returns words about rigid bodies
std::vector<std::string> present_once(const TrialsDefinition& d, const TrialValues& values,
                                      bool first, HandleReport& handle, PictureReport& picture,
                                      LeadReport& lead) {
  std::vector<std::string> bodies;
  Table root = d.root();
  const std::unique_ptr<Names> names = read_names(root, d);
  try {
    for (std::size_t place = 0; place < d.intervals.size(); ++place) {
      give(*names, d, values);
      give_interval(*names, d.intervals[values.intervals[place]], place);
      Presented presented = read_presented(root, *names, d, nullptr);
      root.check();
      scene::Scene(presented.fields, d.rate);
      check_forces(d, presented);
      check_objects(d, presented.fields);
      check_reach(d, presented);
      handle.add(presented);
      picture.add(presented);
      lead.add(presented);
      prepare_moving_bodies(presented.fields, d.rate);
      if (first && place == 0) {
        check_bodies(presented.fields);
        bodies = words_of_rigid_objects(presented.fields, d.rate, d.hand.damping);
      }
    }
    give(*names, d, values);
    for (const TrialQuestion& question : d.questions) {
      if (!question.correct.empty()) {
        right_choice(*names, question);
      }
    }
    check_answers(d, values, *names);
  } catch (const std::exception& error) {
    const std::string said = sentence_of(error);
    throw InputError(fmt::format("{}{}\n(with {})",
                                 said.starts_with(d.file_name) ? "" : d.file_name + ": ", said,
                                 words_of(d, values)));
  }
  return bodies;
}

/// Whether a trial of a block cannot be presented without what a track of another one found.
bool needs_threshold(const TrialsDefinition& d, TrialValues values, const Track& track) {
  std::erase_if(values.thresholds, [&](const auto& each) { return each.first == track.name; });
  HandleReport handle(d);
  PictureReport picture(d);
  LeadReport lead(d);
  try {
    present_once(d, values, false, handle, picture, lead);
  } catch (const InputError&) {
    return true;
  }
  return false;
}

/// Blocks of a session that come before one in every order.
std::vector<std::size_t> blocks_before(const TrialDesign& order, std::size_t block, int session) {
  std::vector<std::size_t> before;
  for (const std::size_t each : order.blocks_of(session)) {
    const bool practice_first = order.blocks[each].practice && !order.blocks[block].practice;
    if (practice_first || (order.order == Counterbalancing::kFixed && each < block)) {
      before.push_back(each);
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

/// The tracks of other blocks whose thresholds the block needs.
std::vector<std::string> needs_of(const TrialsDefinition& d, std::size_t block,
                                  const TrialValues& values) {
  std::vector<std::string> needs;
  for (const auto& [name, level] : values.thresholds) {
    const Track& track = *std::ranges::find(d.tracks, name, &Track::name);
    const bool named =
        has_threshold_name(track) && d.text.find('$' + threshold_name(name)) != std::string::npos;
    if (named && needs_threshold(d, values, track)) {
      check_found_before(d, block, track);
      needs.push_back(name);
    }
  }
  return needs;
}

/// The values of one combination of a block's factors. @param high  levels at the upper ends of
/// their ranges, else at the lower ones
TrialValues corner_of(const TrialsDefinition& d, std::size_t block, std::size_t combination,
                      bool high) {
  TrialValues values;
  values.block = block;
  values.group = d.groups.empty() ? "" : d.groups.front().name;
  for (std::size_t i = 0; i < d.intervals.size(); ++i) {
    values.intervals.push_back(i);
  }
  give_corners(d, high, values);
  const Block& given = d.order.blocks[block];
  for (const Factor* factor : d.varied_in(given)) {
    const std::size_t levels = factor->levels.size();
    values.values.push_back({factor->name, factor->levels[combination % levels]});
    combination /= levels;
  }
  values.values.insert(values.values.end(), given.values.begin(), given.values.end());
  return values;
}

}  // namespace

std::vector<std::string> costs_of_bodies(const TrialsDefinition& d) {
  if (d.objects.empty()) {
    return {};
  }
  Table root = d.root();
  const std::unique_ptr<Names> names = read_names(root, d);
  give(*names, d, corner_of(d, 0, 0, false));
  give_interval(*names, d.intervals.front(), 0);
  Presented presented = read_presented(root, *names, d, nullptr);
  root.check();
  prepare_bodies(presented.fields, d.rate);
  return words_of_bodies(presented.fields, d.rate, d.hand.damping);
}

HandleText check_every_value(TrialsDefinition& d) {
  std::vector<std::string> bodies;
  HandleReport handle(d);
  PictureReport picture(d);
  LeadReport lead(d);
  for (std::size_t block = 0; block < d.order.blocks.size(); ++block) {
    const std::vector<const Factor*> varied = d.varied_in(d.order.blocks[block]);
    std::size_t combinations = 1;
    for (const Factor* factor : varied) {
      combinations = std::min(kMostCombinations, combinations * factor->levels.size());
    }
    for (std::size_t c = 0; c < combinations; ++c) {
      for (const bool high : {false, true}) {
        const TrialValues values = corner_of(d, block, c, high);
        if (c == 0 && !high) {
          d.order.blocks[block].needs = needs_of(d, block, values);
        }
        const bool first = block == 0 && c == 0 && !high;
        const std::vector<std::string> said = present_once(d, values, first, handle, picture, lead);
        bodies.insert(bodies.end(), said.begin(), said.end());
      }
    }
  }
  HandleText words = handle.words();
  for (const auto& said : {picture.warnings(), lead.warnings()}) {
    words.warnings.insert(words.warnings.end(), said.begin(), said.end());
  }
  words.lines.insert(words.lines.begin(), bodies.begin(), bodies.end());
  return words;
}

}  // namespace haptrial::protocols
