#include "experiments/command/start/key_words_internal.h"

namespace haptrial::experiments {

std::string_view key_words() {
  return R"(
display.seen_from | | above: x to the right, z down the screen; front: x to the right, y up
display.extent | | part of the world that fills the screen's width
display.hand_radius | | of the dot of the hand
display.feedback_right | | what is shown after a right answer
display.feedback_wrong | | what is shown after a wrong one
display.feedback_time | | for which it is shown
trials:display.stereo | false | pictures for the left and the right eye side by side
trials:display.eye_distance | 0.063 | between the eyes
display.viewing_distance | 0.5 | from the eyes to the screen
display.sound_right | none | sound after a right answer, where feedback is given
display.sound_wrong | none | sound after a wrong one
devices.NAME.start | | where the hand of a virtual participant begins
design.session.NAME.blocks | | blocks of the session of this number; without [design.session] every session has all of them
groups | one group of everybody | participants of each group, in the order of their numbers: NAME = 8
groups.NAME | | participants of the group, in the order of their numbers
factors.NAME | | levels of a factor: two or more numbers, words or formulas
variables.NAME | | a number, formula or quoted word
variables.NAME.from | | name whose word chooses among the other keys
variables.NAME.NAME | | what the name is worth with this word
places.NAME | | x, y, z: three numbers or formulas
practice.NAME | | what a name is worth during practice
blocks[].NAME | | what a name is worth in the block
blocks[].probe.NAME | | what a name is worth in these trials
intervals.order | as stated | whether they are shuffled in every trial
intervals.NAME.NAME | | what a name is worth in the interval
fields.NAME.device | all devices | device that feels the field
regions.NAME.device | the first device | device whose tool must be in the region
objects.NAME.kind | rigid | whether it gives way to the hand
objects.NAME.cells | | of a body that gives way: along its longest side
objects.NAME.fixed | bottom | its sides that do not move
objects.NAME.felt | all that are not fixed | its sides that can be touched
objects.NAME.seen | yielding | whether it is seen as the hand presses it, or at rest
objects.NAME.grasped | none | of springs: sides that the hand holds, and moves, instead of pressing the body
objects.NAME.record | false | whether every tick of contact is a row of /contacts
objects.NAME.device | every device | whose tool feels it
objects.NAME.shape | needed, or mesh | of the body
objects.NAME.radius | | of the body, of a torus that of the circle in its middle
objects.NAME.mesh | needed, or shape | file beside the definition: .obj, .ply or .stl
objects.NAME.size | | along x, y and z
objects.NAME.length | | along z
objects.NAME.tube | | radius of a torus's tube
)";
}

}  // namespace haptrial::experiments
