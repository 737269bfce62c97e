#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/bone_drilling/metrics/phase_span.h"
#include "analysis/bone_drilling/phases/phase_model.h"

namespace haptrial::analysis::drilling {

/// Phases of procedures as somebody labelled them, or as a model divided them: by the name of the
/// session's file and the number of the procedure, in order of time.
using PhaseLabels = std::map<std::pair<std::string, int>, std::vector<PhaseSpan>>;

/// A table: session, procedure, phase, start_s, end_s.
std::string phase_labels_csv(const PhaseLabels& labels);
/// @throws InputError for what phase_labels_csv() does not write, among it an end that is not after
/// its start or spans of one procedure that overlap. Rows may come in any order; gaps are allowed.
PhaseLabels read_phase_labels(const std::filesystem::path& file);

/// Length of each procedure that may be labelled, by session and number [s].
using ProcedureLengths = std::map<std::pair<std::string, int>, double>;
/// @param file   of the labels, for sentences  @param study  of the procedures, likewise
/// @throws InputError for a procedure that is not there, and for a phase that ends more than a
/// second after its procedure, as in milliseconds or of another recording
void check_phase_labels(const PhaseLabels& labels, const ProcedureLengths& lengths,
                        const std::string& file, const std::string& study);

/// The names of all phases, by when they begin first (phases_in_order()).
std::vector<std::string> names_in(const PhaseLabels& labels);

/// The phase of the middle of each action; -1 where no span holds it.
std::vector<int> phases_at(std::span<const Action> actions, const std::vector<PhaseSpan>& spans,
                           const std::vector<std::string>& names, double rate);

/// Labelled time, by the label and by the phase that a model found.
struct PhaseAccuracy {
  Eigen::MatrixXd ticks;  // (label x found)

  /// Share of the time whose phase was found; 0 without any.
  double right() const;
  /// Share that the most frequent label has: whoever always says it is right so often.
  double chance() const;
  /// Cohen's kappa: 1 where all is right, 0 where no more is right than by chance.
  double kappa() const;
};

/// Holds the phases that a model finds against the labels, each participant's by a model of the
/// others. Undefined where learn_phases() is for one of them, or with fewer than two participants.
Defined<PhaseAccuracy> left_out_accuracy(std::span<const PhaseCase> cases,
                                         const std::vector<std::string>& phases);

}  // namespace haptrial::analysis::drilling
