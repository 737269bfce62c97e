// Sessions as XDF come back from libxdf, which others wrote.
#include "analysis/exchange/export_xdf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <xdf.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>

#include "analysis/files/xdf_file.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/channel/channel_row.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/session_reader.h"
#include "tests/analysis/exchange/small_session.h"
#include "tests/support/sanitizer.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::exchange::export_xdf_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

void ignore(std::uint64_t) {}

class ExportXdfTest : public testing::Test {
 protected:
  void SetUp() override {
    if (test::kAddressSanitizer) {
      GTEST_SKIP() << "libxdf reads beyond the end of its own texts, which ends a sanitizer's run";
    }
  }
  void write(const std::string& name, const SmallSession& session) {
    write_session(folder_ / name, session);
    files_.push_back(folder_ / name);
  }

  static Xdf load(const fs::path& file) {
    Xdf xdf;
    EXPECT_EQ(xdf.load_xdf(file.string()), 0) << file;
    return xdf;
  }

  static const Xdf::Stream& stream(const Xdf& xdf, const std::string& name) {
    const auto found = std::ranges::find_if(
        xdf.streams, [&](const Xdf::Stream& each) { return each.info.name == name; });
    if (found == xdf.streams.end()) {
      throw std::runtime_error("no stream " + name);
    }
    return *found;
  }

  test::TemporaryFolder folder_;
  std::vector<fs::path> files_;
};

TEST_F(ExportXdfTest, LibxdfReadsEveryTickOfTheDevice) {
  write("a.h5", {.subject = "P-01", .gap_at = 1100, .gap = 500});
  const XdfSummary done = export_xdf(files_, folder_ / "out", 2, ignore);
  EXPECT_EQ(done.sessions, 1u);
  EXPECT_EQ(done.streams, 3u);
  const Xdf xdf = load(folder_ / "out/P-01.xdf");
  const Xdf::Stream& device = stream(xdf, "device");
  const record::SessionReader reader(files_.front());
  const std::vector<record::Sample> samples = reader.samples(0, reader.sample_count());
  EXPECT_EQ(device.info.nominal_srate, 0.0) << "ticks are missing";
  EXPECT_EQ(device.info.channel_format, "float32");
  ASSERT_EQ(device.info.channel_count, 14);
  ASSERT_EQ(device.info.channels.size(), 14u);
  EXPECT_EQ(device.info.channels[2].at("label"), "position_x");
  EXPECT_EQ(device.info.channels[2].at("unit"), "m");
  EXPECT_EQ(device.info.sample_count, static_cast<int>(samples.size()));
  ASSERT_EQ(device.time_stamps.size(), samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_NEAR(device.time_stamps[i], 1e-9 * static_cast<double>(samples[i].time_ns), 1e-9) << i;
    ASSERT_EQ(device.time_series[0][i], static_cast<float>(samples[i].pass)) << i;
    ASSERT_EQ(device.time_series[2][i], static_cast<float>(samples[i].position.x())) << i;
    ASSERT_EQ(device.time_series[10][i], static_cast<float>(samples[i].force.z())) << i;
    ASSERT_EQ(device.time_series[13][i], samples[i].saturated ? 1.0F : 0.0F) << i;
  }
}

TEST_F(ExportXdfTest, EveryDeviceIsAStreamOfItsOwn) {
  write("a.h5", {.subject = "P1", .gap_at = 1100, .gap = 500, .other_devices = 2});
  EXPECT_EQ(export_xdf(files_, folder_ / "out", 1, ignore).streams, 5u);
  const Xdf xdf = load(folder_ / "out/P1.xdf");
  const record::SessionReader reader(files_.front());
  const std::vector<record::DeviceRow> rows = reader.rows<record::DeviceRow>();
  for (const int device : {1, 2}) {
    const Xdf::Stream& theirs = stream(xdf, "device_" + std::to_string(device));
    ASSERT_EQ(theirs.info.channels.size(), 10u);
    EXPECT_EQ(theirs.info.channels[6].at("label"), "force_x");
    EXPECT_EQ(theirs.info.channels[6].at("unit"), "N");
    ASSERT_EQ(theirs.time_stamps.size(), rows.size() / 2);
    const double rate = reader.info().rate;
    std::size_t i = 0;
    for (const record::DeviceRow& row : rows) {
      if (row.device == device) {
        ASSERT_NEAR(theirs.time_stamps[i], static_cast<double>(row.sequence) / rate, 1e-9) << i;
        ASSERT_EQ(theirs.time_series[0][i], static_cast<float>(row.position.x())) << i;
        ASSERT_EQ(theirs.time_series[8][i], static_cast<float>(row.force.z())) << i;
        ASSERT_EQ(theirs.time_series[9][i], static_cast<float>(device)) << i;
        ++i;
      }
    }
  }
}

