// The command haptrial with one protocol more.
#include <array>

#include "experiments/command/whole/whole_command.h"
#include "springs.h"

int main(int argc, char** argv) {
  const std::array own{&springs()};
  return haptrial::experiments::whole_command(argc, argv, own);
}
