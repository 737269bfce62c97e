#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/exchange/columns.h"
#include "analysis/exchange/export_sessions.h"
#include "analysis/exchange/sample_text.h"
#include "analysis/quality/channel_quality.h"
#include "core/record/table/table_description.h"

namespace haptrial::exchange {

/// The letters and digits of a name, which is all that a label of the data set may have.
std::string bids_label(std::string_view text);

}  // namespace haptrial::exchange

// The texts of a BIDS data set; for export_bids.cpp only.
namespace haptrial::exchange::bids {

/// A session and the names that it has in the data set.
struct Session {
  ExportSession source;
  std::string subject;  // "sub-S01"
  std::string session;  // "ses-2"; empty where every subject has one
  std::string task;     // "forcetraining"

  std::string folder() const;                      // "sub-S01/ses-2"
  std::string stem() const;                        // "sub-S01_ses-2_task-forcetraining"
  std::string stimulus(std::int32_t block) const;  // below stimuli/
};

/// Whether a participant of any session is virtual.
bool any_simulated(std::span<const Session> sessions);

std::string dataset_description(std::span<const Session> sessions, const DataSetOptions& options);
/// @param motion  rate of the movement beside the recording [Hz]; 0: there is none
std::string readme(std::span<const Session> sessions, double motion);

std::string participants_table(std::span<const Session> sessions);
std::string participants_sidecar(std::span<const Session> sessions);
/// One row for each session of a subject.
std::string sessions_table(std::span<const Session> of_subject);
/// @param motion  recording of the movement, below the session's folder; empty: there is none
std::string scans_table(const Session& session, const std::string& motion);

/// One row for each pass and each event, by time. @param columns  of pass_facts(), of all sessions
std::string events_table(const Session& session, const record::SessionReader& reader,
                         const WrittenSamples& samples, const std::vector<ColumnDoc>& columns);
std::string events_sidecar(const DataSetOptions& options, const std::vector<ColumnDoc>& columns);
/// The description of a table's columns as JSON.
std::string sidecar_of(const std::vector<ColumnDoc>& docs);
/// The description of the task that every recording's sidecar has, as JSON.
std::string described_task(const Session& session);
std::string recording_sidecar(const Session& session, const WrittenSamples& samples);
/// The sidecar of a channel's recording, whose samples have their times. @param samples  by whose
/// even clock the onsets of samples are
std::string channel_sidecar(const Session& session, const record::TableDescription& table,
                            const analysis::ChannelQuality& channel, const WrittenSamples& samples);

}  // namespace haptrial::exchange::bids