TEST_F(ExportXdfTest, PassesAndEventsAreMarkersAtTheirTimes) {
  write("a.h5", {.subject = "P1", .note = "5 µm & <more>"});
  export_xdf(files_, folder_ / "out", 1, ignore);
  const Xdf xdf = load(folder_ / "out/P1.xdf");
  const record::SessionReader reader(files_.front());
  EXPECT_EQ(stream(xdf, "device").info.nominal_srate, reader.info().rate);
  const std::vector<record::PassRow> passes = reader.passes();
  std::size_t pass = 0;
  bool noticed = false;
  for (const auto& [event, number] : xdf.eventMap) {
    const auto& [text, time] = event;
    if (text.starts_with('{')) {
      const auto json = nlohmann::json::parse(text);
      EXPECT_EQ(json["pass"], pass);
      EXPECT_EQ(json["trial_type"], passes.at(pass).condition);
      EXPECT_NEAR(time, static_cast<double>(passes[pass].first_sample) / reader.info().rate, 1e-9);
      ++pass;
    }
    noticed = noticed || (text == "notice: 5 µm & <more>" && std::abs(time - 1.500000001) < 1e-9);
  }
  EXPECT_EQ(pass, passes.size());
  EXPECT_TRUE(noticed);
  EXPECT_THAT(xdf.fileHeader, HasSubstr("<simulated>true</simulated>"));
}

TEST_F(ExportXdfTest, AChannelIsAStreamOfDoublesOnTheSessionsClock) {
  const channel::ChannelTable grip("grip", {{"force", "N"}}, 64);
  std::vector<channel::ChannelRow> rows(500);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].sample = i;
    rows[i].time_ns = 20'000'001 * static_cast<std::int64_t>(i) + 7;
    rows[i].values[0] = std::sin(0.1 * static_cast<double>(i));
  }
  record::SessionInfo info;
  info.subject = "P1";
  info.clock = "simulated";
  info.start_utc = "2026-11-20T09:30:00Z";
  record::SessionWriter writer(folder_ / "a.h5", info,
                               {&grip.table(), &record::table_of<channel::IncidentRow>()});
  writer.add(record::Rows(grip.table(), rows.data(), rows.size()));
  writer.set_timing({}, {0, 0, 0});
  writer.close();
  files_ = {folder_ / "a.h5"};
  EXPECT_EQ(export_xdf(files_, folder_ / "out", 1, ignore).streams, 1u);
  const Xdf xdf = load(folder_ / "out/P1.xdf");
  const Xdf::Stream& theirs = stream(xdf, "grip");
  EXPECT_EQ(theirs.info.channel_format, "double64");
  EXPECT_EQ(theirs.info.nominal_srate, 0.0);
  ASSERT_EQ(theirs.time_stamps.size(), rows.size());
  EXPECT_EQ(theirs.info.channels.back().at("label"), "force");
  EXPECT_EQ(theirs.info.channels.back().at("unit"), "N");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_NEAR(theirs.time_stamps[i], 1e-9 * static_cast<double>(rows[i].time_ns), 1e-9);
    EXPECT_EQ(theirs.time_series.back()[i], static_cast<float>(rows[i].values[0]));
  }
}

