#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "analysis/analysis_plan.h"
#include "analysis/score_parameters.h"
#include "core/stimulus/stimulus.h"
#include "core/subject/pacer.h"
#include "core/subject/subject_parameters.h"
#include "experiments/setup.h"
#include "protocols/trajectory_pass.h"

namespace haptrial {
class Table;
}

namespace haptrial::experiments {

/// An experiment of forces along a path, read from a definition file and valid as a whole.
struct Definition : Setup {
  stimulus::TrajectoryParameters trajectory;
  stimulus::ForcePatternParameters force_pattern;
  protocols::GuidanceParameters guidance;
  subject::Population population;
  std::optional<subject::PaceHabits> pace;  // where participants set their own
  double stimulus_rate;                     // [Hz]
  analysis::ScoreParameters scoring;
  analysis::AnalysisPlan plan;
};

/// @throws InputError with a sentence for every problem of the file.
Definition load_definition(const std::filesystem::path& file);

/// A definition from its text, as a session file keeps it. A path that it takes from a recorded
/// pass is not read: the session file holds the path itself.
Definition parse_definition(std::string_view text, std::string_view file_name);

/// The same from a table that is read already. @param folder  of the file, where a recorded path is
/// to be read; else null
Definition read_definition(Table& root, std::string_view file_name,
                           const std::filesystem::path* folder);

}  // namespace haptrial::experiments
