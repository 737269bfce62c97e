#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/definition/schema.h"
#include "core/psychometric/procedure/quest_plus.h"
#include "core/psychometric/procedure/shuffled.h"

namespace haptrial::psychometric {

struct Track;
struct TrackKeys;

// Each reads the keys of a kind of procedure (docs/keys.md). Problems are noted.

void read_staircase(const TrackKeys& keys, Track& track);
void read_limits(const TrackKeys& keys, Track& track);
void read_pest(const TrackKeys& keys, Track& track);
void read_psi(const TrackKeys& keys, Track& track);
/// A QUEST+ over any number of dimensions.
void read_quest(const TrackKeys& keys, Track& track);
/// A threshold surface (threshold_surface.h).
void read_surface(const TrackKeys& keys, Track& track);
/// Constant stimuli.
void read_constant(const TrackKeys& keys, Track& track);
/// A magnitude estimation.
void read_magnitude(const TrackKeys& keys, Track& track);
/// An adjustment by steps that get finer, from starts of either side.
void read_adjustment(const TrackKeys& keys, Track& track);

// Parts that several of them share.

/// Order of levels, or starts, that stand in a list: [repetitions], [in_rounds].
const Schema<ListParameters>& list_schema();

/// Description of `function`, which psi and QUEST+ have.
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

/// Sentences on a psi or QUEST+ that can be presented and yet tells nothing: parameters that no
/// answer can change, thresholds that no level reaches, levels that tell no parameters apart.
std::vector<std::string> quest_warnings(const Track& track, const QuestTables& tables);

}  // namespace haptrial::psychometric
