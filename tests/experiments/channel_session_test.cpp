// Sessions with a channel: what a dry run records of it, a stage that waits for it, its limit; a
// live session that is killed again and again, goes on, and is recovered from a damaged file.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <thread>
#include <vector>

#include "core/base/file_text.h"
#include "core/channel/channel_row.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/trial_rows.h"
#include "tests/experiments/live_command.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::channel_session_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

const std::string kStudy = R"([experiment]
protocol = "trials"
name = "squeeze"
[design]
participants = 2
[fields.pull]
type = "constant"
force = [0.0, -0.5, 0.0]
[[stages]]
name = "squeeze"
fields = ["pull"]
until = { channel = "grip", above = 2.0 }
timeout = { after = 60.0, then = "abort" }
[response]
question = "Did you squeeze?"
choices = [{ value = "yes", keys = ["Y"] }, { value = "no", keys = ["N"] }]
[[blocks]]
name = "one"
trials = 6
[observer]
decides = "yes"
actions.squeeze = { do = "hold" }
)";

/// A number of /channel_grip by row, in the order of the file: sample, time [s], force.
struct GripRow {
  std::uint64_t sample{0};
  double time{0.0};
  double force{0.0};
};

std::vector<GripRow> grip_of(const record::SessionReader& reader) {
  const auto table = reader.description("channel_grip");
  std::vector<GripRow> rows;
  reader.each_row(*table, [&](const std::vector<record::Cell>& cells) {
    rows.push_back({std::get<std::uint64_t>(cells[0]),
                    1e-9 * static_cast<double>(std::get<std::int64_t>(cells[1])),
                    std::get<double>(cells[5])});
  });
  return rows;
}

class ChannelSessionTest : public testing::Test {
 protected:
  std::string study(const std::string& keys) {
    const std::string file = folder_ / "squeeze.toml";
    std::ofstream(file) << kStudy << "[channels.grip]\nkind = \"line\"\nquantities = { force = "
                        << "\"N\" }\n"
                        << keys;
    return file;
  }
  test::CommandResult dry_run(const std::string& file, const std::string& out,
                              const std::string& more = "") {
    return test::run_command("haptrial dry-run " + file + " --subjects 1 --out " +
                             (folder_ / out).string() + " " + more);
  }
  record::SessionReader session(const std::string& out) const {
    return record::SessionReader(folder_ / out / "S01.h5");
  }

  test::TemporaryFolder folder_;
};

constexpr const char* kSine =
    "path = \"nowhere\"\nrate = 50.0\n"
    "simulated = { mean = 0.0, amplitude = 4.0, frequency = 0.5 }\n";

TEST_F(ChannelSessionTest, ABidsDataSetHasTheChannelAsARecordingOfItsOwn) {
  ASSERT_EQ(dry_run(study(kSine), "a").status, 0);
  const std::string bids = (folder_ / "bids").string();
  ASSERT_EQ(
      test::run_command("haptrial export --bids " + bids + " " + (folder_ / "a").string()).status,
      0);
  const std::string stem = bids + "/sub-S01/beh/sub-S01_task-squeeze_recording-grip_physio";
  const auto sidecar = nlohmann::json::parse(file_text(stem + ".json"));
  EXPECT_NEAR(sidecar["SamplingFrequency"].get<double>(), 50.0, 1e-6);
  EXPECT_EQ(sidecar["force"]["Units"], "N");
  const auto rows = test::run_command("zcat " + stem + ".tsv.gz").output;
  const auto grip = grip_of(session("a"));
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), static_cast<std::ptrdiff_t>(grip.size()));
  // A row has as many columns as the sidecar names, and the force is the last.
  const std::string first = rows.substr(0, rows.find('\n'));
  EXPECT_EQ(std::count(first.begin(), first.end(), '\t') + 1,
            static_cast<std::ptrdiff_t>(sidecar["Columns"].size()));
  EXPECT_EQ(std::stod(first.substr(first.rfind('\t') + 1)), grip.front().force);
  EXPECT_NEAR(sidecar["StartTime"].get<double>(), grip.front().time, 1e-9);
}

