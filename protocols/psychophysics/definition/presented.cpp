#include "protocols/psychophysics/definition/presented.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "core/base/definition/table.h"
#include "core/scene/read/read_deformable.h"
#include "core/scene/read/read_field.h"
#include "core/scene/read/read_rigid.h"
#include "core/sound/read_cues.h"
#include "protocols/definition/window_keys.h"
#include "protocols/psychophysics/definition/trial_devices.h"

namespace haptrial::protocols {
namespace {

std::vector<scene::Field> read_felt_objects(Table& table, const TrialsDefinition& d) {
  std::vector<scene::Field> objects;
  for (const std::string& name : table.keys()) {
    const auto object = std::ranges::find(d.objects, name, &TrialObject::name);
    Table own = table.table(name);
    const bool known = object != d.objects.end();
    if (known && object->moves && d.devices() > 1 && !own.has("device")) {
      own.reject("device", "is missing; name the device whose tool feels the body of springs");
    }
    objects.push_back(known && object->yields
                          ? scene::read_deformable(own, name, object->felt, object->constants)
                          : scene::read_rigid(own, name, known ? object->body : nullptr));
  }
  return objects;
}

/// A rotation or grip is nowhere that an object could be.
void refuse_parts(Table& objects, const TrialsDefinition& d, const DeviceOf& devices) {
  for (const auto& [name, device] : devices) {
    if (!d.hands.empty() && !d.hands[device].is_tip()) {
      objects.table(name).reject("device", fmt::format("\"{}\"", d.hands[device].name),
                                 "a device itself, not its rotation or grip");
    }
  }
}

/// A fade of a few ticks is a step, which none at all is not: the envelope lets the change fade then.
void leave_out_short_fades(std::vector<scene::Field>& fields) {
  constexpr double kShortest = 0.01;  // [s]
  for (scene::Field& field : fields) {
    for (double* fade : {&field.fade_in, &field.fade_out}) {
      *fade = *fade < kShortest ? 0.0 : *fade;
    }
  }
}

/// Fields, and behind them the objects, which are felt as fields.
void read_what_is_felt(Table& root, const TrialsDefinition& d, Presented& presented) {
  DeviceOf devices;
  std::vector<scene::Field> objects;
  if (root.has("objects")) {
    Table table = root.table("objects");
    devices = devices_of(table, d.hands, "Device whose tool feels the object", "every device");
    refuse_parts(table, d, devices);
    objects = read_felt_objects(table, d);
  }
  if (root.has("fields")) {
    Table table = root.table("fields");
    devices.merge(devices_of(table, d.hands, "Device that feels the field", "all devices"));
    presented.fields =
        scene::read_fields(table, d.rate, objects, channel::names_of_values(d.channels));
  }
  presented.fields.insert(presented.fields.end(), objects.begin(), objects.end());
  leave_out_short_fades(presented.fields);
  presented.felt = felt_by(presented.fields, devices, d.hands);
  presented.felt.resize(static_cast<std::size_t>(d.devices()), 0);
}

/// Regions that wait for the cursor in place of a tool.
std::vector<bool> read_of_cursor(Table& regions, bool cursor) {
  std::vector<bool> of_cursor;
  for (const std::string& name : regions.keys()) {
    Table region = regions.table(name);
    region.describe({"of", "Whether the tool or the cursor must be in the region", "tool", false});
    of_cursor.push_back(region.has("of") && region.choice("of", {"tool", "cursor"}) == "cursor");
    if (of_cursor.back() && !cursor) {
      region.reject("of", "is \"cursor\", but the definition has no [cursor]");
    }
  }
  return of_cursor;
}

void read_all_regions(Table& root, const TrialsDefinition& d, Presented& presented) {
  if (!root.has("regions")) {
    return;
  }
  Table table = root.table("regions");
  const DeviceOf devices =
      devices_of(table, d.hands, "Device whose tool must be in the region", "the first device");
  presented.of_cursor = read_of_cursor(table, presented.cursor.has_value());
  presented.regions = scene::read_regions(table);
  for (const scene::Region& region : presented.regions) {
    const auto own = devices.find(region.name);
    presented.region_devices.push_back(own == devices.end() ? 0 : own->second);
  }
}

template <class Named>
void add_names(const std::vector<Named>& named, std::vector<std::string>& to) {
  for (const Named& one : named) {
    to.push_back(one.name);
  }
}

/// Names of contents that a stage may show.
std::vector<std::string> sights_of(const Presented& presented, const Names& names,
                                   const TrialsDefinition& d) {
  std::vector<std::string> sights{"hand", "interval_number"};
  if (presented.cursor) {
    sights.emplace_back("cursor");
  }
  add_names(presented.regions, sights);
  add_names(presented.looks, sights);
  add_names(presented.targets, sights);
  add_names(d.objects, sights);
  const std::vector<std::string> places = names.places();
  sights.insert(sights.end(), places.begin(), places.end());
  return sights;
}

std::vector<std::string> names_of_measures(Table& root) {
  return root.has("measures") ? root.table("measures").keys_as_written()
                              : std::vector<std::string>{};
}

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& named) {
  std::vector<std::string> names;
  add_names(named, names);
  return names;
}

std::vector<std::string> units_of_values(const TrialsDefinition& d) {
  std::vector<std::string> units;
  for (const channel::ChannelOptions& channel : d.channels) {
    for (const channel::Quantity& quantity : channel.plan.quantities) {
      units.push_back(quantity.unit);
    }
  }
  return units;
}

/// A stage can require only what it measures itself.
void check_required_measures(Table& root, const Presented& presented) {
  std::vector<Table> stages = root.tables("stages");
  for (std::size_t k = 0; k < presented.stages.size(); ++k) {
    const std::optional<Requirement>& require = presented.stages[k].stage.require;
    const auto measure = static_cast<std::size_t>(require ? require->measure : -1);
    if (measure < presented.measures.size() && presented.measures[measure].stage != k) {
      stages[k].table("require").reject(
          "measure", fmt::format("\"{}\"", presented.measures[measure].name),
          fmt::format("a measure of this stage, with stage = \"{}\"", presented.stages[k].name));
    }
  }
}

/// Measures, once fields, targets and stages are known.
void read_all_measures(Table& root, const Names& names, const TrialsDefinition& d,
                       Presented& presented) {
  if (!root.has("measures")) {
    return;
  }
  const MeasureSource source{names_of(presented.stages),
                             names_of(d.intervals),
                             names_of(presented.fields),
                             presented.felt,
                             names_of(presented.targets),
                             channel::names_of_values(d.channels),
                             units_of_values(d),
                             d.hands,
                             [&names](const std::string& name) {
                               return names.has_place(name) ? std::optional(names.place(name))
                                                            : std::nullopt;
                             }};
  Table measures = root.table("measures");
  presented.measures = read_measures(measures, source);
  check_required_measures(root, presented);
}

}  // namespace

