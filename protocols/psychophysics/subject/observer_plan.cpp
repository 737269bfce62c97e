#include "protocols/psychophysics/subject/observer_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "core/base/definition/table.h"
#include "core/base/definition/table_vector.h"
#include "protocols/psychophysics/definition/question.h"
#include "protocols/psychophysics/definition/trials_definition.h"

namespace haptrial::protocols {
namespace {

using subject::Quantity;

constexpr std::array<std::pair<const char*, Quantity>, 9> kQuantities{
    {{"force", Quantity::kForce},
     {"stiffness", Quantity::kStiffness},
     {"compliance", Quantity::kCompliance},
     {"viscosity", Quantity::kViscosity},
     {"friction", Quantity::kFriction},
     {"roughness", Quantity::kRoughness},
     {"extent", Quantity::kExtent},
     {"unevenness", Quantity::kUnevenness},
     {"contrast", Quantity::kContrast}}};

void check_stage(Table& table, const char* key, const std::string& name,
                 const std::vector<std::string>& stages) {
  if (std::find(stages.begin(), stages.end(), name) == stages.end()) {
    table.reject(key, fmt::format("\"{}\"", name),
                 fmt::format("a stage: {}", fmt::join(stages, ", ")));
  }
}

subject::Probe read_press(Table& table) {
  subject::Press press;
  press.force = table.number("force", {0.0, 50.0}, "N");
  if (table.has("rise")) {
    press.rise = table.number("rise", {0.01, 60.0}, "s");
  }
  if (table.has("travel")) {
    press.travel = table.number("travel", {0.001, 1.0}, "m");
  }
  if (table.has("direction")) {
    press.direction = read_direction(table, "direction");
  }
  return press;
}

subject::Probe read_stroke(Table& table) {
  subject::Stroke stroke;
  stroke.direction = read_direction(table, "direction");
  stroke.half_length = table.number("half_length", {0.001, 0.5}, "m");
  stroke.frequency = table.number("frequency", {0.05, 10.0}, "Hz");
  if (table.has("force")) {
    stroke.force = table.number("force", {0.0, 50.0}, "N");
  }
  if (table.has("normal")) {
    stroke.normal = read_direction(table, "normal");
  }
  return stroke;
}

subject::Probe read_contour(Table& table) {
  subject::Contour contour;
  if (table.has("towards")) {
    contour.towards = read_direction(table, "towards");
  }
  if (table.has("around")) {
    contour.around[0] = read_direction(table, "around");
  }
  if (table.has("then_around")) {
    contour.around[1] = read_direction(table, "then_around");
  }
  contour.turn_after = table.number_or("turn_after", contour.turn_after, {0.1, 600.0}, "s");
  contour.speed = table.number_or("speed", contour.speed, {0.001, 1.0}, "m/s");
  if (table.has("force")) {
    contour.force = table.number("force", {0.0, 50.0}, "N");
  }
  return contour;
}

subject::Probe read_palpation(Table& table) {
  subject::Palpate palpate;
  const std::vector<Eigen::Vector3d> places = read_vectors(table, "at", {-1.0, 1.0}, "m");
  palpate.count = places.size();
  std::copy_n(places.begin(), std::min(places.size(), subject::Palpate::kMost),
              palpate.places.begin());
  palpate.force = table.number("force", {0.0, 50.0}, "N");
  if (table.has("direction")) {
    palpate.direction = read_direction(table, "direction");
  }
  palpate.move = table.number_or("move", palpate.move, {0.05, 60.0}, "s");
  palpate.press = table.number_or("press", palpate.press, {0.05, 60.0}, "s");
  return palpate;
}

StageAction read_action(Table& table, const std::string& stage) {
  StageAction action;
  action.stage = stage;
  const std::string what =
      table.choice("do", {"rest", "hold", "press", "stroke", "reach", "follow", "palpate"});
  if (what == "press") {
    action.probe = read_press(table);
  } else if (what == "stroke") {
    action.probe = read_stroke(table);
  } else if (what == "reach") {
    action.probe =
        subject::Reach{Eigen::Vector3d::Zero(), table.number("duration", {0.05, 60.0}, "s")};
    action.to_mark = true;
  } else if (what == "follow") {
    action.probe = read_contour(table);
  } else if (what == "palpate") {
    action.probe = read_palpation(table);
  } else if (what == "hold") {
    action.probe = subject::Hold{};
  }
  try {
    subject::check(action.probe);
  } catch (const std::invalid_argument& error) {
    table.reject("do", fmt::format("cannot be done as stated: {}", error.what()));
  }
  return action;
}

/// One action of every hand, or one of each device that is named.
void read_actions(Table& table, const std::string& stage, const std::vector<TrialDevice>& devices,
                  std::vector<StageAction>& actions) {
  if (devices.empty() || table.has("do")) {
    StageAction action = read_action(table, stage);
    for (std::size_t device = 0; device < std::max<std::size_t>(1, devices.size()); ++device) {
      action.device = device;
      actions.push_back(action);
    }
    return;
  }
  for (std::size_t device = 0; device < devices.size(); ++device) {
    if (table.has(devices[device].name)) {
      Table own = table.table(devices[device].name);
      actions.push_back(read_action(own, stage));
      actions.back().device = device;
    }
  }
}

std::optional<subject::SightParameters> read_sight(Table& table) {
  subject::SightParameters sight;
  sight.noise = table.numbers("noise", kNonNegative, "");
  sight.sd = table.numbers("sd", kPositive, "m");
  if (table.has("spread")) {
    sight.spread = table.number("spread", {0.0, 2.0}, "");
  }
  try {
    subject::check(sight);
  } catch (const std::invalid_argument& error) {
    table.reject("noise", fmt::format("cannot be used with sd: {}", error.what()));
    return std::nullopt;
  }
  return sight;
}

subject::LearningRate read_rate(Table& table, const char* key, subject::LearningRate otherwise) {
  if (!table.has(key)) {
    return otherwise;
  }
  Table rate = table.table(key);
  return {rate.number("retention", kFraction, "1"), rate.number("learning", kFraction, "1")};
}

Adaptation read_adaptation(Table& table, const std::vector<std::string>& stages) {
  Adaptation adaptation;
  adaptation.stage = table.text("stage");
  check_stage(table, "stage", adaptation.stage, stages);
  adaptation.field = read_matrix(table, "matrix", {-1000.0, 1000.0}, "N·s/m");
  adaptation.rates.fast = read_rate(table, "fast", adaptation.rates.fast);
  adaptation.rates.slow = read_rate(table, "slow", adaptation.rates.slow);
  return adaptation;
}

/// The choice of the first question whose value the key names, from 0.
int read_choice(Table& table, const char* key, const std::vector<Question>& questions,
                int otherwise) {
  if (!table.has(key)) {
    return otherwise;
  }
  const std::string value = table.text(key);
  const std::vector<Choice> choices =
      questions.empty() ? std::vector<Choice>{} : questions.front().choices;
  const auto found = std::ranges::find(choices, value, &Choice::value);
  if (found == choices.end()) {
    table.reject(key, fmt::format("\"{}\"", value), "the value of a choice of the response");
    return otherwise;
  }
  return static_cast<int>(found - choices.begin());
}

/// A percept for each choice of the first question.
std::vector<double> read_prototypes(Table& table, const std::vector<Question>& questions) {
  const std::size_t choices = questions.empty() ? 0 : questions.front().choices.size();
  std::vector<double> prototypes = table.numbers("prototypes", kNonNegative, "");
  if (prototypes.size() != choices) {
    table.reject("prototypes", fmt::format("a list of {}", prototypes.size()),
                 fmt::format("{} numbers, one for each choice of the response", choices));
  }
  return prototypes;
}

void read_decision(Table& table, const std::vector<Question>& questions, ObserverPlan& plan) {
  if (table.has("decides")) {
    const std::string how =
        table.choice("decides", {"largest", "smallest", "yes", "nearest", "magnitude", "adjust"});
    plan.decides = how == "smallest"    ? Decides::kSmallest
                   : how == "yes"       ? Decides::kYes
                   : how == "nearest"   ? Decides::kNearest
                   : how == "magnitude" ? Decides::kMagnitude
                   : how == "adjust"    ? Decides::kAdjust
                                        : Decides::kLargest;
  }
  plan.yes = read_choice(table, "yes", questions, plan.yes);
  if (plan.decides == Decides::kNearest) {
    plan.prototypes = read_prototypes(table, questions);
  }
  if (plan.decides == Decides::kAdjust) {
    plan.raise = read_choice(table, "raise", questions, plan.raise);
    plan.lower = read_choice(table, "lower", questions, plan.lower);
    plan.done = read_choice(table, "done", questions, plan.done);
    if (table.has("wanted")) {
      plan.wanted = table.number("wanted", kPositive, "");
    }
  }
  if (table.has("reaction")) {
    plan.reaction = table.number("reaction", {0.01, 60.0}, "s");
  }
}

}  // namespace

ObserverPlan read_observer(Table& root, const std::vector<Question>& questions,
                           const std::vector<std::string>& stages,
                           const std::vector<TrialDevice>& devices) {
  ObserverPlan plan;
  Table table = root.table("observer");
  if (table.has("senses")) {
    std::vector<std::string> words;
    for (const auto& [word, quantity] : kQuantities) {
      words.emplace_back(word);
    }
    const std::string word = table.choice("senses", words);
    plan.senses = std::ranges::find(kQuantities, word, [](const auto& each) {
                    return std::string(each.first);
                  })->second;
  }
  if (table.has("in_stage")) {
    plan.stage = table.text("in_stage");
    check_stage(table, "in_stage", plan.stage, stages);
  }
  read_decision(table, questions, plan);
  if (table.has("actions")) {
    Table actions = table.table("actions");
    for (const std::string& stage : actions.keys()) {
      check_stage(actions, stage.c_str(), stage, stages);
      Table action = actions.table(stage);
      read_actions(action, stage, devices, plan.actions);
    }
  }
  if (table.has("adaptation")) {
    Table adaptation = table.table("adaptation");
    plan.adaptation = read_adaptation(adaptation, stages);
  }
  if (table.has("sight")) {
    Table sight = table.table("sight");
    plan.sight = read_sight(sight);
  }
  plan.script = read_decision_script(table);
  // Nothing at all has no logarithm.
  plan.people.emplace(table, plan.decides != Decides::kYes && plan.decides != Decides::kNearest);
  return plan;
}

}  // namespace haptrial::protocols
