#pragma once

#include <functional>
#include <string>

#include "analysis/psychophysics/data/trials_data.h"

namespace haptrial::analysis::trials {

/// A tidy table with a row for every pass, practice and aborted ones too: `counted` is 1 for what
/// the analysis takes. Columns: who, which trial, its level (track, variable, asked, applied,
/// outcome), of each question its value, text (.text), correctness (.correct) and reaction time
/// (.rt), each variable (NAME, or NAME.INTERVAL where intervals differ), and the duration of each
/// stage (STAGE.INTERVAL.s). Times in seconds; what is not known is empty.
/// @param take  given the text piece by piece: that of thousands of sessions is larger than they
void trials_csv(const TrialsData& data, const std::function<void(const std::string&)>& take);

}  // namespace haptrial::analysis::trials
