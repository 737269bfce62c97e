#pragma once

#include <functional>
#include <span>

namespace CLI {
class App;
}

namespace haptrial::experiments {

/// Reads a line of words and runs the subcommand that it gives.
/// @param line     the program's name and what was typed after it
/// @param declare  adds the subcommands; see experiments/command/line/command_lines.h
/// @returns the exit status. @throws what the subcommand throws
int run_line(std::span<char* const> line,
             const std::function<void(CLI::App& app, int& status)>& declare);

/// The exit status of a program: what `command` returns, or 1 or 2 after a sentence on standard
/// error for what it threw. Throws nothing.
int exit_status(const std::function<int()>& command);

}  // namespace haptrial::experiments
