#include "analysis/exchange/bids_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "analysis/exchange/other_devices.h"
#include "analysis/files/delimited.h"
#include "analysis/files/new_folder.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/record/read/session_reader.h"

namespace haptrial::exchange::bids {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kPiece = 32768;  // rows read at a time
constexpr const char* kAxes[] = {"x", "y", "z"};
constexpr std::size_t kColumnsOfDevice = 6;

std::string stem_of(const Session& session) {
  return fmt::format("motion/{}_tracksys-device", session.stem());
}

/// The rows of one device. @param point  as columns begin
std::string channels_of(const std::string& point, const std::string& what) {
  std::string text;
  for (const char* axis : kAxes) {
    text +=
        fmt::format("{1}_pos_{0}\t{0}\tPOS\t{1}\tm\tworld\tposition of {2}\n", axis, point, what);
  }
  for (const char* axis : kAxes) {
    text +=
        fmt::format("{1}_vel_{0}\t{0}\tVEL\t{1}\tm/s\tworld\tvelocity of {2}\n", axis, point, what);
  }
  return text;
}

/// @param others  devices after the first
std::string channels_table(std::size_t others) {
  std::string text = "name\tcomponent\ttype\ttracked_point\tunits\treference_frame\tdescription\n";
  text += channels_of("tip", "the tool's tip");
  for (std::size_t number = 1; number <= others; ++number) {
    text += channels_of(fmt::format("device_{}", number),
                        fmt::format("the tip of device {}, counted from 0", number));
  }
  return text +
         "latency\tn/a\tLATENCY\tn/a\ts\tn/a\twhat the clock read, from the first sample on\n";
}

std::string channels_sidecar(const ExportSession& session) {
  Json json;
  json["reference_frame"] = {
      {"Description", "The frame in which positions and velocities are given"},
      {"Levels",
       {{"world",
         {{"SpatialAxes", session.mirrored ? "LUB" : "RUB"},
          {"Description", fmt::format("Origin at the centre of the device's workspace, {}",
                                      axes_of(session))}}}}}};
  return json.dump(2) + "\n";
}

std::string sidecar(const Session& session, double rate, std::uint64_t rows, std::size_t others) {
  const record::SessionInfo& info = session.source.info;
  Json json = Json::parse(described_task(session));
  json["SamplingFrequency"] = rate;
  json["RecordingDuration"] = static_cast<double>(rows) / rate;
  json["RecordingType"] = "continuous";
  json["TrackingSystemName"] = "device";
  json["TrackedPointsCount"] = 1 + others;
  json["MotionChannelCount"] = (1 + others) * kColumnsOfDevice + 1;
  json["POSChannelCount"] = 3 * (1 + others);
  json["VELChannelCount"] = 3 * (1 + others);
  json["LATENCYChannelCount"] = 1;
  json["MissingValues"] = "n/a";
  json["ManufacturersModelName"] = info.device;
  json["SoftwareVersions"] =
      fmt::format("haptrial {} ({})", info.program_version, info.program_commit);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// Text of the ticks nearest to the times k / rate, row by row.
class MotionText {
 public:
  MotionText(double loop_rate, double rate, OtherDevices& others)
      : others_(others), step_(loop_rate / rate), row_(text_, Delimited::kTsv) {}

  void add(const record::Sample& sample) {
    first_time_ = first_ ? sample.time_ns : first_time_;
    first_ = false;
    for (; wanted() < sample.sequence; ++rows_) {
      add_missing(kColumnsOfDevice * (1 + others_.count()) + 1);
      row_.end();
    }
    if (wanted() != sample.sequence) {
      return;
    }
    add_movement(sample.position, sample.velocity);
    add_others(sample.sequence);
    row_.add_seconds(sample.time_ns - first_time_).end();
    ++rows_;
  }

  /// The rows since the last call.
  std::string take() { return std::exchange(text_, {}); }
  std::uint64_t rows() const { return rows_; }

 private:
  std::uint64_t wanted() const {
    return static_cast<std::uint64_t>(std::llround(static_cast<double>(rows_) * step_));
  }
  void add_missing(std::size_t columns) {
    for (std::size_t i = 0; i < columns; ++i) {
      row_.add_missing();
    }
  }
  void add_movement(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity) {
    for (const Eigen::Vector3d& vector : {position, velocity}) {
      for (const double value : vector) {
        row_.add(static_cast<float>(value));
      }
    }
  }
  void add_others(std::uint64_t sequence) {
    const auto rows = others_.at_tick(sequence);
    for (std::size_t number = 1; number <= others_.count(); ++number) {
      const auto row =
          std::ranges::find(rows, static_cast<std::int32_t>(number), &record::DeviceRow::device);
      if (row != rows.end()) {
        add_movement(row->position, row->velocity);
      } else {
        add_missing(kColumnsOfDevice);
      }
    }
  }

  OtherDevices& others_;
  double step_;
  std::string text_;
  RowText row_;
  std::uint64_t rows_{0};
  std::int64_t first_time_{0};
  bool first_{true};
};

void check_rate(const Session& session, double rate) {
  if (rate > session.source.info.rate) {
    throw InputError(fmt::format("{}: --motion is {} Hz; allowed: up to the loop's {} Hz",
                                 session.source.file.string(), rate, session.source.info.rate));
  }
}

}  // namespace

std::string motion_file(const Session& session) { return stem_of(session) + "_motion.tsv"; }

void write_motion(const NewFolder& out, const Session& session, const record::SessionReader& reader,
                  double rate, const std::string& events) {
  check_rate(session, rate);
  OtherDevices others(reader);
  MotionText motion(session.source.info.rate, rate, others);
  const std::string stem = session.folder() + "/" + stem_of(session);
  const std::filesystem::path file = out.place(stem + "_motion.tsv");
  const std::uint64_t count = reader.sample_count();
  for (std::uint64_t row = 0; row < count; row += kPiece) {
    for (const record::Sample& sample : reader.samples(row, std::min(kPiece, count - row))) {
      motion.add(sample);
    }
    append_text(file, motion.take());
  }
  out.write(stem + "_motion.json", sidecar(session, rate, motion.rows(), others.count()));
  out.write(stem + "_channels.tsv", channels_table(others.count()));
  out.write(stem + "_channels.json", channels_sidecar(session.source));
  out.write(fmt::format("{}/motion/{}_events.tsv", session.folder(), session.stem()), events);
}

}  // namespace haptrial::exchange::bids
