// The command haptrial with one protocol more.
#include "experiments/command/line/whole_command.h"
#include "experiments/studies/registry.h"
#include "springs.h"

int main(int argc, char** argv) {
  haptrial::experiments::add_study(springs());
  return haptrial::experiments::whole_command(argc, argv);
}
