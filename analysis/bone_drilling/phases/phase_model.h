#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/bone_drilling/metrics/phase_span.h"
#include "analysis/bone_drilling/phases/action.h"
#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/base/hidden_markov.h"

namespace haptrial::analysis::drilling {

/// Probabilities of the words of one fact about actions.
struct WordDensity {
  std::vector<std::string> words;  // a word that is not among them counts as the last column
  Eigen::MatrixXd log_share;       // (phases x words + 1)
};

/// The phases of a procedure as states of a hidden Markov model whose observations are actions
/// (action.h). In a phase the words of an action and its numbers, which are normal, are
/// independent. Source: Morris 2006, §8.3.3.3.
struct PhaseModel {
  std::string study;  // name of the definition
  std::size_t participants{0}, procedures{0};
  bool labelled{false};   // phases were given; else they were found
  bool simulated{false};  // a participant was a program
  std::vector<std::string> phases;
  MarkovChain chain;  // (phases)
  std::array<WordDensity, kActionWords> words;
  Eigen::MatrixXd mean, deviation;  // (phases x kActionNumbers), deviation > 0
};

/// The actions of a procedure and, as far as they are known, the phases in which they are.
struct PhaseCase {
  std::string participant;
  std::vector<Action> actions;
  std::vector<int> phase;  // (actions), of the names; -1: not known
};

/// Learns from labelled procedures: shares, means and deviations of the actions in each phase, and
/// how often phases follow one another, where both actions are labelled.
/// Undefined where a phase has fewer than two actions.
Defined<PhaseModel> learn_phases(std::span<const PhaseCase> cases,
                                 const std::vector<std::string>& phases);

/// Learns without labels by Baum and Welch's algorithm: of several starts, which follow from the
/// seed, the most likely one. Phases are called "phase 1" and so on by the mean time at which their
/// actions are.
/// @param count  of phases > 1
/// Undefined where there are fewer than four times as many actions.
Defined<PhaseModel> find_phases(std::span<const PhaseCase> cases, int count, std::uint64_t seed);

/// (actions x phases) log density of each action in each phase.
Eigen::MatrixXd emission_of(const PhaseModel& model, std::span<const Action> actions);

/// The most probable phase of every action.
std::vector<int> phases_of(const PhaseModel& model, std::span<const Action> actions);

/// @throws InputError for actions on another bone or with other tools: if the model knows none of
/// the tools in hand, or none of the structures that they came near
void require_known_words(const PhaseModel& model, std::span<const Action> actions);

/// The phases of a procedure. @throws InputError as require_known_words() does
std::vector<PhaseSpan> divide(const PhaseModel& model, const Procedure& procedure,
                              StudyBones& bones);

}  // namespace haptrial::analysis::drilling
