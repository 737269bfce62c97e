#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/document/figure.h"
#include "analysis/psychophysics/study/trials_result.h"

namespace haptrial::analysis::trials {

/// Colour, dash and shape of the n-th condition or track.
Look look_of(std::size_t index);
/// Letters, digits, '-' and '_' of a name, for a file.
std::string file_word(const std::string& name);
/// A figure of the study, marked where participants are simulated.
Figure new_figure(const TrialsResult& result, std::string name, std::string title,
                  std::string x_label, std::string y_label);
/// "level (N/m)".
std::string level_label(const TrialsResult& result);

/// Number of participants who have figures of their own; a study of more is looked at whole.
inline constexpr std::size_t kMostDrawn = 500;
std::span<const ParticipantTrials> drawn_participants(const TrialsResult& result);

/// The tracks of the same name side by side, a panel for each participant: "panel-TRACK", several
/// where there are many participants. None where a participant is alone.
std::vector<Figure> panel_figures(const TrialsResult& result);
/// Levels of each participant's tracks over the trials, with reversals: "tracks-P01".
std::vector<Figure> track_figures(const TrialsResult& result);
/// Each participant's functions with data and band: "function-P01".
std::vector<Figure> function_figures(const TrialsResult& result);
/// Weights and standard deviations of two cues, observed and predicted: "cues-weights",
/// "cues-deviations".
std::vector<Figure> cue_figures(const TrialsResult& result);

/// Learning curves, and speeds and paths of the first and last cycle of each block:
/// "learning-curve", "force-compensation", "speed-profiles", "trajectories-BLOCK".
std::vector<Figure> reaching_pictures(const TrialsResult& result);

/// All of them, as far as there is something to draw.
std::vector<Figure> trials_figures(const TrialsResult& result);

}  // namespace haptrial::analysis::trials
