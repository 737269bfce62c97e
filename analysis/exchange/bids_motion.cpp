#include "analysis/exchange/bids_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

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
constexpr int kColumns = 7;

std::string stem_of(const Session& session) {
  return fmt::format("motion/{}_tracksys-device", session.stem());
}

std::string channels_table() {
  std::string text = "name\tcomponent\ttype\ttracked_point\tunits\treference_frame\tdescription\n";
  for (const char* axis : kAxes) {
    text += fmt::format("tip_pos_{0}\t{0}\tPOS\ttip\tm\tworld\tposition of the tool's tip\n", axis);
  }
  for (const char* axis : kAxes) {
    text +=
        fmt::format("tip_vel_{0}\t{0}\tVEL\ttip\tm/s\tworld\tvelocity of the tool's tip\n", axis);
  }
  return text +
         "latency\tn/a\tLATENCY\tn/a\ts\tn/a\twhat the clock read, from the first sample on\n";
}

std::string channels_sidecar() {
  Json json;
  json["reference_frame"] = {
      {"Description", "The frame in which positions and velocities are given"},
      {"Levels",
       {{"world",
         {{"SpatialAxes", "RUB"},
          {"Description",
           "Origin at the centre of the device's workspace, x to the participant's right, y up, z "
           "towards the participant"}}}}}};
  return json.dump(2) + "\n";
}

std::string sidecar(const Session& session, double rate, std::uint64_t rows) {
  const record::SessionInfo& info = session.source.info;
  Json json = Json::parse(described_task(session));
  json["SamplingFrequency"] = rate;
  json["RecordingDuration"] = static_cast<double>(rows) / rate;
  json["RecordingType"] = "continuous";
  json["TrackingSystemName"] = "device";
  json["TrackedPointsCount"] = 1;
  json["MotionChannelCount"] = kColumns;
  json["POSChannelCount"] = 3;
  json["VELChannelCount"] = 3;
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
  MotionText(double loop_rate, double rate)
      : step_(loop_rate / rate), row_(text_, Delimited::kTsv) {}

  void add(const record::Sample& sample) {
    first_time_ = first_ ? sample.time_ns : first_time_;
    first_ = false;
    for (; wanted() < sample.sequence; ++rows_) {
      add_missing();
    }
    if (wanted() != sample.sequence) {
      return;
    }
    for (const Eigen::Vector3d& vector : {sample.position, sample.velocity}) {
      for (const double value : vector) {
        row_.add(static_cast<float>(value));
      }
    }
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
  void add_missing() {
    for (int i = 0; i < kColumns; ++i) {
      row_.add_missing();
    }
    row_.end();
  }

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
  MotionText motion(session.source.info.rate, rate);
  const std::string stem = session.folder() + "/" + stem_of(session);
  const std::filesystem::path file = out.place(stem + "_motion.tsv");
  const std::uint64_t count = reader.sample_count();
  for (std::uint64_t row = 0; row < count; row += kPiece) {
    for (const record::Sample& sample : reader.samples(row, std::min(kPiece, count - row))) {
      motion.add(sample);
    }
    append_text(file, motion.take());
  }
  out.write(stem + "_motion.json", sidecar(session, rate, motion.rows()));
  out.write(stem + "_channels.tsv", channels_table());
  out.write(stem + "_channels.json", channels_sidecar());
  out.write(fmt::format("{}/motion/{}_events.tsv", session.folder(), session.stem()), events);
}

}  // namespace haptrial::exchange::bids