TEST_F(ExportXdfTest, WhatAChannelSaidIsAStreamOfMarkers) {
  const channel::ChannelTable stimuli("stimuli", {}, 64);
  using channel::Incident;
  const std::string start(255, 'a');  // a row has 256 bytes, and a cut divides no character
  const std::vector<channel::IncidentRow> rows{
      {100'000'000, "stimuli", Incident::kMessage, 0.001, start},
      {100'000'000, "stimuli", Incident::kMessage, 0.001, "é, which goes on"},
      {500'000'000, "stimuli", Incident::kMessage, 0.001, "cue left"},
      {750'000'000, "stimuli", Incident::kLost, 0.0, "the sender has ended"},
      {250'000'000, "stimuli", Incident::kMessage, 0.001, "fixation"}};
  record::SessionInfo info;
  info.subject = "P1";
  info.clock = "simulated";
  info.start_utc = "2026-11-20T09:30:00Z";
  record::SessionWriter writer(folder_ / "a.h5", info,
                               {&stimuli.table(), &record::table_of<channel::IncidentRow>()});
  writer.add(std::span<const channel::IncidentRow>(rows));
  writer.set_timing({}, {0, 0, 0});
  writer.close();
  files_ = {folder_ / "a.h5"};
  EXPECT_EQ(export_xdf(files_, folder_ / "out", 1, ignore).streams, 2u);
  const Xdf xdf = load(folder_ / "out/P1.xdf");
  const auto time_of = [&](const std::string& wanted) {
    for (const auto& [event, number] : xdf.eventMap) {
      if (event.first == wanted) {
        return event.second;
      }
    }
    return -1.0;
  };
  EXPECT_NEAR(time_of(start + "é, which goes on"), 0.1, 1e-9);
  EXPECT_NEAR(time_of("fixation"), 0.25, 1e-9);
  EXPECT_NEAR(time_of("cue left"), 0.5, 1e-9);
  EXPECT_NEAR(time_of("channel_lost: stimuli: the sender has ended"), 0.75, 1e-9);
  EXPECT_EQ(stream(xdf, "stimuli").info.type, "Markers");
}

TEST_F(ExportXdfTest, SeveralSessionsHaveNumbers) {
  write("a.h5", {.subject = "P1"});
  write("b.h5", {.subject = "P1", .start_utc = "2026-11-21T09:30:00Z"});
  export_xdf(files_, folder_ / "out", 2, ignore);
  EXPECT_TRUE(fs::exists(folder_ / "out/P1-session-1.xdf"));
  EXPECT_TRUE(fs::exists(folder_ / "out/P1-session-2.xdf"));
}

TEST_F(ExportXdfTest, StreamsWithoutSamplesAreLeftOut) {
  write("a.h5", {.subject = "P1", .trials = 0});
  EXPECT_EQ(export_xdf(files_, folder_ / "out", 1, ignore).streams, 1u);
  EXPECT_EQ(load(folder_ / "out/P1.xdf").eventMap.size(), 1u);
}

TEST_F(ExportXdfTest, WhatAParticipantSaidStaysOut) {
  SmallSession session{.subject = "P1"};
  session.person = {"P1", "right", "18-25", "female", "yes", "said that it tickles"};
  write("a.h5", session);
  export_xdf(files_, folder_ / "out", 1, ignore);
  EXPECT_THAT(file_text(folder_ / "out/P1.xdf"), Not(HasSubstr("tickles")));
}

// The example of the specification's page, byte for byte: lengths, tags, and a time of eight bytes.
TEST(XdfFileTest, WritesTheBytesOfTheSpecification) {
  const test::TemporaryFolder folder;
  const fs::path path = folder / "a.xdf";
  XdfFile file(path, {});
  const std::uint32_t stream = file.add_stream({"s", "t", XdfFormat::kString, 0.0, {{"c", ""}}});
  file.add(stream, 1.5, std::string("hi"));
  EXPECT_THROW(file.add(stream, 1.5, std::vector{1.0}), std::invalid_argument);
  file.close();
  const std::string text = file_text(path);
  EXPECT_TRUE(text.starts_with("XDF:\x04"));
  const std::string header = "<?xml version=\"1.0\"?><info><version>1.0</version></info>";
  EXPECT_EQ(text.substr(5, 4), std::string({static_cast<char>(header.size() + 2), 0, 0, 0}));
  EXPECT_EQ(text.substr(9, 2 + header.size()), std::string("\x01\0", 2) + header);
  const std::string sample("\x03\0\x01\0\0\0\x04\x01\0\0\0\x08\0\0\0\0\0\0\xf8\x3f\x04\x02\0\0\0hi",
                           27);
  EXPECT_THAT(text, HasSubstr(sample));
}

}  // namespace
}  // namespace haptrial::exchange::export_xdf_test
