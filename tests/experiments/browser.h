#pragma once

#include <functional>
#include <string>
#include <vector>

namespace haptrial::test {

/// Runs one of the scripts here that drive a browser. Its errors, and what it still waits for, are
/// shown as they come, so that they are seen also where the test runner ends a hang.
/// @param script  file name, in this folder
/// @param heard  is called with each line that the script prints
/// @returns its exit status
int run_browser(const std::string& script, const std::vector<std::string>& arguments,
                const std::function<void(const std::string&)>& heard = {});

}  // namespace haptrial::test
