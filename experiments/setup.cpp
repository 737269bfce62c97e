#include "experiments/setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "core/base/table.h"

namespace haptrial::experiments {
namespace {

void read_devices(Table& root, Setup& setup) {
  const auto read = [&root](const char* key, auto& into, auto reader) {
    if (root.has(key)) {
      Table table = root.table(key);
      into = reader(table);
    }
  };
  read("force_dimension", setup.force_dimension, device::read_force_dimension_parameters);
  read("open_haptics", setup.open_haptics, device::read_open_haptics_parameters);
  read("mouse", setup.mouse, device::read_mouse_parameters);
}

}  // namespace

Setup read_setup(Table& root, std::string_view file_name) {
  Table experiment = root.table("experiment");
  Table envelope = root.table("envelope");
  Table device = root.table("device");
  Table hand = root.table("hand");
  Table screen = root.table("screen");
  Table texts = root.table("texts");
  Setup setup;
  setup.text = root.source();
  setup.file_name = std::filesystem::path(file_name).filename().string();
  setup.name = experiment.text("name");
  setup.rate = experiment.number("rate", {100.0, 20000.0}, "Hz");
  setup.envelope = device::read_envelope_limits(envelope);
  setup.device = device::read_virtual_device_parameters(device);
  const bool cvode = hand.choice("integrator", {"exact", "cvode"}) == "cvode";
  setup.integrator = cvode ? Integrator::kCvode : Integrator::kExact;
  setup.hand = subject::read_hand_parameters(hand);
  if (!envelope.has("holding_force")) {  // friction holds on both sides of a standstill
    setup.envelope.holding_force =
        std::max(setup.envelope.holding_force, 5.0 * setup.hand.coulomb_friction);
  }
  setup.screen = read_screen_options(screen);
  setup.texts = read_session_texts(texts);
  read_devices(root, setup);
  return setup;
}

void check_setup(Table& root, const Setup& setup) {
  Table envelope = root.table("envelope");
  if (setup.envelope.max_force > setup.device.max_force) {
    envelope.reject("max_force", fmt::format("{}", setup.envelope.max_force),
                    fmt::format("at most device.max_force, {} [N]", setup.device.max_force));
  }
  if (setup.envelope.workspace_radius > setup.device.workspace_radius) {
    envelope.reject(
        "workspace_radius", fmt::format("{}", setup.envelope.workspace_radius),
        fmt::format("at most device.workspace_radius, {} [m]", setup.device.workspace_radius));
  }
  const bool plain = std::all_of(setup.name.begin(), setup.name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  });
  if (!plain) {
    root.table("experiment")
        .reject("name", fmt::format("'{}'", setup.name), "letters, digits, '-' and '_'");
  }
}

}  // namespace haptrial::experiments
