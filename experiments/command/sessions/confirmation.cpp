#include "experiments/command/sessions/confirmation.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cstdio>

#include "core/base/error.h"
#include "experiments/control/signals.h"

namespace haptrial::experiments {
namespace {

/// Reads without a buffer: what is typed after the line is for the session.
std::string typed_line() {
  constexpr int kLook = 50;  // for an interrupt [ms]
  std::string line;
  for (;;) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    const int ready = ::poll(&input, 1, kLook);
    if (interrupted()) {
      throw RunError("interrupted; nothing was recorded");
    }
    char next = '\n';
    if (ready > 0 && (::read(STDIN_FILENO, &next, 1) != 1 || next == '\n')) {
      return line;
    }
    if (ready > 0) {
      line += next;
    }
  }
}

}  // namespace

bool confirms(const std::string& question) {
  fmt::print("{} y and Enter: yes, Enter alone: no ", question);
  std::fflush(stdout);
  const std::string answer = typed_line();
  return answer == "y" || answer == "Y";
}

}  // namespace haptrial::experiments
