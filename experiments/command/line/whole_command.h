#pragma once

namespace haptrial::experiments {

/// The command haptrial, with every study of the registry. A program that adds studies of its own
/// (add_study) calls it from its main().
/// @returns exit status: 0 done, 1 failed, 2 bad input; sentences go to standard error
int whole_command(int argc, char** argv);

}  // namespace haptrial::experiments