TEST_F(ChannelSessionTest, InADryRunAStageEndsOnTheTickOnWhichTheSineExceedsTheValue) {
  ASSERT_EQ(dry_run(study(kSine), "a").status, 0);
  const record::SessionReader reader = session("a");
  const auto value = [](double t) { return 4.0 * std::sin(std::numbers::pi * t); };
  const auto stages = reader.rows<record::StageRow>();
  ASSERT_EQ(stages.size(), 6u);
  for (const record::StageRow& stage : stages) {
    const auto ticks =
        reader.samples(stage.first_sample, stage.last_sample - stage.first_sample + 1);
    EXPECT_GT(value(1e-9 * static_cast<double>(ticks.back().time_ns)), 2.0);
    for (std::size_t i = 0; i + 1 < ticks.size(); ++i) {
      ASSERT_LE(value(1e-9 * static_cast<double>(ticks[i].time_ns)), 2.0);
    }
  }
  const std::vector<GripRow> grip = grip_of(reader);
  const double end =
      1e-9 * static_cast<double>(reader.samples(reader.sample_count() - 1, 1)[0].time_ns);
  EXPECT_NEAR(static_cast<double>(grip.size()), 50.0 * end, 2.0) << "fifty a second";
  for (std::size_t i = 0; i < grip.size(); ++i) {
    ASSERT_EQ(grip[i].sample, i);
    ASSERT_NEAR(grip[i].force, value(grip[i].time), 1e-6);
  }
}

TEST_F(ChannelSessionTest, EveryCommandShowsTheChannel) {
  ASSERT_EQ(dry_run(study(kSine), "a").status, 0);
  const std::string file = (folder_ / "a" / "S01.h5").string();
  EXPECT_THAT(test::run_command("haptrial info " + file).output,
              AllOf(HasSubstr("channel     grip: "), HasSubstr("50.0 a second"),
                    HasSubstr("0 missing, 0 losses")));
  const std::string out = (folder_ / "csv").string();
  const auto exported = test::run_command("haptrial export " + file + " --samples --csv " + out);
  ASSERT_EQ(exported.status, 0) << exported.errors;
  EXPECT_THAT(test::run_command("find " + out).output, HasSubstr("channels/S01_grip.csv.gz"));
  EXPECT_THAT(test::run_command("zcat " + out + "/channels/S01_grip.csv.gz | head -n 1").output,
              HasSubstr("sample,time_ns,received_ns,uncertainty,device_time,force"));
}

TEST_F(ChannelSessionTest, AValueBeyondTheLimitEndsThePassWithItsSentence) {
  const auto run = dry_run(study(kSine + std::string("limit = 1.5\n")), "b", "--trials 1");
  const auto events = session("b").events();
  EXPECT_TRUE(std::any_of(events.begin(), events.end(),
                          [](const record::EventRow& event) {
                            return event.kind == "aborted" &&
                                   event.text.find(
                                       "channel grip: force is beyond the limit of 1.5 N") !=
                                       std::string::npos;
                          }))
      << run.output << run.errors;
}

TEST_F(ChannelSessionTest, MistakesAreNamedBeforeASession) {
  const auto validate = [this](const std::string& keys) {
    const auto result = test::run_command("haptrial validate " + study(keys));
    EXPECT_EQ(result.status, 2);
    return result.errors;
  };
  EXPECT_THAT(validate("path = \"p\"\nlimt = 3.0\n"), HasSubstr("limt is not a known key"));
  EXPECT_THAT(validate(""), HasSubstr("channels.grip.path"));
  const std::string none = folder_ / "none.toml";
  std::ofstream(none) << kStudy;
  EXPECT_THAT(test::run_command("haptrial validate " + none).errors,
              HasSubstr("no channel: the definition states none"));
}

