#pragma once

#include <string>

#include "core/device/envelope.h"
#include "core/device/force_dimension.h"
#include "core/device/mouse.h"
#include "core/device/open_haptics.h"
#include "core/device/virtual_device.h"
#include "core/render/trial_display_style.h"
#include "core/subject/hand_parameters.h"
#include "experiments/screen_options.h"
#include "protocols/schedule.h"

namespace haptrial {
class Table;
}

namespace haptrial::experiments {

enum class Integrator { kExact, kCvode };

/// What every protocol's definition says: loop, plan, device, hand, screen.
struct Setup {
  std::string text;       // the file, unchanged
  std::string file_name;  // without folders
  std::string name;
  double rate{1000.0};  // of the servo loop [Hz]
  protocols::Design design;
  double recovery{3.0};  // without force after an abort [s]
  device::EnvelopeLimits envelope;
  device::VirtualDeviceParameters device;
  subject::HandParameters hand;
  Integrator integrator{Integrator::kExact};
  render::TrialDisplayStyle display;
  ScreenOptions screen;
  SessionTexts texts;
  // Of the devices that may take the virtual one's place; a table that is left out has its
  // defaults.
  device::ForceDimensionParameters force_dimension{};
  device::OpenHapticsParameters open_haptics{};
  device::MouseParameters mouse{};
};

/// Reads all but design, recovery and display, which protocols say in their own ways.
Setup read_setup(Table& root, std::string_view file_name);

/// Notes what no table of the setup can see alone.
void check_setup(Table& root, const Setup& setup);

}  // namespace haptrial::experiments
