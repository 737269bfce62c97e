#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "analysis/bone_drilling/report/with_without.h"
#include "analysis/document/document.h"
#include "core/bone/hint/hint_setup.h"
#include "core/record/read/session_reader_forward.h"

namespace haptrial::analysis::drilling {

/// Hints of one kind in a procedure.
struct HintCounts {
  int hints{0};
  int removals{0};   // that they were about
  double time{0.0};  // that they lasted [s]
};

/// One procedure of a session that gives hints. Hints that were not shown are recorded as well.
struct HintProcedure : GivenProcedure {
  std::array<HintCounts, hint::kHintKinds> kinds;  // by hint::HintKind

  const HintCounts& of(hint::HintKind kind) const { return kinds[static_cast<std::size_t>(kind)]; }
  int hints() const;
};

/// The procedures of a session in the order of trials, those of practice left out; none where it
/// gives no hints. @param summaries  of the session's procedures, for the time of drilling
/// @throws InputError where the file is damaged
std::vector<HintProcedure> load_hints(const record::SessionReader& file,
                                      std::span<const ProcedureSummary> summaries);

/// A row for each procedure and kind.
std::string hints_csv(std::span<const HintProcedure> procedures);

/// Change of one quantity by hints.
struct HintEffect {
  std::string name;  // "hint_rate", or a metric's
  std::string title;
  std::string unit;
  WithWithout effect;                   // participants' means with hints less those without
  Defined<double> holm{Undefined{""}};  // its p among all quantities
};

/// Hints a minute of drilling, which count whether they were shown or not, and the metrics that
/// hints are about. Empty unless some procedures were with hints and others without.
std::vector<HintEffect> hint_effects(std::span<const HintProcedure> hints,
                                     std::span<const ProcedureSummary> summaries);

/// Hints in a report: by condition and kind, and what they changed. Nothing where none are given.
/// @param simulated  the participants are programs
void add_hint_section(Document& document, std::span<const HintProcedure> hints,
                      std::span<const HintEffect> effects, bool simulated);

/// Lines for the end of the command, without "Simulated".
std::vector<std::string> hint_lines(std::span<const HintProcedure> hints,
                                    std::span<const HintEffect> effects);

}  // namespace haptrial::analysis::drilling
