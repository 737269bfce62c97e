#pragma once

#include <span>
#include <string>
#include <string_view>

namespace haptrial::experiments {

/// A shipped definition: experiments/NAME.toml, which is built into the command.
struct Example {
  std::string_view name;
  std::string_view text;
};

/// All of them, by name.
std::span<const Example> examples();

/// @throws InputError for another name; tells the nearest one, and all of them.
const Example& example_named(std::string_view name);

/// A definition as the command line names it: a file, or a shipped definition, of which a copy is
/// written beside. @returns the file  @throws InputError for neither
std::string definition_or_example(const std::string& given);

/// The first sentence of its first comment: what it is.
std::string what_of(const Example& example);

/// Text of the example with another name of the experiment, all else as it stands.
std::string renamed(const Example& example, std::string_view name);

}  // namespace haptrial::experiments
