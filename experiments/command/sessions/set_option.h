#pragma once

#include <string>
#include <vector>

#include "core/base/definition/given_values.h"

namespace CLI {
class App;
}

namespace haptrial::experiments {

/// Adds --set KEY=VALUE, which may be repeated. @param app, set  outlive each other
void declare_set_option(CLI::App& app, std::vector<std::string>& set);

/// The keys that --set gave. @throws InputError for a text that is not KEY=VALUE
std::vector<GivenKey> given_keys(const std::vector<std::string>& set);

}  // namespace haptrial::experiments
