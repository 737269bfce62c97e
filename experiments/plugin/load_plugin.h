#pragma once

#include <filesystem>
#include <string>

namespace haptrial::experiments {

/// Loads a plug-in (experiments/plugin/plugin.h) for as long as the program runs, and takes its
/// protocols, devices, fields and scores into the registries. Its code runs only if it was built
/// for this program. Call before threads are started.
/// @throws InputError if there is no such file, it is no plug-in, was built for another program,
///         cannot be linked, or has a name that is taken
void load_plugin(const std::filesystem::path& file);

/// Every *.so of a folder, in the order of their names. @throws InputError as above, or if there is
/// no such folder
void load_plugins(const std::filesystem::path& folder);

/// What a plug-in must have been built for.
std::string plugin_abi();

}  // namespace haptrial::experiments
