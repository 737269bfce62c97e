#pragma once

#include <memory>
#include <vector>

#include "core/psychometric/procedure/quest_plus.h"

namespace haptrial::psychometric {

struct Track;
struct TrackKeys;

/// Description of `function`, which psi has, too.
inline constexpr const char* kFunctionText = "Sigmoid of the psychometric function, by its name";
inline constexpr const char* kFunctionAbsent = "logistic, or of quest_plus a probability";

/// Reads `stimulus`, the variables that a track sets, with their levels. Problems are noted.
std::vector<QuestDimension> read_stimulus(const TrackKeys& keys, Track& track);

/// Reads `stop` of psi or QUEST+.
QuestStop read_quest_stop(const TrackKeys& keys, Track& track);

/// Begins a track with these tables, its own or those of psi. An entropy of `stop` that ends it
/// before its first trial is noted.
void begin_with(const TrackKeys& keys, const std::shared_ptr<const QuestTables>& tables,
                const QuestStop& stop, Track& track);

/// Reads a QUEST+ over any number of dimensions. Keys in brackets are optional; grids are lists or
/// { from, to, count, [spacing] }, or { values = [...] } with the keys that follow them.
///
///     stimulus     VARIABLE = grid, [resolution]: what it sets; the first one is the track's
///     parameters   NAME = grid, [prior], [nuisance]: what it asks about; prior = weights of the
///                  values, or { mean, sd } of a normal distribution
///     probability  formula of both, of the answer 1; or of the answers 1, 2, …, a list: the
///                  answer 0 has what is left
///     or function  a sigmoid of one stimulus with the parameters threshold, width, [guess = 0.5],
///                  [lapse = 0], as psi has them, with [scale] and [origin]
///     stop         { trials, [entropy] }
///
/// Problems are noted.
void read_quest(const TrackKeys& keys, Track& track);

}  // namespace haptrial::psychometric
