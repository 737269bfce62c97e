#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/control/handle_loop.h"
#include "core/stimulus/stimulus.h"
#include "core/subject/pacer.h"
#include "core/subject/path_learner.h"
#include "core/subject/population.h"
#include "core/subject/subject_parameters.h"
#include "protocols/definition/definition.h"
#include "protocols/force_training/trajectory_pass.h"

namespace haptrial::protocols {

inline constexpr const char* kForceTraining = "force_training";  // its name in [experiment]

/// An experiment of forces along a path, read from a definition file and valid as a whole.
struct ForceDefinition : Definition {
  stimulus::TrajectoryParameters trajectory;
  stimulus::ForcePatternParameters force_pattern;
  GuidanceParameters guidance;
  subject::Population<subject::SubjectParameters> population;
  std::optional<subject::Population<subject::PaceParameters>> pace;   // if it is not set
  std::optional<subject::Population<subject::PathParameters>> paths;  // if the recall is free
  double stimulus_rate{1000.0};                                       // [Hz]
  std::map<std::string, std::vector<std::string>>
      group_conditions{};             // where the design states any
  std::vector<int> session_trials{};  // of each session, where the definition describes sessions

  int sessions() const override { return design.sessions; }
  /// The design of a participant's session, with its trials and the conditions of the
  /// participant's group; practice comes before the first session alone.
  /// @param session  from 1  @param participant  from 0
  Design design_of(int session, int participant) const;
  /// Sessions before one in which a participant was trained, in their order.
  std::vector<int> trainings_before(int session, int participant) const;

  /// Whether a condition of training has an expert.
  bool shows_expert() const;

  std::vector<std::string> description() const override;
  std::vector<std::string> margins() const override;
  std::vector<std::string> warnings() const override;
  double longest(int trials) const override;
  /// Instructions with the meaning of a square in the corner, for those who may see one.
  std::string instructions() const override { return texts.instructions + "\n" + texts.limit; }
};

/// @throws InputError with a sentence for every problem of the file.
ForceDefinition load_force_definition(const std::filesystem::path& file);

/// A definition from its text, as a session file keeps it. A path that it takes from a recorded
/// pass is not read: the session file holds the path itself.
ForceDefinition parse_force_definition(std::string_view text, std::string_view file_name);

/// The same from a table that others read on, and whose problems are still to be thrown.
/// @param folder  of the file, where a recorded path is to be read; else null
ForceDefinition read_force_definition(Table& root, std::string_view file_name,
                                      const std::filesystem::path* folder);

/// How firmly the loop lets the handle be held, a line for the path and one for the plane.
std::vector<std::string> margins_of(const GuidanceParameters& guidance,
                                    const control::HandleLoop& loop = {});

}  // namespace haptrial::protocols
