#include "experiments/studies/drilling/learn_phases.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "analysis/bone_drilling/phases/phase_file.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/record/read/marked_trials.h"
#include "core/record/read/session_reader.h"
#include "experiments/studies/drilling/expert_sessions.h"
#include "experiments/studies/drilling/procedure_setup.h"
#include "experiments/study/study_files.h"
#include "protocols/bone_drilling/bone_protocol.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
namespace drilling = analysis::drilling;

constexpr std::uint64_t kSeed = 1;  // of the search without labels

/// A procedure's actions, and what is known of its phases.
struct Observed {
  std::string session;
  int number;
  double rate;
  double seconds;
  bool simulated;
  drilling::PhaseCase actions;
  std::vector<drilling::PhaseSpan> work;  // of a virtual surgeon
};

/// What a virtual surgeon worked on; from the beginning to the end of the procedure.
std::vector<drilling::PhaseSpan> spans_of(const drilling::Procedure& p) {
  std::vector<drilling::PhaseSpan> spans;
  for (const drilling::BegunWork& begun : p.work) {
    const double start = spans.empty() ? 0.0 : begun.time;
    if (!spans.empty()) {
      spans.back().end = start;
    }
    spans.push_back({begun.work, start, start});
  }
  if (!spans.empty()) {
    spans.back().end = static_cast<double>(p.ticks.size()) / p.rate;
  }
  return spans;
}

std::vector<Observed> observe(const fs::path& file, drilling::StudyBones& bones) {
  const record::SessionReader reader(file);
  const auto setup = procedure_setup(reader);
  const std::set<int> left_out = record::trials_left_out(reader);
  std::vector<Observed> observed;
  for (const drilling::Procedure& p : load_procedures(reader, setup, &bones)) {
    if (!left_out.contains(p.number)) {
      observed.push_back({p.session,
                          p.number,
                          p.rate,
                          static_cast<double>(p.ticks.size()) / p.rate,
                          p.simulated,
                          {p.participant, drilling::actions_of(p, bones), {}},
                          spans_of(p)});
    }
  }
  return observed;
}

std::vector<Observed> observe_study(const PhasesRequest& request,
                                    const std::vector<fs::path>& files) {
  std::vector<std::vector<Observed>> by_file(files.size());
  drilling::StudyBones bones;
  in_groups(files.size(), 1, request.threads, [&] {
    return [&](std::size_t first, std::size_t) {
      require_drilling(files[first]);
      by_file[first] = observe(files[first], bones);
    };
  });
  std::vector<Observed> all;
  for (std::vector<Observed>& own : by_file) {
    std::move(own.begin(), own.end(), std::back_inserter(all));
  }
  return all;
}

/// Labels of a file or, without one, those that the sessions of virtual surgeons have.
drilling::PhaseLabels labels_for(const PhasesRequest& request,
                                 const std::vector<Observed>& observed) {
  drilling::PhaseLabels labels;
  drilling::ProcedureLengths lengths;
  for (const Observed& each : observed) {
    lengths[{each.session, each.number}] = each.seconds;
    if (!each.work.empty()) {
      labels[{each.session, each.number}] = each.work;
    }
  }
  if (request.labels.empty()) {
    if (labels.empty()) {
      throw InputError(fmt::format(
          "{}: nobody labelled the phases of its procedures; add --labels FILE, or --number N to "
          "find N phases without labels",
          request.study.string()));
    }
    return labels;
  }
  labels = drilling::read_phase_labels(request.labels);
  drilling::check_phase_labels(labels, lengths, request.labels.string(), request.study.string());
  return labels;
}

template <class T>
T value_or_refuse(const PhasesRequest& request, const analysis::Defined<T>& learned) {
  if (!learned) {
    throw InputError(
        fmt::format("{}: gives no phases: {}", request.study.string(), learned.because()));
  }
  return *learned;
}

}  // namespace

LearnedPhases learn_study_phases(const PhasesRequest& request) {
  const std::vector<fs::path> files = files_of_one_study(request.study, protocols::bone_drilling());
  const std::vector<Observed> observed = observe_study(request, files);
  std::vector<drilling::PhaseCase> cases;
  LearnedPhases learned;
  if (request.number) {
    for (const Observed& each : observed) {
      cases.push_back(each.actions);
    }
    learned.model = value_or_refuse(request, drilling::find_phases(cases, *request.number, kSeed));
  } else {
    const drilling::PhaseLabels labels = labels_for(request, observed);
    const std::vector<std::string> names = drilling::names_in(labels);
    double actions = 0.0, unlabelled = 0.0;  // of labelled procedures
    for (const Observed& each : observed) {
      if (const auto own = labels.find({each.session, each.number}); own != labels.end()) {
        drilling::PhaseCase labelled = each.actions;
        labelled.phase = drilling::phases_at(labelled.actions, own->second, names, each.rate);
        const auto without = std::ranges::count(labelled.phase, -1);
        actions += static_cast<double>(labelled.phase.size());
        unlabelled += static_cast<double>(without);
        if (without < std::ssize(labelled.phase)) {
          cases.push_back(std::move(labelled));
        }
      }
    }
    learned.labelled = actions > 0.0 ? 1.0 - unlabelled / actions : 0.0;
    learned.model = value_or_refuse(request, drilling::learn_phases(cases, names));
    learned.accuracy = drilling::left_out_accuracy(cases, names);
  }
  for (const Observed& each : observed) {
    learned.model.simulated = learned.model.simulated || each.simulated;
  }
  const record::SessionInfo info = record::SessionReader(files.front()).info();
  learned.model.study =
      protocols::parse_bone_definition(info.definition, info.definition_name).name;
  return learned;
}

drilling::FindPhases phases_by(const fs::path& file) {
  const auto model = std::make_shared<const drilling::PhaseModel>(drilling::read_phase_model(file));
  return [model](const drilling::Procedure& procedure, drilling::StudyBones& bones) {
    return drilling::divide(*model, procedure, bones);
  };
}

}  // namespace haptrial::experiments