TEST_F(ChannelSessionTest, ADamagedFileGivesItsSamplesBack) {
  ASSERT_EQ(dry_run(study(kSine), "a").status, 0);
  const std::size_t rows = grip_of(session("a")).size();
  std::string bytes = file_text(folder_ / "a" / "S01.h5");
  std::fill_n(bytes.begin(), 8, '\0');  // the file's own beginning
  const std::string damaged = folder_ / "damaged.h5";
  std::ofstream(damaged, std::ios::binary) << bytes;
  const std::string out = folder_ / "saved.h5";
  const auto recovered = test::run_command("haptrial recover " + damaged + " " + out);
  ASSERT_EQ(recovered.status, 0) << recovered.errors;
  EXPECT_EQ(grip_of(record::SessionReader(out)).size(), rows);
}

/// A grip sensor on a pipe: a hand that squeezes and lets go, a hundred lines a second. Each line
/// is unlike all others, so that one that is doubled or lost is seen.
class GripOnAPipe {
 public:
  explicit GripOnAPipe(std::string pipe) : pipe_(std::move(pipe)), thread_([this] { run(); }) {}
  ~GripOnAPipe() {
    over_ = true;
    thread_.join();
  }

 private:
  void run() {
    int file = -1;
    for (int i = 0; !over_; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      file = file >= 0 ? file : ::open(pipe_.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
      const double squeeze = i / 50 % 2 == 0 ? 3.0 : 1.0;
      const std::string line = std::to_string(squeeze + 1e-6 * i) + "\n";
      if (file >= 0 && ::write(file, line.data(), line.size()) < 0) {
        ::close(file);
        file = -1;
      }
    }
    if (file >= 0) {
      ::close(file);
    }
  }

  std::string pipe_;
  std::atomic<bool> over_{false};
  std::thread thread_;
};

/// The number of the line that gave the row.
long line_of(const GripRow& row) {
  const double squeeze = row.force > 2.0 ? 3.0 : 1.0;
  return std::lround(1e6 * (row.force - squeeze));
}

class LiveChannelTest : public ChannelSessionTest {
 protected:
  void SetUp() override {
    signal(SIGPIPE, SIG_IGN);
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  }
  std::string piped() const { return "path = \"" + (folder_ / "pipe").string() + "\"\n"; }
};

TEST_F(LiveChannelTest, ASessionThatIsKilledGoesOnWithTheNumbersOfItsChannel) {
  const std::string file = study(piped());
  const std::string out = folder_ / "live";
  const std::string partial = out + "/S01.h5.partial";
  const GripOnAPipe grip((folder_ / "pipe").string());
  const std::string run = "run " + file + " --subject S01 --device virtual --out " + out;
  std::size_t before = 0;
  for (int kill = 0; kill < 3; ++kill) {
    test::LiveCommand live(kill == 0 ? run : run + " --resume");
    live.line_after("recording ");  // a file that is being read cannot be gone on with
    ASSERT_TRUE(live.reaches([&] {
      try {
        const record::SessionReader reader(partial);
        return grip_of(reader).size() > before + 60;
      } catch (const std::exception&) {
        return false;  // it has no such table yet
      }
    })) << live.errors();
    live.signal(SIGKILL);
    live.wait();
    before = grip_of(record::SessionReader(partial)).size();
  }
  EXPECT_EQ(test::run_command("haptrial " + run + " --resume").status, 0);
  const record::SessionReader reader(out + "/S01.h5");
  const std::vector<GripRow> rows = grip_of(reader);
  EXPECT_GT(rows.size(), before);
  std::map<double, int> seen;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].sample, i) << "numbers go on";
    EXPECT_EQ(++seen[rows[i].force], 1) << "no line came twice";
  }
  // A run goes on after the last tick that is in the file, beyond which its killed channel may be.
  // Between two runs the pipe has no reader, so that lines are missing.
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (line_of(rows[i]) == line_of(rows[i - 1]) + 1) {
      EXPECT_GE(rows[i].time, rows[i - 1].time) << i;
    }
  }
}

