#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "analysis/python/arrays.h"
#include "core/base/definition/table.h"
#include "core/psychometric/definition/expectation.h"
#include "core/psychometric/definition/procedure_kinds.h"
#include "core/psychometric/definition/read_tracks.h"
#include "core/psychometric/definition/track.h"

namespace haptrial::python {
namespace {

using psychometric::Level;
using psychometric::Outcome;
using psychometric::Track;

/// One track of a definition, begun.
class Procedure {
 public:
  Procedure(Track track, std::uint64_t seed)
      : track_(std::move(track)), procedure_(track_.begin(seed, track_.name)) {}

  const Track& track() const { return track_; }
  const psychometric::Procedure& state() const { return *procedure_; }
  const std::vector<Outcome>& outcomes() const { return outcomes_; }
  /// Within the range and rounded, as a session presents it.
  Level next() const { return track_.applied(procedure_->next()); }
  void answer(double answer, const std::optional<Level>& applied) {
    const Level level = applied ? *applied : next();
    procedure_->report(answer, level);
    outcomes_.push_back({answer, level});
  }
  void postpone() { procedure_->postpone(); }

 private:
  Track track_;
  std::unique_ptr<psychometric::Procedure> procedure_;
  std::vector<Outcome> outcomes_;
};

/// A level of one dimension is a number.
py::object plain(const Level& level) {
  return level.size() == 1 ? py::object(py::float_(level.front())) : py::object(py::cast(level));
}

Level level_of(const py::object& value) {
  return py::isinstance<py::sequence>(value) ? value.cast<Level>() : Level{value.cast<double>()};
}

py::list estimates(const Procedure& procedure) {
  py::list all;
  for (const psychometric::Estimate& estimate : procedure.state().estimates()) {
    py::dict one;
    one["name"] = estimate.name;
    one["value"] = estimate.value;
    one["deviation"] = estimate.deviation;
    one["interval"] =
        estimate.interval
            ? py::object(py::make_tuple(estimate.interval->low, estimate.interval->high))
            : py::object(py::none());
    all.append(one);
  }
  return all;
}

py::list outcomes(const Procedure& procedure) {
  py::list all;
  for (const Outcome& outcome : procedure.outcomes()) {
    all.append(py::make_tuple(plain(outcome.applied), outcome.answer));
  }
  return all;
}

/// @param whole  whether `text` is a definition, of which the rest is not looked at
std::vector<std::unique_ptr<Procedure>> procedures(const std::string& text, const std::string& name,
                                                   bool whole, std::uint64_t seed) {
  Table root = Table::parse(text, name);
  std::vector<Track> tracks = psychometric::read_tracks(root);
  if (whole) {
    root.check();
  } else {
    root.finish();
  }
  std::vector<std::unique_ptr<Procedure>> all;
  for (Track& track : tracks) {
    all.push_back(std::make_unique<Procedure>(std::move(track), seed));
  }
  return all;
}

/// Whether `variable` names what a kind of procedure sets; also for a word that is no kind.
bool sets_one_variable(const std::string& word) {
  return std::ranges::none_of(psychometric::kinds_of_procedure(), [&](const auto& kind) {
    return kind.word == word && !kind.sets_one_variable();
  });
}

void bind_state(py::class_<Procedure>& procedure) {
  procedure
      .def_property_readonly(
          "name", [](const Procedure& p) { return p.track().name; }, "Name of the track.")
      .def_property_readonly(
          "kind", [](const Procedure& p) { return p.track().kind; },
          "\"staircase\", \"pest\", \"psi\", \"quest_plus\", \"constant\", \"adjustment\" or "
          "\"magnitude\".")
      .def_property_readonly(
          "unit", [](const Procedure& p) { return p.track().unit; },
          "Unit of the level, as the keys state it.")
      .def_property_readonly(
          "variables", [](const Procedure& p) { return p.track().variables(); },
          "What a level sets, in the order of its dimensions.")
      .def_property_readonly(
          "finished", [](const Procedure& p) { return p.state().finished(); },
          "Whether no further trial is wanted.")
      .def_property_readonly("estimates", &estimates,
                             "What was found so far: dictionaries of name, value [unit of the "
                             "level, or of the parameter], deviation (its standard deviation, or "
                             "None) and interval (95 %, or None). Empty while the answers do not "
                             "suffice.")
      .def_property_readonly(
          "target", [](const Procedure& p) { return p.state().target(); },
          "Probability of answer 1 at the level that is sought [1]; None: it depends on the "
          "observer, or no level is sought.")
      .def_property_readonly("outcomes", &outcomes, "(level, answer) of each trial so far.")
      .def_property_readonly(
          "prediction", [](const Procedure& p) { return psychometric::predicted(p.track()); },
          "What it will find if people are as the key `expect` says, in a sentence; None without "
          "it.");
}

}  // namespace

void bind_procedures(py::module_& module) {
  py::class_<Procedure> procedure(module, "Procedure",
                                  "Chooses the next level from the answers so far, as "
                                  "haptrial.procedure() makes it.");
  procedure
      .def(
          "next", [](const Procedure& p) { return plain(p.next()); },
          "The level to present [unit]: a number, or a list for several dimensions. The same until "
          "answer() is called.")
      .def(
          "answer",
          [](Procedure& p, double answer, const py::object& applied) {
            p.answer(answer, applied.is_none() ? std::nullopt : std::optional(level_of(applied)));
          },
          py::arg("answer"), py::arg("applied") = py::none(),
          "Tells what came of the trial. answer: True or 1 is right (or yes, stronger), False or 0 "
          "wrong; of adjustments 1, -1 or 0 (as it is); of magnitudes the number given. applied: "
          "the level that was really presented, without it next().")
      .def("postpone", &Procedure::postpone,
           "The present level comes again later, if levels are known before the first trial.");
  bind_state(procedure);
  module.def("sets_one_variable", &sets_one_variable, py::arg("word"));
  module.def("procedures", &procedures, py::arg("text"), py::arg("name"), py::arg("whole"),
             py::arg("seed"));
}

}  // namespace haptrial::python
