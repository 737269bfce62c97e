#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace haptrial::experiments {

/// The command haptrial, with every shipped study, and with what a program of one's own adds.
/// @param add_own  adds it once, before the line is read: add_study() (experiments/studies),
///                 register_device() (core/device), add_kind_of_field() and
///                 add_kind_of_shape() (core/scene/read), add_kind_of_renderer() (core/contact),
///                 add_kind_of_procedure() (core/psychometric/definition),
///                 add_kind_of_question() (core/questions), add_score() and
///                 add_finding_source() (analysis/exchange).
///                 A name that is taken ends the program with a sentence and status 1
/// @returns exit status: 0 done, 1 failed, 2 bad input; sentences go to standard error
int whole_command(int argc, char** argv, const std::function<void()>& add_own = {});

/// Declares every subcommand of haptrial, in the order in which its help lists them. Parsing a line
/// runs the subcommand that it gives.
/// @param status  becomes the exit status of that subcommand; outlives app
void declare_subcommands(CLI::App& app, int& status);

/// Adds the studies that haptrial comes with, one line each, the default one first. Once a program.
void add_shipped_studies();

}  // namespace haptrial::experiments
