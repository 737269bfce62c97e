// The command haptrial with one protocol more.
#include "experiments/command/line/whole_command.h"
#include "experiments/studies/registry.h"
#include "springs.h"

int main(int argc, char** argv) {
  using namespace haptrial::experiments;
  return whole_command(argc, argv, [] { add_study(springs()); });
}
