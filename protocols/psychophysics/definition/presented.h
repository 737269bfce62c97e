#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/scene/field.h"
#include "core/scene/read/shape_kinds.h"
#include "protocols/psychophysics/definition/cursor_parameters.h"
#include "protocols/psychophysics/definition/measure.h"
#include "protocols/psychophysics/definition/moving_target.h"
#include "protocols/psychophysics/definition/names.h"
#include "protocols/psychophysics/definition/read_stages.h"
#include "protocols/psychophysics/definition/trials_definition.h"
#include "protocols/psychophysics/objects/look.h"

namespace haptrial {
class RandomStream;
}

namespace haptrial::protocols {

/// Content of an interval once every name has a value.
struct Presented {
  std::vector<scene::Field> fields;
  std::vector<std::uint64_t> felt;  // (devices) the fields that act on each, a bit each
  std::vector<scene::Region> regions;
  std::vector<std::size_t> region_devices;  // (regions) whose tool it is asked of, from 0
  std::vector<bool> of_cursor;              // (regions) it is asked of the cursor
  std::vector<Look> looks;
  std::vector<NamedStage> stages;
  std::optional<CursorParameters> cursor;
  std::vector<MovingTarget> targets;
  std::vector<Measure> measures;
  std::vector<sound::Cue> varied_cues;  // those of the definition's that vary, in their order
};

/// Content of an interval with the values that the names have. Problems are noted.
/// @param random  for durations; null: the shortest
Presented read_presented(Table& root, const Names& names, const TrialsDefinition& definition,
                         RandomStream* random);

}  // namespace haptrial::protocols