/// The loop runs before the first sample comes.
TEST_F(LiveChannelTest, ASessionWhoseNeededInstrumentSendsRunsToItsEnd) {
  const std::string file = study(piped() + "required = true\n");
  const GripOnAPipe grip((folder_ / "pipe").string());
  const std::string out = folder_ / "needed";
  const auto run = test::run_command("haptrial run " + file +
                                     " --subject S01 --device virtual --trials 2 --out " + out);
  EXPECT_EQ(run.status, 0) << run.errors;
  for (const record::PassRow& pass : record::SessionReader(out + "/S01.h5").passes()) {
    EXPECT_EQ(pass.status, record::PassStatus::kCompleted);
  }
}

/// A session that cannot begin leaves nothing behind that the next one would have to resume.
TEST_F(LiveChannelTest, ASessionThatNeedsAMissingInstrumentDoesNotBegin) {
  const std::string file = study("path = \"/dev/nowhere\"\nrequired = true\n");
  const std::string out = folder_ / "missing";
  const auto run = test::run_command("haptrial run " + file + " --subject S01 --out " + out);
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.errors, AllOf(HasSubstr("channel grip: /dev/nowhere: No such file"),
                                HasSubstr("the session needs it (required = true)")));
  EXPECT_EQ(test::run_command("ls " + out).output, "");
  const auto recorded = test::run_command("haptrial record " + file + " " + out + ".h5");
  EXPECT_EQ(recorded.status, 1);
  EXPECT_NE(test::run_command("ls " + out + ".h5.partial").status, 0);
}

/// Nothing is stated of samples that never came.
TEST_F(LiveChannelTest, AChannelWithoutASampleHasNeitherRateNorUncertainty) {
  const std::string file = study("path = \"/dev/nowhere\"\n");
  const std::string recorded = folder_ / "silent.h5";
  ASSERT_EQ(test::run_command("haptrial record " + file + " " + recorded + " --seconds 1").status,
            0);
  EXPECT_THAT(test::run_command("haptrial info " + recorded).output,
              AllOf(HasSubstr("channel     grip: 0 samples, 0 missing, 1 loss"),
                    Not(HasSubstr("simulated"))));
}

TEST_F(LiveChannelTest, RecordKeepsAChannelWithoutTrials) {
  const GripOnAPipe grip((folder_ / "pipe").string());
  const std::string out = folder_ / "grip.h5";
  const auto recorded = test::run_command("mkdir " + (folder_ / "disk").string() +
                                          "; haptrial record " + study(piped()) + " " + out +
                                          " --seconds 2 --backup " + (folder_ / "disk").string());
  ASSERT_EQ(recorded.status, 0) << recorded.errors;
  EXPECT_EQ(file_text(folder_ / "disk/squeeze/grip.h5"), file_text(out)) << "the backup";
  EXPECT_FALSE(grip_of(record::SessionReader(out)).empty());
  EXPECT_THAT(test::run_command("haptrial info " + out).output, HasSubstr("channel     grip"));
}

/// The check of the channel in the list of `start`.
nlohmann::json grip_check(const std::string& study, const std::string& out) {
  const auto printed =
      test::run_command("haptrial start " + study + " --check --json --out " + out);
  const auto json = nlohmann::json::parse(printed.output);
  for (const auto& check : json["checks"]) {
    if (check["what"].get<std::string>().starts_with("channel")) {
      return check;
    }
  }
  return {};
}

TEST_F(LiveChannelTest, TheChecklistBeforeASessionListensToTheChannel) {
  const std::string out = folder_ / "out";
  {
    const GripOnAPipe grip((folder_ / "pipe").string());
    const auto answers = grip_check(study(piped()), out);
    EXPECT_EQ(answers["state"], "ready") << answers;
    EXPECT_THAT(answers["found"].get<std::string>(), HasSubstr("answers"));
  }
  const auto silent = grip_check(study("path = \"/dev/nowhere\"\n"), out);
  EXPECT_EQ(silent["state"], "limited") << silent;
  EXPECT_THAT(silent["found"].get<std::string>(), HasSubstr("/dev/nowhere"));
  const auto needed = grip_check(study("path = \"/dev/nowhere\"\nrequired = true\n"), out);
  EXPECT_EQ(needed["state"], "broken") << needed;
}

}  // namespace
}  // namespace haptrial::experiments::channel_session_test
