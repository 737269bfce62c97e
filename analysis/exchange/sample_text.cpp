#include "analysis/exchange/sample_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <variant>

#include "analysis/exchange/export_sessions.h"
#include "analysis/exchange/other_devices.h"
#include "analysis/quality/channel_quality.h"
#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "core/record/table/table_description.h"

namespace haptrial::exchange {
namespace {

using record::Sample;
using record::SessionReader;

constexpr std::uint64_t kPiece = 32768;                // rows read at a time
constexpr std::size_t kDeviceColumns = 10;             // of a further device
constexpr std::uint64_t kMostMissing = 1'000'000'000;  // more is damage, not loss

void add_vector(RowText& row, const Eigen::Vector3d& vector) {
  for (const double value : vector) {
    row.add(static_cast<float>(value));  // as the file has it
  }
}

void add_device(RowText& row, const record::DeviceRow& device) {
  add_vector(row, device.position);
  add_vector(row, device.velocity);
  add_vector(row, device.force);
  row.add(device.buttons);
}

void add_sample(RowText& row, const Sample& s, Delimited kind) {
  if (kind == Delimited::kCsv) {
    row.add(s.sequence);
  }
  row.add_seconds(s.time_ns).add(s.pass).add(static_cast<int>(s.stage));
  add_vector(row, s.position);
  add_vector(row, s.velocity);
  add_vector(row, s.force);
  row.add(static_cast<float>(s.applied_force)).add(static_cast<float>(s.target_force));
  row.add(static_cast<int>(s.saturated));
}

/// Turns one session's samples into text.
class Writer {
 public:
  Writer(const SessionReader& reader, Delimited kind, GzipFile& file)
      : reader_(reader), others_(reader), kind_(kind), file_(file) {
    const std::vector<ColumnDoc> columns = sample_docs(others_.count());
    RowText row(missing_, kind);
    for (std::size_t i = 1; i < columns.size(); ++i) {
      row.add_missing();
    }
    row.end();
    if (kind == Delimited::kCsv) {
      file.write(heading(columns, kind));
    }
    result_.other_devices = others_.count();
    result_.runs.resize(reader.passes().size());
  }

  void take(const std::vector<Sample>& samples) {
    text_.clear();
    RowText row(text_, kind_);
    for (const auto& sample : samples) {
      close_gap(sample.sequence);
      add_sample(row, sample, kind_);
      add_others(row, sample.sequence);
      row.end();
      note_run(sample);
      note_shift(sample);
    }
    file_.write(text_);
  }

  WrittenSamples result() { return std::move(result_); }

 private:
  void add_others(RowText& row, std::uint64_t sequence) {
    const auto rows = others_.at_tick(sequence);
    for (std::size_t number = 1; number <= others_.count(); ++number) {
      const auto own =
          std::ranges::find(rows, static_cast<std::int32_t>(number), &record::DeviceRow::device);
      if (own != rows.end()) {
        add_device(row, *own);
        continue;
      }
      for (std::size_t i = 0; i < kDeviceColumns; ++i) {
        row.add_missing();
      }
    }
  }

  void close_gap(std::uint64_t sequence) {
    if (!begun_) {
      begun_ = true;
      result_.first_sequence = next_ = sequence;
    }
    if (sequence < next_ || sequence - next_ > kMostMissing) {
      throw InputError(fmt::format(
          "{}: sequence number {} of /samples follows {}; allowed: ascending ones, with at most "
          "{} ticks missing between them",
          reader_.path().string(), sequence, next_ - 1, kMostMissing));
    }
    result_.missing += sequence - next_;
    for (; next_ < sequence; ++next_) {
      if (kind_ == Delimited::kTsv) {
        text_ += missing_;
        if (text_.size() > GzipFile::kMember) {
          file_.write(text_);
          text_.clear();
        }
      }
    }
    ++next_;
    result_.ticks = next_ - result_.first_sequence;
  }

  void note_shift(const Sample& sample) {
    constexpr std::int64_t kTolerance = 2'000'000;
    const double even = 1e9 * static_cast<double>(sample.sequence) / reader_.info().rate;
    const std::int64_t by = sample.time_ns - std::llround(even);
    const std::int64_t before = result_.shifts.empty() ? 0 : result_.shifts.back().by_ns;
    if (std::abs(by - before) >= kTolerance) {
      result_.shifts.push_back({sample.time_ns, by});
    }
  }

