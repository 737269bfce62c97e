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
trials:analysis.kind | as the procedure is | what is computed
trials:analysis.by | all factors; of detection, identification and reaching none | factors whose levels are told apart
trials:analysis.tests | none | planned: "a < b", "a > b" or "a != b" of levels
trials:analysis.question | the first | whose answer counts
trials:analysis.yes | what the procedure learnt, else the right one | the answer that counts 1
trials:analysis.level | the one that the procedure set | variable for the level
trials:analysis.rating | the second question | question of how sure the participant was
trials:analysis.stimulus | the first factor | factor that says what was presented, of an identification
trials:analysis.function | norm; neg_norm with right_raises | sigmoid that is fitted; with neg_ before its name it falls
trials:analysis.scale | of the procedure | of the axis
trials:analysis.origin | of the procedure | of the axis
trials:analysis.guess | 1 / choices, else free | guess rate, "free" (at most 0.2; with catch trials 0.5), or "lapse" for the lapse rate
trials:analysis.lapse | { free = true, at_most = 0.2 } | lapse rate, or how it is fitted
trials:analysis.lapse.free | true | whether it is fitted
trials:analysis.lapse.at_most | 0.2; 0.06 if guess is "lapse" | its upper bound
trials:analysis.threshold_at | halfway from the guess rate to 1; 0.5 if that is free | share of answers 1 at the threshold, lapses aside
trials:analysis.reference | no Weber fractions | standard stimulus
trials:analysis.bayesian | true | whether the Bayesian fit is added
trials:analysis.resamples | 1999 | of the bootstrap
trials:analysis.cue_combination.first.NAME | | level of a factor in conditions with the first cue alone
trials:analysis.cue_combination.second.NAME | | level of a factor in conditions with the second cue alone
trials:analysis.cue_combination.both.NAME | | level of a factor in conditions with both cues
trials:analysis.cue_combination.at | none | factor that changes how reliable the first cue is
trials:analysis.cue_combination.conflict | | factor by which the cues of the standard disagree
trials:analysis.cue_combination.standard | | interval whose cues disagree
trials:analysis.cue_combination.first_shows | | variable of that interval that the first cue shows
trials:analysis.cue_combination.second_shows | | variable of that interval that the second cue shows
trials:analysis.stage | reach | of the reach
trials:analysis.start | start | place where reaches begin
trials:analysis.target | target | place where they end
trials:analysis.field | the first of type matrix_viscous | field that is learnt
trials:analysis.clamp | clamp | probe whose reaches a channel holds
trials:analysis.cycle | combinations of the factors | trials of a cycle
trials:analysis.error | maximum | error of a reach that is learnt from
trials:analysis.quantities | ["error"] | of reaches, compared between the conditions of `by`: error, movement_time, peak_speed, direction, area, force_compensation
trials:analysis.cycles | all | cycles of each block that such a comparison takes
analysis.planned | none | planned tests: "a < b", "a > b" or "a != b" of conditions
analysis.reference | the first | condition that the others are compared with
power.definition | this file | definition that a file with [power] alone asks about
power.watch | | name of the test of the report whose power is asked for
power.alpha | | below which p counts
power.target | | power for which participants are counted
power.replications | | studies of each cell
power.null_replications | | studies of each cell without an effect
power.block | | studies of a part
power.seed | | of every random number
power.depth | responses | whether answers alone or full sessions are simulated
power.check.cells | | cells that are also simulated in full
power.check.replications | | studies of each of them
power.responses | nothing is known | what responses need to know (docs/guide-power.md)
power.vary[].key | | key that is varied, with its tables: observer.lapse.median
power.vary[].values | | its values
power.vary[].none | it makes no effect | its value without an effect
)";
}

}  // namespace haptrial::experiments
