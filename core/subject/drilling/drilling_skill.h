#pragma once

#include <cstdint>

namespace haptrial::subject {

/// How a virtual surgeon of one skill works. Every field is a line from a novice's value (skill 0)
/// to an expert's (skill 1). Which of them are published and which assumed:
/// docs/algorithms/virtual-surgeon.md.
struct DrillingSkill {
  double near_force;     // pressed close to a structure > 0 [N]
  double far_force;      // and far from any [N]
  double near_distance;  // up to here it is close > 0 [m]
  double far_distance;   // from here on far > near_distance [m]
  double stroke_rate;    // far from structures [1/s]
  double near_pace;      // share of that rate close to a structure > 0
  double stroke_length;  // [m]
  double pause;          // between bouts of strokes [s]
  double force_noise;    // share of the press
  double tremor;         // [N]
  double misjudgement;   // spread of where structures are believed, along each axis [m]
  double extra_margin;   // of bone that it leaves beyond what is asked for [m]
  double region_error;   // spread of where the cavity is begun, along each axis [m]
  double saucer;         // share of the cavity's slope that is kept
  double evenness;       // 0 digs on where it is; 1 takes the highest bone first
  double bite;           // goes so much deeper than where a bout begins [m]
  double undercut;       // share of bouts that go under an edge
  double looking;        // share of occasions on which the view is mended
  double look_error;     // of the direction from which it is seen [rad]
  double careful;        // chance to take the small burr for what is near a structure
  double completeness;   // share of what is to go after which it is enough
};

/// @param skill  0 to 1
DrillingSkill drilling_skill(double skill) noexcept;

/// A participant's skill in a procedure: the participant's own, from the group's, a little of the
/// day's, and in later procedures a share of what is still to be learnt.
struct SkillSpread {
  double between{0.08};   // standard deviation between participants of a group >= 0
  double within{0.04};    // between procedures of one participant >= 0
  double learning{0.08};  // share of the way to 1 from one procedure to the next, 0 to 1
};
/// @param procedure  from 0. The participant's part follows from the seed alone.
double skill_in(double group_skill, const SkillSpread& spread, std::uint64_t participant_seed,
                int procedure);

}  // namespace haptrial::subject
