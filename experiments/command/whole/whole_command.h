#pragma once

#include <span>

namespace haptrial::experiments {

class Study;

/// The command haptrial, with every shipped study and those of a program that has its own.
/// @param own  live as long as the program
/// @returns exit status: 0 done, 1 failed, 2 bad input; sentences go to standard error
int whole_command(int argc, char** argv, std::span<const Study* const> own = {});

}  // namespace haptrial::experiments
