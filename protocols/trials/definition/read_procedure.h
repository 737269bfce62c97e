#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/table.h"
#include "core/psychometric/function/axis.h"

namespace haptrial::protocols {

struct Track;

/// Where a track finds its keys: in its own table, or else in that of its procedure.
struct TrackKeys {
  Table& track;
  Table& procedure;

  bool has(std::string_view key) const { return track.has(key) || procedure.has(key); }
  Table& of(std::string_view key) const { return track.has(key) ? track : procedure; }
};

/// The words of `kind`.
const std::vector<std::string>& procedure_kinds();

/// Reads `scale` and `origin` of the steps or the function of a track whose range is known.
psychometric::Axis read_axis(const TrackKeys& keys, const Track& track);

/// Reads what the kind of a track asks for, and how it begins (track.h). Problems are noted.
void read_procedure(const TrackKeys& keys, Track& track);

}  // namespace haptrial::protocols
