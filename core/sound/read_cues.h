#pragma once

#include "core/base/definition/schema_forward.h"
#include "core/sound/cue.h"

namespace haptrial::sound {

/// Reads a [sounds] table. Problems are noted in the table; keys in brackets are optional.
///
///     [device]        ALSA's name of the sound card ("default")
///     [sounds.NAME]   type = "tone": frequency [Hz], duration [s], level [dB], [rise] (0.005 s)
///                     type = "noise": duration, level, [rise], [colour], [low], [high]
///                     type = "click": level, [duration] (0.001 s)
///                     type = "file": file (48,000 samples a second), [level] (0)
///     [sounds.masking]  level, [colour] ("pink"), [low], [high], [fade] (0.5 s), [stages]
///
/// colour is "white", "pink" (both from 20 to 20,000 Hz) or "band" (needs low and high).
///
/// A sound with `actuator`, the name of one of them, is a vibration: `amplitude` in the actuator's
/// unit stands for level.
///
/// A sound with a text where a number is expected varies between trials. It is left to
/// read_varied_cues(), which must read the same document.
CueSet read_cues(Table& table, std::vector<Actuator> actuators = {});

/// The sounds of the set that vary, in their order, with the numbers that their formulas have now.
/// @param table  [sounds], whose texts stand for numbers (Table::with). Problems are noted in it
std::vector<Cue> read_varied_cues(Table& table, const CueSet& set);

/// The names of the sounds in the order of CueSet::cues, without reading them.
std::vector<std::string> cue_names(const Table& table);

}  // namespace haptrial::sound
