#include "analysis/exchange/export_bids.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "analysis/exchange/bids_motion.h"
#include "analysis/exchange/bids_pages.h"
#include "analysis/exchange/bids_text.h"
#include "analysis/exchange/data_set_sessions.h"
#include "analysis/exchange/sample_text.h"
#include "analysis/files/gzip_file.h"
#include "analysis/files/new_folder.h"
#include "core/record/read/session_reader.h"

namespace haptrial::exchange {
namespace {

namespace fs = std::filesystem;
using bids::Session;

void write_stimuli(const NewFolder& out, const Session& session,
                   const record::SessionReader& reader) {
  std::map<std::int32_t, std::vector<record::StimulusRow>> blocks;
  for (const auto& row : reader.stimuli()) {
    blocks[row.block].push_back(row);
  }
  for (const auto& [block, rows] : blocks) {
    GzipFile file(out.place("stimuli/" + session.stimulus(block)));
    file.write(stimulus_text(rows, Delimited::kTsv));
    file.close();
  }
}

/// Each channel is a continuous recording of its own. One that gave events alone has no rate and
/// stays out.
void write_channel_recordings(const NewFolder& out, const Session& session,
                              const record::SessionReader& reader, const WrittenSamples& samples) {
  for (const analysis::ChannelQuality& channel : analysis::channel_quality(reader)) {
    if (channel.rate() <= 0.0) {
      continue;
    }
    const auto table = reader.description("channel_" + channel.name);
    const std::string stem = fmt::format("{}/beh/{}_recording-{}_physio", session.folder(),
                                         session.stem(), bids_label(channel.name));
    GzipFile file(out.place(stem + ".tsv.gz"));
    write_channel(reader, *table, Delimited::kTsv, &samples, file);
    file.close();
    out.write(stem + ".json", bids::channel_sidecar(session, *table, channel, samples));
  }
}

WrittenSamples write_session(const NewFolder& out, const Session& session,
                             const std::vector<ColumnDoc>& columns, const DataSetOptions& options,
                             Counter& counter) {
  const record::SessionReader reader(session.source.file);
  const std::string stem = session.folder() + "/beh/" + session.stem();
  write_stimuli(out, session, reader);
  GzipFile file(out.place(stem + "_physio.tsv.gz"));
  WrittenSamples samples = write_samples(reader, Delimited::kTsv, file, counter);
  file.close();
  out.write(stem + "_physio.json", bids::recording_sidecar(session, samples));
  write_channel_recordings(out, session, reader, samples);
  const std::string events = bids::events_table(session, reader, samples, columns);
  out.write(stem + "_events.tsv", events);
  const bool moves = options.motion > 0.0 && samples.ticks > 0;
  if (moves) {
    bids::write_motion(out, session, reader, options.motion, events);
  }
  const std::string prefix = session.session.empty() ? "" : "_" + session.session;
  out.write(fmt::format("{}/{}{}_scans.tsv", session.folder(), session.subject, prefix),
            bids::scans_table(session, moves ? bids::motion_file(session) : std::string()));
  return samples;
}

void write_whole(const NewFolder& out, std::span<const Session> sessions,
                 const std::vector<ColumnDoc>& columns, const DataSetOptions& options) {
  const auto& first = sessions.front();
  out.write("dataset_description.json", bids::dataset_description(sessions, options));
  out.write("README", bids::readme(sessions, options.motion));
  out.write("participants.tsv", bids::participants_table(sessions));
  out.write("participants.json", bids::participants_sidecar(sessions));
  out.write(fmt::format("task-{}_events.json", first.task), bids::events_sidecar(options, columns));
  for (const bids::Phenotype& page : bids::phenotypes(sessions, Delimited::kTsv)) {
    out.write("phenotype/" + page.name + ".tsv", page.table);
    out.write("phenotype/" + page.name + ".json", bids::sidecar_of(page.columns));
  }
  write_definitions(out, sessions, "code");
  if (first.session.empty()) {
    return;
  }
  for (auto at = sessions.begin(); at != sessions.end();) {
    const auto end = std::find_if(at, sessions.end(),
                                  [&](const Session& s) { return s.subject != at->subject; });
    out.write(fmt::format("{0}/{0}_sessions.tsv", at->subject),
              bids::sessions_table(std::span(at, end)));
    at = end;
  }
}

}  // namespace

BidsSummary export_bids(std::span<const fs::path> files, const fs::path& folder,
                        const DataSetOptions& options, const Watch& watch) {
  const std::vector<Session> sessions = data_set_sessions(files, options.compare);
  for (const Session& session : sessions) {
    refuse_imported(session.source, "--bids");
  }
  NewFolder out(folder);
  const std::vector<ColumnDoc> columns = fact_columns(sessions);
  write_whole(out, sessions, columns, options);
  std::vector<WrittenSamples> written(sessions.size());
  share_out(
      sessions.size(), options.jobs,
      [&](std::size_t i, Counter& counter) {
        written[i] = write_session(out, sessions[i], columns, options, counter);
      },
      watch);
  out.publish();
  BidsSummary summary;
  summary.sessions = sessions.size();
  std::set<std::string> subjects;
  for (std::size_t i = 0; i < sessions.size(); ++i) {
    subjects.insert(sessions[i].subject);
    summary.samples += written[i].ticks - written[i].missing;
    summary.missing += written[i].missing;
    summary.simulated = summary.simulated || sessions[i].source.info.simulated;
  }
  summary.subjects = subjects.size();
  return summary;
}

}  // namespace haptrial::exchange
