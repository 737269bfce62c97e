#include "protocols/psychophysics/subject/observer_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/definition/schema.h"
#include "protocols/psychophysics/definition/question.h"
#include "protocols/psychophysics/definition/trials_definition.h"

namespace haptrial::protocols {
namespace {

/// Names of a definition that [observer] may use.
struct ObserverNames {
  const std::vector<TrialQuestion>& questions;
  const std::vector<std::string>& stages;
  const std::vector<TrialDevice>& devices;
};

Schema<Adaptation> make_adaptation_schema(const ObserverNames& names) {
  using A = Adaptation;
  return Schema<A>()
      .text("stage", &A::stage, "Stage of the reach that virtual participants adapt from")
      .required()
      .check([&names](Table& table, A& a) { check_stage(table, "stage", a.stage, names.stages); })
      .custom("matrix", "Matrix B of the field B v that virtual participants adapt to",
              [](Table& table, const std::string& key, A& a) {
                a.field = read_matrix(table, key, {-1000.0, 1000.0}, "N·s/m");
              })
      .otherwise("to the rotation of the cursor")
      .keys_of(&A::rates, subject::two_rate_schema());
}

/// The choice of the first question whose value the key names, from 0.
int read_choice(Table& table, const std::string& key, const std::vector<TrialQuestion>& asked,
                int otherwise) {
  const std::string value = table.text(key);
  const std::vector<questions::Choice> choices =
      asked.empty() ? std::vector<questions::Choice>{} : asked.front().choices;
  const auto found = std::ranges::find(choices, value, &questions::Choice::value);
  if (found == choices.end()) {
    table.reject(key, fmt::format("\"{}\"", value), "the value of a choice of the response");
    return otherwise;
  }
  return static_cast<int>(found - choices.begin());
}

/// A percept for each choice of the first question.
std::vector<double> read_prototypes(Table& table, const std::vector<TrialQuestion>& questions) {
  const std::size_t choices = questions.empty() ? 0 : questions.front().choices.size();
  std::vector<double> prototypes = table.numbers("prototypes", kNonNegative, "");
  if (prototypes.size() != choices) {
    table.reject("prototypes", fmt::format("a list of {}", prototypes.size()),
                 fmt::format("{} numbers, one for each choice of the response", choices));
  }
  return prototypes;
}

using ChoiceOf = int ObserverPlan::*;

/// Adds a key that names a choice of the first question, and sets its number.
void add_choice(Schema<ObserverPlan>& schema, const char* name, ChoiceOf member,
                const std::vector<TrialQuestion>& questions, std::string description,
                std::string otherwise) {
  schema
      .custom(name, std::move(description),
              [member, &questions](Table& table, const std::string& key, ObserverPlan& plan) {
                plan.*member = read_choice(table, key, questions, plan.*member);
              })
      .otherwise(std::move(otherwise));
}

bool adjusts(const ObserverPlan& plan) { return plan.decides == Decides::kAdjust; }

void add_decision(Schema<ObserverPlan>& schema, const std::vector<TrialQuestion>& questions) {
  using P = ObserverPlan;
  schema.choice("decides", &P::decides,
                {{"largest", Decides::kLargest},
                 {"smallest", Decides::kSmallest},
                 {"yes", Decides::kYes},
                 {"nearest", Decides::kNearest},
                 {"magnitude", Decides::kMagnitude},
                 {"adjust", Decides::kAdjust}},
                "Rule by which percepts become an answer: the interval with the largest or "
                "smallest percept, yes or no, the choice whose prototype is nearest, a magnitude, "
                "or an adjustment of the last interval until it feels as the first");
  add_choice(schema, "yes", &P::yes, questions, "Value of the choice that means yes",
             "the first choice");
  schema
      .custom("prototypes",
              "Percepts that the choices stand for, one each; the choice with the nearest is "
              "answered",
              [&questions](Table& table, const std::string&, P& plan) {
                plan.prototypes = read_prototypes(table, questions);
              })
      .required()
      .only_if([](const P& plan) { return plan.decides == Decides::kNearest; });
  add_choice(schema, "raise", &P::raise, questions,
             "Value of the choice that raises an adjusted level", "the first choice");
  schema.only_if(adjusts);
  add_choice(schema, "lower", &P::lower, questions,
             "Value of the choice that lowers an adjusted level", "the second choice");
  schema.only_if(adjusts);
  add_choice(schema, "done", &P::done, questions, "Value of the choice that ends an adjustment",
             "the third choice");
  schema.only_if(adjusts)
      .number("wanted", &P::wanted, kPositive, "",
              "Percept to which a level is adjusted if the trial shows none before")
      .only_if(adjusts)
      .number("reaction", &P::reaction, {0.01, 60.0}, "s",
              "Median time from a question to the answer of a virtual participant");
}

Schema<ObserverPlan> make_observer_schema(const ObserverNames& names,
                                          const Schema<Adaptation>& adaptation) {
  using P = ObserverPlan;
  using subject::Quantity;
  Schema<P> schema;
  schema
      .choice("senses", &P::senses,
              {{"force", Quantity::kForce},
               {"stiffness", Quantity::kStiffness},
               {"compliance", Quantity::kCompliance},
               {"viscosity", Quantity::kViscosity},
               {"friction", Quantity::kFriction},
               {"roughness", Quantity::kRoughness},
               {"extent", Quantity::kExtent},
               {"unevenness", Quantity::kUnevenness},
               {"contrast", Quantity::kContrast},
               {"frequency", Quantity::kFrequency},
               {"mass", Quantity::kMass},
               {"duration", Quantity::kDuration}},
              "Quantity that virtual participants feel and judge")
      .custom("in_stage", "Stage in which virtual participants feel what they judge",
              [&names](Table& table, const std::string& key, P& plan) {
                plan.stage = table.text(key);
                check_stage(table, key, plan.stage, names.stages);
              })
      .otherwise("throughout the interval")
      .custom("at_device", "Device at which virtual participants feel what they judge",
              [&names](Table& table, const std::string& key, P& plan) {
                std::vector<std::string> known;
                for (const TrialDevice& each : names.devices) {
                  known.push_back(each.name);
                }
                const auto at = std::ranges::find(known, table.choice(key, known));
                plan.device = at == known.end() ? 0 : static_cast<std::size_t>(at - known.begin());
              })
      .only_if([&names](const P&) { return !names.devices.empty(); })
      .otherwise("the first");
  add_decision(schema, names.questions);
  schema
      .custom("actions",
              "Actions of virtual hands by the names of the stages; without one a hand "
              "rests",
              [&names](Table& table, const std::string& key, P& plan) {
                Table actions = table.table(key);
                plan.actions = read_actions(actions, names.stages, names.devices);
              })
      .table("adaptation", &P::adaptation, adaptation,
             "Adaptation of reaches to a field, or to the rotation of the cursor")
      .table("sight", &P::sight, subject::sight_schema(),
             "Precision with which virtual participants see sizes")
      .table("script", &P::script, decision_script_schema(),
             "Script by which virtual participants answer in place of the rule of `decides`")
      .check([](Table& table, P& plan) {
        // Nothing at all has no logarithm.
        plan.people.emplace(table,
                            plan.decides != Decides::kYes && plan.decides != Decides::kNearest);
      });
  return schema;
}

}  // namespace

ObserverPlan read_observer(Table& root, const std::vector<TrialQuestion>& questions,
                           const std::vector<std::string>& stages,
                           const std::vector<TrialDevice>& devices) {
  const ObserverNames names{questions, stages, devices};
  const Schema<Adaptation> adaptation = make_adaptation_schema(names);
  Table table = root.table("observer");
  return make_observer_schema(names, adaptation).read(table);
}

}  // namespace haptrial::protocols
