#include "experiments/commands.h"

#include <fmt/format.h>

namespace haptrial::experiments {

int devices() {
  fmt::print("virtual   simulated 3-DOF impedance device with a virtual subject's hand\n");
  return 0;
}

}  // namespace haptrial::experiments
