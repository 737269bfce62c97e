#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "analysis/score_parameters.h"
#include "core/device/envelope.h"
#include "core/device/force_dimension.h"
#include "core/device/mouse.h"
#include "core/device/open_haptics.h"
#include "core/device/virtual_device.h"
#include "core/render/trial_display_style.h"
#include "core/stimulus/stimulus.h"
#include "core/subject/hand_parameters.h"
#include "core/subject/pacer.h"
#include "core/subject/subject_parameters.h"
#include "experiments/screen_options.h"
#include "protocols/schedule.h"
#include "protocols/trajectory_pass.h"

namespace haptrial::experiments {

enum class Integrator { kExact, kCvode };

/// An experiment, read from a definition file and valid as a whole.
struct Definition {
  std::string text;       // the file, unchanged
  std::string file_name;  // without folders
  std::string name;
  double rate;  // of the servo loop [Hz]
  protocols::Design design;
  stimulus::TrajectoryParameters trajectory;
  stimulus::ForcePatternParameters force_pattern;
  protocols::GuidanceParameters guidance;
  device::EnvelopeLimits envelope;
  device::VirtualDeviceParameters device;
  subject::HandParameters hand;
  Integrator integrator;
  subject::Population population;
  std::optional<subject::PaceHabits> pace;  // where participants set their own
  render::TrialDisplayStyle display;
  ScreenOptions screen;
  SessionTexts texts;
  double stimulus_rate;  // [Hz]
  analysis::ScoreParameters scoring;
  // Of the devices that may take the virtual one's place; a table that is left out has its
  // defaults.
  device::ForceDimensionParameters force_dimension{};
  device::OpenHapticsParameters open_haptics{};
  device::MouseParameters mouse{};
};

/// @throws InputError with a sentence for every problem of the file.
Definition load_definition(const std::filesystem::path& file);

/// A definition from its text, as a session file keeps it. A path that it takes from a recorded
/// pass is not read: the session file holds the path itself.
Definition parse_definition(std::string_view text, std::string_view file_name);

}  // namespace haptrial::experiments
