#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "core/channel/channel_kinds.h"
#include "core/device/catalog.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

int devices() {
  for (const device::DeviceListing& listing : device::list_devices()) {
    fmt::print("{:<16} {:<8} {}\n", listing.name, listing.available ? "ready" : "missing",
               listing.what);
  }
  fmt::print("\nOther instruments, by the kind of [channels.NAME]:\n");
  for (const channel::ChannelKind& kind : channel::kinds_of_channel()) {
    fmt::print("{:<16} {}\n", kind.word, kind.what);
  }
  return 0;
}

}  // namespace

void add_devices(CLI::App& app, int& status) {
  CLI::App* sub =
      subcommand(app, "devices", "List the devices and other instruments, and how to use them",
                 "haptrial devices", {"", "devices.md"});
  run_when_read(*sub, status, devices);
}

}  // namespace haptrial::experiments
