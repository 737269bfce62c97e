#pragma once

namespace CLI {
class App;
}

namespace haptrial::experiments {

/// Declares every subcommand of haptrial, in the order in which its help lists them. Parsing a line
/// runs the subcommand that it gives.
/// @param status  becomes the exit status of that subcommand; outlives app
void declare_subcommands(CLI::App& app, int& status);

}  // namespace haptrial::experiments