Presented read_presented(Table& document, const Names& names, const TrialsDefinition& d,
                         RandomStream* random) {
  Table root = document.with(names);
  Presented presented;
  read_what_is_felt(root, d, presented);
  if (root.has("cursor")) {
    Table table = root.table("cursor");
    presented.cursor = cursor_schema().read(table);
  }
  if (root.has("targets")) {
    Table table = root.table("targets");
    presented.targets = read_moving_targets(table);
  }
  read_all_regions(root, d, presented);
  if (root.has("looks")) {
    Table table = root.table("looks");
    presented.looks = read_looks(table);
  }
  const std::vector<std::string> sights = sights_of(presented, names, d);
  const StageSource source{
      names_of(presented.fields),
      names_of(presented.regions),
      [&names](const std::string& text) { return names.word(text); },
      random,
      root.has("sounds") ? sound::cue_names(root.table("sounds")) : std::vector<std::string>{},
      sights,
      [&d](Table& table, const std::string& key) {
        return d.keys.bits_of(read_window_keys(table, key));
      },
      channel::names_of_values(d.channels),
      names_of_measures(root)};
  presented.stages = read_stages(root, source);
  read_all_measures(root, names, d, presented);
  if (root.has("sounds")) {
    Table sounds = root.table("sounds");
    presented.varied_cues = sound::read_varied_cues(sounds, d.cues);
  }
  return presented;
}

}  // namespace haptrial::protocols
