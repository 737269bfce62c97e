#include "core/psychometric/definition/read_tracks.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <stdexcept>

#include "core/base/definition/schema.h"
#include "core/psychometric/definition/expectation.h"
#include "core/psychometric/definition/procedure_kinds.h"

namespace haptrial::psychometric {
namespace {

constexpr std::size_t kMostTracks = 64;

bool sets_one_variable(const Track& track) {
  return kind_of_procedure(track.kind).sets_one_variable();
}

void read_kind(Table& table, const std::string& key, Track& track) {
  std::vector<std::string> words;
  for (const ProcedureKind& kind : kinds_of_procedure()) {
    words.push_back(kind.word);
  }
  track.kind = table.choice(key, words);
  if (std::ranges::find(words, table.whole_text(key).value_or("")) == words.end()) {
    table.check();  // the other keys are those of another kind
  }
}

/// Keys of a track, and of the procedure that it belongs to.
const Schema<Track>& track_schema() {
  using T = Track;
  static const auto schema =
      Schema<T>()
          .custom("kind", "Kind of the procedure: the rule by which levels follow from outcomes",
                  read_kind)
          .required()
          .otherwise(kProceduresOwn)
          .text("variable", &T::variable, "Name of the variable whose levels the procedure sets")
          .required()
          .otherwise(kProceduresOwn)
          .only_if(sets_one_variable)
          .text("unit", &T::unit, "Unit of the levels, as reports show it")
          .otherwise("none")
          .texts("by", &T::by, "Factors whose every combination of levels has a track of its own")
          .otherwise("none")
          .text("counts", &T::counts, "Formula of the outcome that the procedure learns from")
          .otherwise("whether the first answer was right")
          .custom("resolution", "Number to whose multiples levels are rounded",
                  [](Table& table, const std::string& key, T& track) {
                    track.resolution = table.number(key, kPositive, track.unit);
                  })
          .otherwise("not rounded")
          .only_if(sets_one_variable);
  return schema;
}

/// Keys that a track does not take from its procedure.
const Schema<Track>& track_name_schema() {
  static const auto schema =
      Schema<Track>()
          .text("name", &Track::name, "Name of the track, in files and reports")
          .otherwise("track 1, track 2, ...");
  return schema;
}

/// Rounding must leave a level in the range, and must not take back the smallest step.
void check_resolution(const TrackKeys& keys, const Track& track) {
  if (track.resolution == 0.0 || !track.range_known || !(track.low <= track.high)) {
    return;
  }
  Table& table = keys.of("resolution");
  const std::string found = fmt::format("{:g}", track.resolution);
  if (!has_multiple(track.low, track.high, track.resolution)) {
    table.reject(
        "resolution", found,
        fmt::format("one with a multiple in the range, {:g} to {:g}", track.low, track.high));
    return;
  }
  const std::optional<double> change = track.smallest_change();
  if (change && !(track.resolution < 2.0 * *change)) {
    table.reject("resolution", found,
                 fmt::format("less than {:g}, twice the smallest step within the range, which "
                             "rounding would take back",
                             2.0 * *change));
  }
}

Track read_track(Table& procedure, Table& own, std::size_t number) {
  Track track;
  track.name = fmt::format("track {}", number);
  track_name_schema().read(own, track);
  track_schema().read(own, procedure, track);
  const TrackKeys keys{own, procedure};
  const ProcedureKind& kind = kind_of_procedure(track.kind);
  track.learns_from = kind.learns;
  kind.read(keys, track);
  if (kind.sets_one_variable() && keys.has("expect")) {
    track.expected = read_expectation(keys.of("expect"), track.axis);
  }
  if (kind.sets_one_variable()) {
    check_resolution(keys, track);
  }
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
    std::size_t procedure = 0;
    for (Table& table : root.tables("procedures")) {
      const std::size_t before = tracks.size();
      read_all(table, tracks);
      for (Track& track : std::span(tracks).subspan(before)) {
        track.procedure = procedure;
      }
      ++procedure;
    }
  }
  if (tracks.size() > kMostTracks) {
    root.reject("procedures", fmt::format("{} tracks", tracks.size()),
                fmt::format("at most {}", kMostTracks));
  }
  return tracks;
}

}  // namespace haptrial::psychometric
