// The nerve monitor from a definition through a session to its report. All simulated.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "analysis/bone_drilling/report/nerve_findings.h"
#include "core/base/error.h"
#include "core/bone/nerve/monitor_buffer.h"
#include "core/bone/nerve/nerve_rows.h"
#include "core/bone/record/drilling_tables.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/sound/wav.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "protocols/bone_drilling/bone_protocol.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/bone_drilling/load_bones.h"
#include "protocols/bone_drilling/nerve_page.h"
#include "tests/experiments/command.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::nerve_session_test {
namespace {

namespace fs = std::filesystem;
namespace drilling = analysis::drilling;
using testing::AllOf;
using testing::HasSubstr;

/// A nerve right under the slab that the virtual hand drills, and the one of the bone.
const char* const kMonitor = R"(
[nerve_monitor]
bursts = 0.2
heat = 0.4
[[nerve_monitor.curves]]
name = "drawn nerve"
points_mm = [[2.0, 7.0, 10.0], [16.0, 7.0, 10.0], [30.0, 7.0, 10.0]]
channels = ["first muscle", "second muscle"]
[[nerve_monitor.nerves]]
structure = "facial nerve"
)";

/// A small drilling with this at the end of its definition. Dust, which changes nothing that a
/// monitor sees, would take most of the time.
fs::path write_monitored(const fs::path& folder, double seconds,
                         const std::string& monitor = kMonitor,
                         const std::vector<std::pair<std::string, std::string>>& more = {}) {
  const fs::path file = test::write_small_drilling(folder, seconds, more);
  std::string text = test::read_text(file);
  const std::size_t dust = text.find("[dust]");
  text.erase(dust, text.find("[sound]") - dust);
  test::write_text(file, text + monitor);
  return file;
}

SessionRequest request_of(const protocols::BoneDefinition& definition, const fs::path& file) {
  return test::session_request(protocols::bone_drilling(), definition, file, 3);
}

class NerveSessionTest : public testing::Test {
 protected:
  static constexpr double kSeconds = 60.0;
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    const protocols::BoneDefinition definition =
        protocols::load_bone_definition(write_monitored(folder_->path(), kSeconds));
    run_session(request_of(definition, *folder_ / "S01.h5"));
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static record::SessionReader session() { return record::SessionReader(*folder_ / "S01.h5"); }
  static std::unique_ptr<test::TemporaryFolder> folder_;
};
std::unique_ptr<test::TemporaryFolder> NerveSessionTest::folder_;

TEST_F(NerveSessionTest, TheFileHoldsEverySampleOfEveryTick) {
  const record::SessionReader reader = session();
  const record::Integrity integrity =
      record::check_session(reader, protocols::bone_drilling().tables());
  EXPECT_TRUE(integrity.ok) << integrity.problems.front();
  const auto channels = reader.rows<record::NerveChannelRow>();
  ASSERT_EQ(channels.size(), 3u);
  EXPECT_EQ(channels[0].name, "facial nerve");
  EXPECT_EQ(channels[2].name, "second muscle");
  EXPECT_EQ(channels[2].nerve, "drawn nerve");
  EXPECT_EQ(channels[2].rate, 8000.0);
  const auto emg = reader.rows<record::EmgRow>();
  ASSERT_EQ(emg.size(), reader.sample_count() * 8);
  for (std::size_t i = 0; i < emg.size(); ++i) {
    ASSERT_EQ(emg[i].sequence, i / 8);
    ASSERT_EQ(emg[i].sample, i % 8);
    ASSERT_EQ(emg[i].channels[3], 0.0) << "there are three channels";
  }
  EXPECT_EQ(reader.passes().front().condition, "monitor on");
}

