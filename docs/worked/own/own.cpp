// haptrial with kinds of its own: a device, a field, a shape, a renderer, a procedure, a question, a
// channel, a score and a finding, each in a file of its own.
#include "own.h"

#include "experiments/command/line/whole_command.h"

int main(int argc, char** argv) {
  return haptrial::experiments::whole_command(argc, argv, own::add_all);
}
