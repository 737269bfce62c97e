#include "experiments/command/line/whole_command.h"

int main(int argc, char** argv) { return haptrial::experiments::whole_command(argc, argv); }
