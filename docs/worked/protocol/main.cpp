// The command haptrial with one protocol more.
#include "experiments/command/keys/key_list.h"
#include "experiments/command/line/whole_command.h"
#include "experiments/studies/registry.h"
#include "springs.h"

int main(int argc, char** argv) {
  using namespace haptrial::experiments;
  return whole_command(argc, argv, [] {
    add_study(springs());
    add_key_words(
        "springs.standard | | stiffness of the spring that others are compared with\n"
        "springs.difference | | by how much the other spring is stiffer in the first trial\n"
        "springs.factor | | the difference is divided or multiplied by it\n"
        "springs.interval | | how long each spring is felt");
  });
}