TEST(NerveSeedTest, TheSameSeedGivesTheSameSamplesOnAnyThread) {
  const test::TemporaryFolder folder;
  const protocols::BoneDefinition definition =
      protocols::load_bone_definition(write_monitored(folder.path(), 8.0));
  std::thread other([&] { run_session(request_of(definition, folder / "beside.h5")); });
  run_session(request_of(definition, folder / "S01.h5"));
  other.join();
  const record::SessionReader first(folder / "S01.h5");
  const record::SessionReader beside(folder / "beside.h5");
  const auto a = first.rows<record::EmgRow>();
  const auto b = beside.rows<record::EmgRow>();
  ASSERT_EQ(a.size(), b.size());
  EXPECT_GT(a.size(), 0u);
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].channels, b[i].channels) << i;
  }
  EXPECT_GT(first.rows<record::NerveEventRow>().size(), 0u);
  EXPECT_EQ(first.rows<record::NerveEventRow>().size(),
            beside.rows<record::NerveEventRow>().size());
}

/// Size of a session's file. @param monitor  at the end of its definition
double bytes_of(double seconds, const std::vector<std::pair<std::string, std::string>>& more,
                const std::string& monitor) {
  const test::TemporaryFolder folder;
  const protocols::BoneDefinition definition =
      protocols::load_bone_definition(write_monitored(folder.path(), seconds, monitor, more));
  run_session(request_of(definition, folder / "S01.h5"));
  return static_cast<double>(fs::file_size(folder / "S01.h5"));
}

/// Four channels or one, with suction between the strokes or without. What a monitor takes beside
/// a session without one, whose other rows are the same; by two lengths, since what every file has
/// does not grow.
TEST(NerveFileTest, AChannelTakesAtMostThirtyMegabytesAnHour) {
  constexpr double kShort = 4.0;
  constexpr double kLong = 10.0;
  for (const bool constant : {false, true}) {
    std::vector<std::pair<std::string, std::string>> more;
    if (constant) {
      more.emplace_back("strokes_to_suction", "strokes_to_suction = 100000");
    }
    const auto growth = [&](const std::string& monitor) {
      return bytes_of(kLong, more, monitor) - bytes_of(kShort, more, monitor);
    };
    const double without = growth("");
    for (const int channels : {4, 1}) {
      const char* names = channels == 4 ? R"("a", "b", "c", "d")" : R"("a")";
      const double with =
          growth(fmt::format("\n[nerve_monitor]\nbursts = 0.05\n[[nerve_monitor.nerves]]\n"
                             "structure = \"facial nerve\"\nchannels = [{}]\n",
                             names));
      const double each = 1e-6 * (with - without) / (kLong - kShort) * 3600.0 / channels;
      std::printf("%d channels: %.1f MB an hour and each\n", channels, each);
      EXPECT_GT(each, 10.0) << "noise does not vanish";
      EXPECT_LE(each, 30.0);
    }
  }
}

TEST_F(NerveSessionTest, WhatWasPlantedIsFoundThroughTheFile) {
  const auto procedures = drilling::load_nerves(session(), "");
  ASSERT_EQ(procedures.size(), 1u);
  const drilling::NerveProcedure& p = procedures.front();
  const drilling::NerveDetection& d = p.detection;
  std::printf(
      "planted %d found %d above %d (%d) alarms %d artefacts %d (%d) train %.3f of %.3f s\n",
      d.planted, d.found, d.above, d.above_found, d.false_alarms, d.artefacts, d.artefacts_passed,
      d.found_train, d.planted_train);
  EXPECT_GT(d.planted, 10);
  EXPECT_GT(d.planted_train, 0.5);
  EXPECT_GE(d.above_found, 0.95 * d.above);
  EXPECT_GE(d.found, 0.85 * d.planted) << "some bursts stay below the threshold";
  EXPECT_LE(d.false_alarms, 1);
  EXPECT_GT(d.artefacts, 10);
  EXPECT_LE(d.artefacts_passed, 0.05 * d.artefacts);
  // Trains and bursts pile up in two muscles here, and a burst within a train breaks it.
  EXPECT_GE(d.found_train, 0.75 * d.planted_train);
  EXPECT_LE(d.found_train, 1.02 * d.planted_train);
  ASSERT_EQ(p.nerves.size(), 2u);
  EXPECT_EQ(p.nerves[1].nerve, "drawn nerve");
  EXPECT_GT(p.nerves[1].events(), 3 * p.nerves[0].events()) << "the other lies 5 mm deeper";
  EXPECT_FALSE(p.reactions.empty());
}

