#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/bone_drilling/report/with_without.h"
#include "core/record/read/session_reader_forward.h"

namespace haptrial::analysis::drilling {

/// Counts of the monitor's events of one nerve during a procedure.
struct NerveCounts {
  std::string nerve;
  int bursts{0};
  int trains{0};
  int responses{0};        // to a probe
  double train_time{0.0};  // [s]

  int events() const { return bursts + trains; }
};

/// Events held against what was put into the electromyograms (/nerve_discharges).
struct NerveDetection {
  int planted{0};  // bursts, trains and responses
  int found{0};    // of them
  int above{0};    // of them with a peak above the threshold at that time
  int above_found{0};
  int artefacts{0};           // planted
  int artefacts_passed{0};    // of them taken for events
  int false_alarms{0};        // events of nothing that was planted, those of artefacts among them
  double planted_train{0.0};  // [s]
  double found_train{0.0};
  double hours{0.0};

  void add(const NerveDetection& other);
};

/// One event's consequence.
struct NerveReaction {
  double begin{0.0};               // of the event, since the procedure began [s]
  std::optional<double> lift_off;  // after it [s]; none: the procedure ended first
};

/// One procedure beside watched nerves.
struct NerveProcedure : GivenProcedure {
  double duration{0.0};  // [s]
  std::vector<NerveCounts> nerves;
  /// Reactions from the first event of each stretch of drilling to the stretch's end.
  std::vector<NerveReaction> reactions;
  NerveDetection detection;

  int events() const;
  double train_time() const;  // of all nerves [s]
  /// Median of the reactions that ended [s].
  std::optional<double> reaction() const;
};

/// The procedures of a session in the order of trials, those of practice left out; none where it
/// had no nerve monitor. A stretch of drilling ends when the burr has been out of bone, or has
/// stood still, for a tenth of a second; the lift-off is where that begins.
/// @throws InputError where the file is damaged
std::vector<NerveProcedure> load_nerves(const record::SessionReader& file,
                                        const std::string& group);

/// A row for each procedure and nerve.
std::string nerves_csv(const std::vector<NerveProcedure>& procedures);

}  // namespace haptrial::analysis::drilling
