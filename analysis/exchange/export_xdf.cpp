#include "analysis/exchange/export_xdf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <variant>
#include <vector>

#include "analysis/exchange/columns.h"
#include "analysis/exchange/other_devices.h"
#include "analysis/exchange/pass_facts.h"
#include "analysis/exchange/sample_text.h"
#include "analysis/files/new_folder.h"
#include "analysis/files/xdf_file.h"
#include "analysis/quality/channel_quality.h"
#include "core/channel/channel_row.h"
#include "core/record/read/session_reader.h"
#include "core/record/read/tick_rows.h"

namespace haptrial::exchange {
namespace {

namespace fs = std::filesystem;
using record::SessionReader;

constexpr std::uint64_t kRowsAtOnce = 32768;  // rows read at a time

double seconds(std::int64_t time_ns) { return 1e-9 * static_cast<double>(time_ns); }

std::vector<std::pair<std::string, std::string>> about(const record::SessionInfo& info) {
  return {{"subject", info.subject},
          {"session", std::to_string(info.session)},
          {"experiment", experiment_name(info)},
          {"device", info.device},
          {"simulated", truth(info.simulated)},
          {"pilot", truth(info.pilot)},
          {"datetime", info.start_utc},
          {"program", fmt::format("haptrial {} ({})", info.program_version, info.program_commit)}};
}

/// The nominal rate of the ticks; 0 where more than one in a hundred lies a period or more beside
/// it, as all do after missing ticks and suspensions: readers space the samples of a stream with a
/// rate evenly over such gaps. A tick that is late alone moves nothing.
double even_rate(const SessionReader& reader) {
  constexpr double kMost = 0.01;
  const double rate = reader.info().rate;
  double first = 0.0;
  std::uint64_t ticks = 0, beside = 0;
  record::each_sample(reader, [&](const record::Sample& sample) {
    const double time = seconds(sample.time_ns);
    first = ticks == 0 ? time : first;
    beside += std::abs(time - first - static_cast<double>(ticks) / rate) >= 1.0 / rate ? 1 : 0;
    ++ticks;
  });
  return static_cast<double>(beside) <= kMost * static_cast<double>(ticks) ? rate : 0.0;
}

XdfStream device_stream(const ExportSession& session, double rate) {
  XdfStream stream{"device", "Haptics", XdfFormat::kFloat32, rate, {}};
  stream.description =
      fmt::format("{}every tick of the loop; {}",
                  session.info.simulated ? "SIMULATED PARTICIPANT: " : "", axes_of(session));
  for (const ColumnDoc& doc : sample_docs()) {
    if (doc.name != "sequence" && doc.name != "time") {
      stream.channels.push_back({doc.name, doc.unit});
    }
  }
  return stream;
}

std::vector<double> values_of(const record::Sample& s) {
  std::vector<double> values{static_cast<double>(s.pass), static_cast<double>(s.stage)};
  for (const Eigen::Vector3d& vector : {s.position, s.velocity, s.force}) {
    values.insert(values.end(), vector.begin(), vector.end());
  }
  values.insert(values.end(), {s.applied_force, s.target_force, s.saturated ? 1.0 : 0.0});
  return values;
}

/// The stream of a device after the first. @param number  as in /devices
XdfStream other_stream(const ExportSession& session, std::size_t number, double rate) {
  XdfStream stream = device_stream(session, rate);
  stream.name = fmt::format("device_{}", number);
  stream.channels.clear();
  for (const ColumnDoc& doc : docs_of(record::table_of<record::DeviceRow>())) {
    if (doc.name != "sequence" && doc.name != "device") {
      stream.channels.push_back({doc.name, doc.unit});
    }
  }
  return stream;
}

std::vector<double> values_of(const record::DeviceRow& row) {
  std::vector<double> values;
  for (const Eigen::Vector3d& vector : {row.position, row.velocity, row.force}) {
    values.insert(values.end(), vector.begin(), vector.end());
  }
  values.push_back(static_cast<double>(row.buttons));
  return values;
}

/// Writes every tick of every device. @param stream  of the first device; those of the others
/// follow it.
void write_devices(const SessionReader& reader, XdfFile& file, std::uint32_t stream,
                   OtherDevices& others, Counter& counter) {
  const std::uint64_t rows = reader.sample_count();
  for (std::uint64_t row = 0; row < rows; row += kRowsAtOnce) {
    const std::uint64_t count = std::min(kRowsAtOnce, rows - row);
    for (const record::Sample& sample : reader.samples(row, count)) {
      file.add(stream, seconds(sample.time_ns), values_of(sample));
      for (const record::DeviceRow& other : others.at_tick(sample.sequence)) {
        file.add(stream + static_cast<std::uint32_t>(other.device), seconds(sample.time_ns),
                 values_of(other));
      }
    }
    counter.add(count);
    counter.check();
  }
}

/// A pass as JSON, with what it presented and what was answered.
std::string pass_text(const record::PassRow& pass, std::size_t index, const char* status,
                      double duration, const std::map<std::string, std::string>& facts) {
  nlohmann::ordered_json json;
  json["pass"] = index;
  json["trial"] = pass.trial;
  json["trial_type"] = pass.condition;
  json["phase"] = record::name_of(pass.phase);
  json["block"] = pass.block;
  json["attempt"] = pass.attempt;
  json["practice"] = pass.practice;
  json["status"] = status;
  json["duration"] = duration;
  for (const auto& [name, value] : facts) {
    json[name] = value;
  }
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

void write_pass_markers(const SessionReader& reader, XdfFile& file, std::uint32_t stream) {
  const PassFacts facts = pass_facts(reader);
  const std::vector<record::PassRow> passes = reader.passes();
  const std::vector<const char*> statuses = pass_statuses(reader);
  const std::vector<PassSpan> spans = pass_spans(reader);
  for (std::size_t i = 0; i < passes.size(); ++i) {
    file.add(stream, spans.at(i).onset,
             pass_text(passes[i], i, statuses[i], spans[i].duration, facts.cells[i]));
  }
}

/// The events of a session and what befell its channels.
std::vector<record::EventRow> all_events(const SessionReader& reader) {
  std::vector<record::EventRow> events = reader.events();
  const std::vector<record::EventRow> more = channel_events(reader, false);
  events.insert(events.end(), more.begin(), more.end());
  return events;
}

void write_events(std::vector<record::EventRow> events, XdfFile& file, std::uint32_t stream) {
  std::ranges::stable_sort(events, {}, &record::EventRow::time_ns);
  for (const record::EventRow& event : events) {
    file.add(stream, seconds(event.time_ns),
             event.text.empty() ? event.kind : event.kind + ": " + event.text);
  }
}

double number_of(const record::Cell& cell) {
  return std::visit(
      [](const auto& value) {
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) {
          return static_cast<double>(value);
        } else {
          return std::numeric_limits<double>::quiet_NaN();
        }
      },
      cell);
}

/// The texts that a channel gave, each at its time.
void write_messages(const SessionReader& reader, const analysis::ChannelQuality& channel,
                    XdfFile& file) {
  const std::string name = channel.samples > 0 ? channel.name + "_messages" : channel.name;
  const std::uint32_t stream =
      file.add_stream({name, "Markers", XdfFormat::kString, 0.0, {{"message", ""}}});
  std::vector<channel::IncidentRow> rows = analysis::channel_incidents(reader);
  std::ranges::stable_sort(rows, {}, &channel::IncidentRow::time_ns);
  for (const channel::IncidentRow& row : rows) {
    if (row.what == channel::Incident::kMessage && row.channel == channel.name) {
      file.add(stream, seconds(row.time_ns), row.text);
    }
  }
}

/// One channel as a stream: all columns of its table but the time. It has no rate: an instrument
/// keeps none, and each sample has its time.
void write_channel_stream(const SessionReader& reader, const analysis::ChannelQuality& channel,
                          XdfFile& file) {
  const auto table = reader.description("channel_" + channel.name);
  XdfStream stream{channel.name, "Channel", XdfFormat::kDouble64, 0.0, {}};
  std::size_t time_column = 0, column = 0;
  for (const ColumnDoc& doc : docs_of(*table)) {
    if (doc.name == "time_ns") {
      time_column = column;
    } else {
      stream.channels.push_back({doc.name, doc.unit});
    }
    ++column;
  }
  const std::uint32_t number = file.add_stream(stream);
  std::vector<double> values;
  reader.each_row(*table, [&](const std::vector<record::Cell>& cells) {
    values.clear();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (i != time_column) {
        values.push_back(number_of(cells[i]));
      }
    }
    file.add(number, 1e-9 * number_of(cells[time_column]), values);
  });
}

/// Streams without samples are left out: some readers fail on them.
/// @returns how many streams the file has
std::size_t write_xdf(const fs::path& path, const ExportSession& session, Counter& counter) {
  const SessionReader reader(session.file);
  XdfFile file(path, about(session.info));
  std::size_t streams = 0;
  if (reader.sample_count() > 0) {
    OtherDevices others(reader);
    const double rate = even_rate(reader);
    const std::uint32_t first = file.add_stream(device_stream(session, rate));
    for (std::size_t number = 1; number <= others.count(); ++number) {
      file.add_stream(other_stream(session, number, rate));
    }
    streams += 1 + others.count();
    write_devices(reader, file, first, others, counter);
  }
  if (reader.sample_count() > 0 && !reader.passes().empty()) {
    ++streams;
    write_pass_markers(reader, file,
                       file.add_stream({"passes",
                                        "Markers",
                                        XdfFormat::kString,
                                        0.0,
                                        {{"pass", ""}},
                                        "a pass as JSON, as it began"}));
  }
  if (const std::vector<record::EventRow> events = all_events(reader); !events.empty()) {
    ++streams;
    write_events(events, file,
                 file.add_stream({"events", "Markers", XdfFormat::kString, 0.0, {{"event", ""}}}));
  }
  for (const analysis::ChannelQuality& channel : analysis::channel_quality(reader)) {
    if (channel.samples > 0) {
      ++streams;
      write_channel_stream(reader, channel, file);
    }
    if (channel.messages > 0) {
      ++streams;
      write_messages(reader, channel, file);
    }
  }
  file.close();
  return streams;
}

std::string xdf_name(const ExportSession& session) {
  return session.of > 1 ? fmt::format("{}-session-{}.xdf", session.info.subject, session.number)
                        : session.info.subject + ".xdf";
}

}  // namespace

XdfSummary export_xdf(std::span<const fs::path> files, const fs::path& folder, int jobs,
                      const Watch& watch) {
  const std::vector<ExportSession> sessions = sessions_to_export(files);
  for (const ExportSession& session : sessions) {
    refuse_imported(session, "--xdf");
  }
  NewFolder out(folder);
  std::vector<std::size_t> streams(sessions.size());
  share_out(
      sessions.size(), jobs,
      [&](std::size_t i, Counter& counter) {
        streams[i] = write_xdf(out.place(xdf_name(sessions[i])), sessions[i], counter);
      },
      watch);
  out.publish();
  return {sessions.size(), std::accumulate(streams.begin(), streams.end(), std::size_t{0}),
          total_samples(sessions)};
}

}  // namespace haptrial::exchange
