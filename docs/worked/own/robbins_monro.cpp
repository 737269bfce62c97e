// haptrial with one kind of procedure more, which a test of haptrial adds as well.
#include "robbins_monro.h"

#include "experiments/command/line/whole_command.h"

int main(int argc, char** argv) {
  return haptrial::experiments::whole_command(argc, argv, robbins_monro::add);
}
