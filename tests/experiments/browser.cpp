#include "tests/experiments/browser.h"

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <stdexcept>

namespace haptrial::test {

int run_browser(const std::string& script, const std::vector<std::string>& arguments,
                const std::function<void(const std::string&)>& heard) {
  std::string command = "python3 -B '" HAPTRIAL_SOURCE_DIR "/tests/experiments/" + script + "'";
  for (const std::string& argument : arguments) {
    command += " '" + argument + "'";
  }
  FILE* output = ::popen(command.c_str(), "r");
  if (output == nullptr) {
    throw std::runtime_error(script + " cannot be started");
  }
  for (std::array<char, 512> line; std::fgets(line.data(), line.size(), output) != nullptr;) {
    if (heard) {
      heard(line.data());
    }
  }
  const int status = ::pclose(output);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace haptrial::test