  void note_run(const Sample& sample) {
    if (sample.stage != record::Stage::kRun || sample.pass < 0 ||
        static_cast<std::size_t>(sample.pass) >= result_.runs.size()) {
      return;
    }
    RunSpan& run = result_.runs[static_cast<std::size_t>(sample.pass)];
    if (run.ticks == 0) {
      run.first = sample.sequence;
    }
    run.ticks = sample.sequence - run.first + 1;
  }

  const SessionReader& reader_;
  OtherDevices others_;
  Delimited kind_;
  GzipFile& file_;
  std::string text_;
  std::string missing_;  // a row of a tick that is not there
  std::uint64_t next_{0};
  bool begun_{false};
  WrittenSamples result_;
};

}  // namespace

std::int64_t WrittenSamples::even_time(std::int64_t time_ns) const {
  const auto next = std::upper_bound(
      shifts.begin(), shifts.end(), time_ns,
      [](std::int64_t time, const ClockShift& shift) { return time < shift.time_ns; });
  const std::int64_t by = next == shifts.begin() ? 0 : std::prev(next)->by_ns;
  const std::int64_t even = time_ns - by;
  // A suspended loop had no tick: the time is not after the one that followed.
  return next == shifts.end() ? even : std::min(even, next->time_ns - next->by_ns);
}

WrittenSamples write_samples(const SessionReader& reader, Delimited kind, GzipFile& file,
                             Counter& counter) {
  Writer writer(reader, kind, file);
  const std::uint64_t rows = reader.sample_count();
  for (std::uint64_t row = 0; row < rows; row += kPiece) {
    const std::uint64_t count = std::min(kPiece, rows - row);
    writer.take(reader.samples(row, count));
    counter.add(count);
    counter.check();
  }
  return writer.result();
}

std::string stimulus_text(std::span<const record::StimulusRow> rows, Delimited kind) {
  std::string text = heading(stimulus_docs(), kind);
  RowText row(text, kind);
  for (const auto& s : rows) {
    row.add(s.block).add(s.time).add(s.position.x()).add(s.position.y()).add(s.position.z());
    row.add(s.force).end();
  }
  return text;
}

std::vector<ColumnDoc> docs_of(const record::TableDescription& table) {
  std::vector<ColumnDoc> docs;
  for (const record::Column& column : table.schema().columns) {
    docs.push_back(doc_of(table.schema(), column.name));
  }
  return docs;
}

void write_channel(const record::SessionReader& reader, const record::TableDescription& table,
                   Delimited kind, const WrittenSamples* ticks, GzipFile& file) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;  // [bytes]
  const std::vector<ColumnDoc> docs = docs_of(table);
  const auto time =
      static_cast<std::size_t>(std::ranges::find(docs, "time_ns", &ColumnDoc::name) - docs.begin());
  std::string text = ticks == nullptr ? heading(docs, kind) : "";
  RowText row(text, kind);
  reader.each_row(table, [&](const std::vector<record::Cell>& cells) {
    if (ticks != nullptr) {
      row.add_seconds(ticks->even_time(std::get<std::int64_t>(cells.at(time))));
    }
    for (const record::Cell& cell : cells) {
      std::visit([&](const auto& value) { row.add(value); }, cell);
    }
    row.end();
    if (text.size() >= kPiece) {
      file.write(text);
      text.clear();
    }
  });
  file.write(text);
}

std::vector<record::EventRow> channel_events(const record::SessionReader& reader, bool messages) {
  std::vector<record::EventRow> events;
  for (const channel::IncidentRow& row : analysis::channel_incidents(reader)) {
    const bool message = row.what == channel::Incident::kMessage;
    if (messages || !message) {
      // The amount of a message is how far its time may be wrong, no part of what was said.
      const bool amount = row.amount != 0.0 && !message;
      events.push_back({row.time_ns, fmt::format("channel_{}", channel::name_of(row.what)),
                        fmt::format("{}{}{}{}", row.channel, row.text.empty() ? "" : ": ", row.text,
                                    amount ? fmt::format(" ({:g})", row.amount) : "")});
    }
  }
  return events;
}

}  // namespace haptrial::exchange
