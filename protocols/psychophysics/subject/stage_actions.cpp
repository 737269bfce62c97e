#include "protocols/psychophysics/subject/stage_actions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "core/base/definition/schema.h"
#include "protocols/psychophysics/definition/trials_definition.h"

namespace haptrial::protocols {
namespace {

constexpr Bounds kPressing{0.0, 50.0};  // [N]
constexpr const char* kForce = "Force with which the hand presses";
constexpr const char* kForceOtherwise = "0 of a stroke, 1 of a contour, needed of a press";
constexpr const char* kDirection = "Direction in which the hand presses or strokes";
constexpr const char* kDirectionOtherwise = "down of a press, needed of a stroke";

const Schema<subject::Press>& press_schema() {
  using P = subject::Press;
  static const auto schema =
      Schema<P>()
          .number("force", &P::force, kPressing, "N", kForce)
          .required()
          .otherwise(kForceOtherwise)
          .number("rise", &P::rise, {0.01, 60.0}, "s", "Time over which the force of a press grows")
          .number("travel", &P::travel, {0.001, 1.0}, "m",
                  "Way of a press after which the hand presses no further")
          .direction("direction", &P::direction, kDirection)
          .otherwise(kDirectionOtherwise);
  return schema;
}

const Schema<subject::Stroke>& stroke_schema() {
  using S = subject::Stroke;
  static const auto schema =
      Schema<S>()
          .direction("direction", &S::direction, kDirection)
          .required()
          .otherwise(kDirectionOtherwise)
          .number("half_length", &S::half_length, {0.001, 0.5}, "m",
                  "Half of the length of a stroke, from its middle to an end")
          .required()
          .number("frequency", &S::frequency, {0.05, 10.0}, "Hz",
                  "Frequency of the strokes to and fro")
          .required()
          .number("force", &S::force, kPressing, "N", kForce)
          .otherwise(kForceOtherwise)
          .direction("normal", &S::normal, "Direction in which the hand presses while it strokes")
          .otherwise("down");
  return schema;
}

const Schema<subject::Reach>& reach_schema() {
  using R = subject::Reach;
  static const auto schema =
      Schema<R>()
          .number("duration", &R::duration, {0.05, 60.0}, "s", "Duration of the reach")
          .required();
  return schema;
}

const Schema<subject::Pursue>& pursue_schema() {
  using P = subject::Pursue;
  static const auto schema = Schema<P>().number(
      "lag", &P::lag, {0.01, 5.0}, "s", "Time by which the hand follows a target that moves");
  return schema;
}

const Schema<subject::Contour>& contour_schema() {
  using C = subject::Contour;
  static const auto schema =
      Schema<C>()
          .direction("towards", &C::towards, "Direction to the object whose contour is followed")
          .otherwise("down")
          .custom("around", "Axis of the first loop round an object",
                  [](Table& table, const std::string& key, C& contour) {
                    contour.around[0] = read_direction(table, key);
                  })
          .otherwise("0, 0, 1")
          .custom("then_around", "Axis of the second loop round an object",
                  [](Table& table, const std::string& key, C& contour) {
                    contour.around[1] = read_direction(table, key);
                  })
          .otherwise("1, 0, 0")
          .number("turn_after", &C::turn_after, {0.1, 600.0}, "s",
                  "Time after which the second loop round an object begins")
          .number("speed", &C::speed, {0.001, 1.0}, "m/s",
                  "Speed of the hand along the surface of an object")
          .number("force", &C::force, kPressing, "N", kForce)
          .otherwise(kForceOtherwise);
  return schema;
}

const Schema<subject::Palpate>& palpate_schema() {
  using P = subject::Palpate;
  static const auto schema =
      Schema<P>()
          .custom("at", "Places at which presses begin, one after the other",
                  [](Table& table, const std::string& key, P& palpate) {
                    const auto places = read_vectors(table, key, {-1.0, 1.0}, "m");
                    palpate.count = places.size();
                    std::copy_n(places.begin(), std::min(places.size(), P::kMost),
                                palpate.places.begin());
                  })
          .required()
          .number("force", &P::force, kPressing, "N", kForce)
          .required()
          .otherwise(kForceOtherwise)
          .direction("direction", &P::direction, kDirection)
          .otherwise(kDirectionOtherwise)
          .number("move", &P::move, {0.05, 60.0}, "s",
                  "Duration of the way to each place that is pressed")
          .number("press", &P::press, {0.05, 60.0}, "s", "Duration of the press at each place");
  return schema;
}

template <class T, const Schema<T>& (*schema)()>
subject::Probe read_probe(Table& table) {
  return schema().read(table);
}

struct KindOfAction {
  const char* word;
  subject::Probe (*read)(Table&);
};

constexpr KindOfAction kActions[] = {
    {"rest", [](Table&) -> subject::Probe { return subject::Rest{}; }},
    {"hold", [](Table&) -> subject::Probe { return subject::Hold{}; }},
    {"press", read_probe<subject::Press, press_schema>},
    {"stroke", read_probe<subject::Stroke, stroke_schema>},
    {"reach", read_probe<subject::Reach, reach_schema>},
    {"pursue", read_probe<subject::Pursue, pursue_schema>},
    {"follow", read_probe<subject::Contour, contour_schema>},
    {"palpate", read_probe<subject::Palpate, palpate_schema>},
};

/// @param what_it_is  description of the key `do`; @param otherwise  without it
StageAction read_action(Table& table, const std::string& stage, const char* what_it_is,
                        const char* otherwise) {
  table.describe({"do", what_it_is, otherwise, true});
  std::vector<std::string> words;
  for (const KindOfAction& kind : kActions) {
    words.emplace_back(kind.word);
  }
  StageAction action;
  action.stage = stage;
  const std::string word = table.choice("do", words);
  for (const KindOfAction& kind : kActions) {
    if (word == kind.word) {
      action.probe = kind.read(table);
    }
  }
  action.to_mark = std::holds_alternative<subject::Reach>(action.probe) ||
                   std::holds_alternative<subject::Pursue>(action.probe);
  try {
    subject::check(action.probe);
  } catch (const std::invalid_argument& error) {
    table.reject("do", fmt::format("cannot be done as stated: {}", error.what()));
  }
  return action;
}

/// One action of every hand, or one of each device that is named.
void read_actions_of_stage(Table& table, const std::string& stage,
                           const std::vector<TrialDevice>& devices,
                           std::vector<StageAction>& actions) {
  if (devices.empty() || table.has("do") || table.keys().empty()) {
    StageAction action = read_action(table, stage, "Action of the hand in the stage NAME",
                                     "needed, or a table for each device");
    for (std::size_t device = 0; device < std::max<std::size_t>(1, devices.size()); ++device) {
      action.device = device;
      actions.push_back(action);
    }
    return;
  }
  for (std::size_t device = 0; device < devices.size(); ++device) {
    if (table.has(devices[device].name)) {
      Table own = table.table(devices[device].name);
      state_in_units_of(devices[device], own);
      actions.push_back(read_action(
          own, stage,
          "Action of the hand in the stage of the first name at the device of the second", ""));
      actions.back().device = device;
    }
  }
}

}  // namespace

void check_stage(Table& table, const std::string& key, const std::string& name,
                 const std::vector<std::string>& stages) {
  if (std::find(stages.begin(), stages.end(), name) == stages.end()) {
    table.reject(key, fmt::format("\"{}\"", name),
                 fmt::format("a stage: {}", fmt::join(stages, ", ")));
  }
}

std::vector<StageAction> read_actions(Table& actions, const std::vector<std::string>& stages,
                                      const std::vector<TrialDevice>& devices) {
  std::vector<StageAction> result;
  for (const std::string& stage : actions.keys()) {
    check_stage(actions, stage, stage, stages);
    Table action = actions.table(stage);
    read_actions_of_stage(action, stage, devices, result);
  }
  return result;
}

}  // namespace haptrial::protocols