TEST_F(NerveSessionTest, AReportIsMadeAndMarkedAsSimulated) {
  const fs::path study = *folder_ / "study";
  fs::create_directories(study);
  fs::copy_file(*folder_ / "S01.h5", study / "S01.h5");
  const test::CommandResult made = test::run_command("haptrial analyze '" + study.string() + "'");
  ASSERT_EQ(made.status, 0) << made.errors;
  EXPECT_THAT(made.output, HasSubstr("Simulated: monitor on: "));
  const test::CommandResult planned =
      test::run_command("haptrial analyze '" + study.string() + "' --planned 'on > off'");
  EXPECT_EQ(planned.status, 2);
  EXPECT_THAT(planned.errors, HasSubstr("nothing is learned from session to session"));
  fs::path report;
  for (const auto& entry : fs::recursive_directory_iterator(study)) {
    report = entry.path().filename() == "report.md" ? entry.path() : report;
  }
  const std::string text = test::read_text(report);
  EXPECT_THAT(text, AllOf(HasSubstr("Nerve monitor (simulated)"), HasSubstr("drawn nerve"),
                          HasSubstr("SIMULATED"), HasSubstr("false alarms")));
  const auto json =
      nlohmann::json::parse(test::read_text(report.parent_path() / "statistics.json"));
  const auto& monitor = json["nerve_monitor"]["tables"];
  EXPECT_EQ(monitor["events"][1]["nerve"], "drawn nerve");
  EXPECT_GT(monitor["events"][1]["bursts"].get<int>() + monitor["events"][1]["trains"].get<int>(),
            0);
  EXPECT_FALSE(monitor["first_events"].empty());
  EXPECT_THAT(test::read_text(report.parent_path() / "nerves.csv"),
              HasSubstr("S01.h5,S01,participants,1,1,monitor on,"));
}

