#include "core/psychometric/definition/read_tracks.h"

#include <fmt/format.h>

#include <stdexcept>

#include "core/base/definition/table.h"
#include "core/psychometric/definition/grid.h"
#include "core/psychometric/definition/read_procedure.h"

namespace haptrial::psychometric {
namespace {

constexpr std::size_t kMostTracks = 64;

/// Keys of a track, and of the procedure that it belongs to.
void read_common_keys(TrackKeys& keys, Track& track, std::size_t number) {
  track.kind = keys.of("kind").choice("kind", procedure_kinds());
  if (track.kind != "quest_plus") {  // which names several in its stimulus
    track.variable = keys.of("variable").text("variable");
  }
  track.name = keys.track.has("name") ? keys.track.text("name") : fmt::format("track {}", number);
  track.unit = keys.has("unit") ? keys.of("unit").text("unit") : "";
  if (keys.has("by")) {
    track.by = keys.of("by").texts("by");
  }
  if (keys.has("counts")) {
    track.counts = keys.of("counts").text("counts");
  }
  if (track.kind != "quest_plus" && keys.has("resolution")) {
    track.resolution = keys.of("resolution").number("resolution", kPositive, track.unit);
  }
}

Track read_track(Table& procedure, Table& own, std::size_t number) {
  Track track;
  TrackKeys keys{own, procedure};
  read_common_keys(keys, track, number);
  read_procedure(keys, track);
  if (track.begin) {  // a mistake in it is seen now and not in the first session
    try {
      track.begin(0, track.name);
    } catch (const std::invalid_argument& error) {
      own.reject("kind", fmt::format("cannot begin as stated: {}", error.what()));
    }
  }
  return track;
}

void read_all(Table& procedure, std::vector<Track>& tracks) {
  if (!procedure.has("tracks")) {
    tracks.push_back(read_track(procedure, procedure, tracks.size() + 1));
    return;
  }
  for (Table& own : procedure.tables("tracks")) {
    tracks.push_back(read_track(procedure, own, tracks.size() + 1));
  }
}

}  // namespace

std::vector<Track> read_tracks(Table& root) {
  std::vector<Track> tracks;
  if (root.has("procedure")) {
    Table table = root.table("procedure");
    read_all(table, tracks);
  }
  if (root.has("procedures")) {
    for (Table& table : root.tables("procedures")) {
      read_all(table, tracks);
    }
  }
  if (tracks.size() > kMostTracks) {
    root.reject("procedures", fmt::format("{} tracks", tracks.size()),
                fmt::format("at most {}", kMostTracks));
  }
  return tracks;
}

}  // namespace haptrial::psychometric
