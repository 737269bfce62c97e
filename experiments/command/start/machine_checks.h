#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace haptrial::experiments {

/// Something that a session needs, or that it can do without.
struct MachineCheck {
  enum class State {
    kBroken,   // sessions do not run
    kLimited,  // sessions run, with less: the sentence says what to do
    kReady,
    kAbsent,  // a device that is not connected: nothing is wrong
    kUnused   // the definition's sessions do without
  };
  std::string what;  // "real time"
  State state{State::kReady};
  std::string found;  // a sentence
};

/// "ready", "limited", "absent", "unused", "BROKEN".
const char* name_of(MachineCheck::State state);

/// Some seconds of the servo loop, by an otherwise idle program: how late its ticks are.
/// @param rate  of its ticks [Hz]
MachineCheck check_clock(double seconds, double rate);
MachineCheck check_real_time();
MachineCheck check_off_screen();
MachineCheck check_window();
MachineCheck check_sound();
MachineCheck check_video();
MachineCheck check_stream();
/// Every device that the program knows.
std::vector<MachineCheck> check_devices();
/// Whether files can be written, and how much there is room for. @param folder  that is there
MachineCheck check_disk(const std::filesystem::path& folder);

}  // namespace haptrial::experiments