std::string refusal(const std::string& monitor) {
  const test::TemporaryFolder folder;
  try {
    protocols::load_bone_definition(write_monitored(folder.path(), 5.0, monitor));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(NerveDefinitionTest, WhatDoesNotFitTheBoneGetsASentence) {
  EXPECT_THAT(
      refusal("\n[nerve_monitor]\n[[nerve_monitor.nerves]]\nstructure = \"vagus\"\n"),
      AllOf(HasSubstr("names \"vagus\", which slabs does not have"), HasSubstr("facial nerve")));
  EXPECT_THAT(refusal("\n[nerve_monitor]\n[[nerve_monitor.curves]]\nname = \"far\"\n"
                      "points_mm = [[1, 1, 1], [99, 1, 1]]\n"),
              HasSubstr("point 2 of \"far\", (99, 1, 1) mm, lies outside slabs"));
}

TEST(NerveDefinitionTest, EveryOtherProcedureIsHeard) {
  const test::TemporaryFolder folder;
  const auto d = protocols::load_bone_definition(
      write_monitored(folder.path(), 5.0,
                      "\n[nerve_monitor]\nheard_in = \"every other\"\n[[nerve_monitor.nerves]]\n"
                      "structure = \"facial nerve\"\n"));
  EXPECT_TRUE(d.hears_nerves({1, 0}));
  EXPECT_FALSE(d.hears_nerves({2, 0}));
  EXPECT_FALSE(d.hears_nerves({1, 1}));
  EXPECT_TRUE(d.hears_nerves({2, 1}));
}

TEST(NerveTrainingTest, TheShippedDefinitionIsATrainingWithAndWithout) {
  const Experiment experiment =
      load_experiment(fs::path(HAPTRIAL_SOURCE_DIR) / "experiments/nerve_training.toml");
  const auto& d = dynamic_cast<const protocols::BoneDefinition&>(*experiment.definition);
  ASSERT_EQ(d.side_streams().size(), 1u);
  EXPECT_EQ(d.side_streams().front().channels.size(), 4u);
  EXPECT_EQ(d.nerve_distances.size(), 1u);
  EXPECT_THAT(d.design.conditions, testing::ElementsAre("monitor on", "monitor off"));
  EXPECT_TRUE(d.surgeon.has_value());
}

TEST(LiveNerveTest, ATechnicianSeesASessionOnTheRealClock) {
  const test::TemporaryFolder folder;
  const protocols::BoneDefinition definition =
      protocols::load_bone_definition(write_monitored(folder.path(), 2.0));
  SessionRequest request = request_of(definition, folder / "S01.h5");
  request.clock = realtime::ClockKind::kReal;
  request.device.name = "virtual";
  request.auxiliary_pages = request.protocol->auxiliary_pages(definition);
  const auto page = protocols::page_of<protocols::NervePage>(request.auxiliary_pages);
  ASSERT_NE(page, nullptr);
  const SessionSummary done = run_session(request);
  EXPECT_EQ(done.dropped, 0u);
  const nerve::MonitorBuffer::View view = page->buffer()->since(0, 0);
  EXPECT_EQ(view.channels.size(), 3u);
  EXPECT_GT(view.next_column, 400u);
  const record::SessionReader reader(folder / "S01.h5");
  EXPECT_EQ(reader.rows<record::EmgRow>().size(), reader.sample_count() * 8);
  const record::Integrity integrity =
      record::check_session(reader, protocols::bone_drilling().tables());
  EXPECT_TRUE(integrity.ok) << integrity.problems.front();
}

/// The amplitude of one frequency in a stretch of a sound.
double amplitude_at(double frequency, std::span<const float> sound, double rate) {
  std::complex<double> sum;
  for (std::size_t i = 0; i < sound.size(); ++i) {
    const double t = static_cast<double>(i) / rate;
    sum += static_cast<double>(sound[i]) * std::polar(1.0, -2.0 * std::numbers::pi * frequency * t);
  }
  return 2.0 * std::abs(sum) / static_cast<double>(sound.size());
}

/// The tone of the first muscle's longest event, and of what comes a second before it or after.
struct HeardTone {
  double during{0.0};
  double beside{0.0};
};
HeardTone tone_of_replay(const fs::path& file, const fs::path& wav) {
  const test::CommandResult made = test::run_command("haptrial replay '" + file.string() +
                                                     "' --trial 1 --sound '" + wav.string() + "'");
  EXPECT_EQ(made.status, 0) << made.errors;
  const record::SessionReader reader(file);
  auto events = reader.rows<record::NerveEventRow>();
  std::erase_if(events, [](const record::NerveEventRow& row) {
    return row.channel != 1 || row.kind == record::NerveEventRow::Kind::kArtefact;
  });
  const auto length = [](const record::NerveEventRow& row) { return row.sequence - row.begin; };
  const auto longest = std::ranges::max_element(events, {}, length);
  if (longest == events.end()) {
    ADD_FAILURE() << "no event";
    return {};
  }
  const sound::Recording heard = sound::read_recording(wav);
  const std::uint64_t first = reader.passes().front().first_sample;
  const auto part = [&](std::uint64_t begin, std::uint64_t end) {
    return std::span(heard.samples).subspan((begin - first) * 48, (end - begin) * 48);
  };
  constexpr double kFirstMuscle = 400.0 * 1.25;  // [Hz]
  HeardTone tone;
  tone.during =
      amplitude_at(kFirstMuscle, part(longest->begin + 20, longest->sequence - 5), heard.rate);
  const auto quiet = [&](std::uint64_t begin, std::uint64_t end) {
    return std::ranges::none_of(events, [&](const record::NerveEventRow& row) {
      return row.begin < end && row.sequence + 100 > begin;
    });
  };
  std::uint64_t begin = first + 500;
  while (!quiet(begin, begin + length(*longest))) {
    ++begin;
  }
  tone.beside = amplitude_at(kFirstMuscle, part(begin, begin + length(*longest)), heard.rate);
  return tone;
}

TEST(NerveReplayTest, TheMonitorIsHeardBesideTheDrillWhereItWasHeardThen) {
  for (const bool heard : {true, false}) {
    const test::TemporaryFolder folder;
    std::string monitor = kMonitor;
    if (!heard) {
      monitor.replace(monitor.find("bursts"), 0, "heard_in = \"none\"\n");
    }
    monitor.replace(monitor.find("bursts = 0.2"), 12, "bursts = 1.0");
    const protocols::BoneDefinition definition =
        protocols::load_bone_definition(write_monitored(folder.path(), 12.0, monitor));
    run_session(request_of(definition, folder / "S01.h5"));
    const HeardTone tone = tone_of_replay(folder / "S01.h5", folder / "S01.wav");
    EXPECT_LT(tone.beside, 0.03);
    if (heard) {
      EXPECT_NEAR(tone.during, 0.12, 0.03) << "a tone is 0.12 of full scale";
    } else {
      EXPECT_LT(tone.during, 0.03);
    }
  }
}

TEST(LiveNerveTest, AfterAKillTheMonitorGoesOnInTheSameTables) {
  const test::TemporaryFolder folder;
  const fs::path study = write_monitored(folder.path(), 15.0);
  const fs::path file = folder / "out" / "S01.h5";
  const std::string line =
      "run '" + study.string() + "' --subject S01 --out '" + (folder / "out").string() + "'";
  const fs::path partial = file.string() + ".partial";
  std::uint64_t samples = 0;
  {
    test::LiveCommand session(line);
    ASSERT_TRUE(session.reaches([&] {
      std::error_code ignored;
      samples =
          fs::exists(partial, ignored) ? record::SessionReader(partial).count<record::EmgRow>() : 0;
      return samples > 8000;
    })) << session.errors();
    session.signal(SIGKILL);
    session.wait();
  }
  test::LiveCommand session(line + " --resume");
  const test::CommandResult ended = session.wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  const record::SessionReader reader(file);
  const record::Integrity integrity =
      record::check_session(reader, protocols::bone_drilling().tables());
  EXPECT_TRUE(integrity.ok) << integrity.problems.front();
  EXPECT_EQ(reader.passes().size(), 2u);
  EXPECT_EQ(reader.rows<record::NerveChannelRow>().size(), 3u) << "not once more";
  const auto emg = reader.rows<record::EmgRow>();
  EXPECT_GE(emg.size(), samples);
  ASSERT_EQ(emg.size(), reader.sample_count() * 8) << "every sample of every tick of both runs";
  const auto ticks = reader.samples(0, reader.sample_count());
  for (std::size_t i = 0; i < emg.size(); ++i) {
    ASSERT_EQ(emg[i].sequence, ticks[i / 8].sequence) << i;
    ASSERT_EQ(emg[i].sample, i % 8) << i;
  }
  const auto thresholds = reader.rows<record::NerveThresholdRow>();
  const auto starts = std::ranges::count(thresholds, record::NerveThresholdRow::Cause::kStart,
                                         &record::NerveThresholdRow::cause);
  EXPECT_EQ(starts, 6) << "of three channels in each run";
}

TEST(NerveCommandTest, TheTechniciansPageNeedsAMonitorAndAConsole) {
  const test::TemporaryFolder folder;
  const std::string out = " --out '" + (folder / "out").string() + "'";
  const fs::path plain = test::write_small_drilling(folder.path(), 1.0);
  const test::CommandResult none =
      test::run_command("haptrial run '" + plain.string() + "' --console --side-page nerves" + out);
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.errors, HasSubstr("has no page 'nerves'; it has tuning"));
  const test::TemporaryFolder other;
  const fs::path watched = write_monitored(other.path(), 1.0);
  const test::CommandResult alone =
      test::run_command("haptrial run '" + watched.string() + "' --side-page nerves" + out);
  EXPECT_EQ(alone.status, 2);
  EXPECT_THAT(alone.errors, HasSubstr("--side-page needs --console"));
  const test::CommandResult other_name = test::run_command("haptrial run '" + watched.string() +
                                                           "' --console --side-page nerve" + out);
  EXPECT_EQ(other_name.status, 2);
  EXPECT_THAT(other_name.errors, HasSubstr("has no page 'nerve'; it has tuning, nerves"));
  EXPECT_THAT(test::run_command("haptrial validate '" + watched.string() + "'").output,
              HasSubstr("page beside the console: nerve monitor"));
}

}  // namespace
}  // namespace haptrial::experiments::nerve_session_test
