#include "analysis/exchange/export_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "analysis/force_training/score/scores_csv.h"
#include "core/base/file_text.h"
#include "tests/analysis/exchange/small_session.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::exchange::export_csv_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

void ignore(std::uint64_t) {}

/// Holds the tables against the session file, and the dictionary against the tables.
const char* const kCheck = R"(
import json, pathlib, sys
import h5py, numpy as np, pandas as pd

def check_devices(file, samples, columns):
    rows = file["devices"][:] if "devices" in file else np.empty(0, dtype=[("device", "i4")])
    devices = np.unique(rows["device"])
    names = [name for name in rows.dtype.names if name not in ("sequence", "device")]
    assert columns == [f"device_{d}_{name}" for d in devices for name in names]
    for device in devices:
        own = rows[rows["device"] == device]
        there = samples.sequence.isin(own["sequence"]).to_numpy()
        assert there.sum() == len(own) and not there.all()
        for name in names:
            theirs = samples[f"device_{device}_{name}"]
            assert np.array_equal(theirs[there].to_numpy().astype(own[name].dtype), own[name]), name
            assert theirs[~there].isna().all(), name

root = pathlib.Path(sys.argv[1])
dictionary = json.loads((root / "dictionary.json").read_text())
sessions = pd.read_csv(root / "sessions.csv")
for what, description in dictionary["files"].items():
    for path in root.glob(what):
        assert list(pd.read_csv(path, nrows=1).columns) == list(description["columns"]), path
assert dictionary["simulated"] == bool(sessions.simulated.any())
trials = pd.read_csv(root / "trials.csv")
events = pd.read_csv(root / "events.csv")
for row, name in zip(sessions.itertuples(), sys.argv[2:]):
    with h5py.File(name) as file:
        theirs = file["trials"][:]
        ours = trials[(trials.subject == row.subject) & (trials.session == row.session)]
        assert len(ours) == len(theirs)
        for column in theirs.dtype.names:
            values = theirs[column]
            values = [v.decode() for v in values] if values.dtype.kind == "S" else values
            assert (ours[column].to_numpy() == values).all(), column
        assert np.allclose(ours.onset * file.attrs["rate"], theirs["first_sample"], 0, 1e-6)
        assert (ours.simulated == bool(file.attrs["simulated"])).all()
        assert row.rate == file.attrs["rate"] and row.samples == len(file["samples"])
        notes = events[(events.subject == row.subject) & (events.session == row.session)]
        assert [t.decode() for t in file["events"]["text"]] == list(notes.text)
        stem = row.subject if (sessions.subject == row.subject).sum() == 1 else \
            f"{row.subject}-{row.session}"
        samples = pd.read_csv(root / "samples" / f"{stem}.csv.gz", float_precision="round_trip")
        assert len(samples) == len(file["samples"])
        assert (np.round(samples.time * 1e9) == file["samples"]["time_ns"]).all()
        further = [column for column in samples.columns if column.startswith("device_")]
        check_devices(file, samples, further)
        for column in set(samples.columns) - {"time"} - set(further):
            value = file["samples"][column]
            assert np.array_equal(samples[column].to_numpy().astype(value.dtype), value,
                                  equal_nan=value.dtype.kind == "f"), column
        stimuli = pd.read_csv(root / "stimuli" / f"{stem}.csv.gz")
        for column in stimuli.columns:
            assert (stimuli[column].to_numpy() == file["stimuli"][column]).all(), column
print("equal")
)";

TEST(ExportCsvTest, PandasReadsWhatTheSessionFilesHold) {
  const test::TemporaryFolder folder;
  const std::vector<fs::path> files{folder / "1.h5", folder / "2.h5", folder / "3.h5"};
  write_session(files[0], {.subject = "P01", .note = "quotes \", commas, and\nlines"});
  write_session(files[1], {.subject = "P01",
                           .start_utc = "2026-11-21T09:30:00Z",
                           .gap_at = 1100,
                           .gap = 5,
                           .odd_values = true});
  write_session(files[2], {.subject = "P02", .simulated = false, .trials = 5});
  const auto done = export_csv(files, folder / "out", {.samples = true, .jobs = 2}, ignore);
  EXPECT_EQ(done.sessions, 3u);
  EXPECT_EQ(done.passes, 6u + 6u + 10u);
  std::ofstream(folder / "check.py") << kCheck;
  std::string line = "/usr/bin/python3 '" + (folder / "check.py").string() + "' '" +
                     (folder / "out").string() + "'";
  for (const auto& file : files) {
    line += " '" + file.string() + "'";
  }
  line += " >'" + (folder / "log").string() + "' 2>&1";
  EXPECT_EQ(std::system(line.c_str()), 0) << file_text(folder / "log");
}

TEST(ExportCsvTest, SamplesHaveEveryDevice) {
  const test::TemporaryFolder folder;
  const fs::path file = folder / "1.h5";
  write_session(file, {.subject = "P01", .gap_at = 1100, .gap = 5, .other_devices = 2});
  export_csv(std::vector{file}, folder / "out", {.samples = true}, ignore);
  std::ofstream(folder / "check.py") << kCheck;
  const std::string line = "/usr/bin/python3 '" + (folder / "check.py").string() + "' '" +
                           (folder / "out").string() + "' '" + file.string() + "' >'" +
                           (folder / "log").string() + "' 2>&1";
  EXPECT_EQ(std::system(line.c_str()), 0) << file_text(folder / "log");
}

TEST(ExportCsvTest, SamplesAreLeftOutUnlessAskedFor) {
  const test::TemporaryFolder folder;
  const std::vector<fs::path> files{folder / "1.h5"};
  write_session(files[0], {});
  EXPECT_EQ(export_csv(files, folder / "out", {}, ignore).samples, 0u);
  EXPECT_FALSE(fs::exists(folder / "out/samples"));
  EXPECT_THAT(file_text(folder / "out/dictionary.json"), testing::Not(HasSubstr("samples/*")));
  EXPECT_THAT(file_text(folder / "out/dictionary.json"), HasSubstr("\"simulated\": true"));
  EXPECT_THAT(file_text(folder / "out/trials.csv"),
              HasSubstr("\nP01,1,1,1,haptic,test,1,1,1,0,completed,9007199254740994,"));
}

/// The fields of each row of a table without quotes, by the names of its columns.
std::vector<std::map<std::string, std::string>> rows_of(const fs::path& file) {
  std::istringstream lines(file_text(file));
  const auto fields = [](const std::string& line) {
    std::vector<std::string> all(1);
    for (const char c : line) {
      c == ',' ? all.emplace_back() : all.back() += c;
    }
    return all;
  };
  std::string line;
  std::getline(lines, line);
  const auto names = fields(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(lines, line)) {
    const auto values = fields(line);
    EXPECT_EQ(values.size(), names.size()) << line;
    rows.emplace_back();
    for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) {
      rows.back()[names[i]] = values[i];
    }
  }
  return rows;
}

TEST(ExportCsvTest, AfterASuspensionOnsetsAreStillByTheClock) {
  const test::TemporaryFolder folder;
  const std::vector<fs::path> files{folder / "1.h5"};
  write_session(files[0], {.gap_at = 2500, .gap = 5, .late_at = 1500, .late_ns = 2'000'000'000});
  export_csv(files, folder / "out", {}, ignore);
  const auto rows = rows_of(folder / "out/trials.csv");
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(std::stod(rows[0].at("duration")), 2.2);
  EXPECT_EQ(std::stod(rows[1].at("onset")), 2.2);
  EXPECT_EQ(std::stod(rows[1].at("duration")), 4.2) << "the loop was suspended for 2 s in it";
  EXPECT_EQ(std::stod(rows[2].at("onset")), 6.4);
  EXPECT_EQ(std::stod(rows[2].at("duration")), 2.21) << "five ticks are missing in it";
  EXPECT_EQ(std::stod(rows[3].at("onset")), 8.61);
  EXPECT_EQ(std::stod(rows[3].at("duration")), 2.2);
}

TEST(ExportCsvTest, ASessionThatWasRecordedTwiceMovesNoOther) {
  const test::TemporaryFolder folder;
  const std::vector<fs::path> files{folder / "1.h5", folder / "again.h5", folder / "2.h5"};
  write_session(files[0], {.start_utc = "2026-11-20T09:30:00Z"});
  write_session(files[1], {.start_utc = "2026-11-21T09:30:00Z"});
  export_csv(std::vector{files[0], files[1]}, folder / "one", {},
             ignore);  // a study of one session
  EXPECT_EQ(rows_of(folder / "one/sessions.csv")[1].at("session"), "2");
  write_session(files[2], {.session = 2, .start_utc = "2026-11-27T09:30:00Z"});
  EXPECT_THAT(test::message_of<InputError>([&] { export_csv(files, folder / "two", {}, ignore); }),
              testing::AllOf(HasSubstr("again.h5: is session 1 of P01, as "),
                             HasSubstr("1.h5 is; give one of them")));
}

TEST(ExportCsvTest, SessionsSayWhoTookPartAndWhetherInAPilot) {
  const test::TemporaryFolder folder;
  const std::vector<fs::path> files{folder / "1.h5", folder / "2.h5"};
  write_session(files[0], {.subject = "P01", .person = {"P01", "left", "18-25", "female", "", ""}});
  write_session(files[1], {.subject = "P02", .trials = 2, .pilot = true});
  export_csv(files, folder / "out", {}, ignore);
  const auto sessions = rows_of(folder / "out/sessions.csv");
  ASSERT_EQ(sessions.size(), 2u);
  EXPECT_EQ(sessions[0].at("handedness"), "left");
  EXPECT_EQ(sessions[0].at("sex"), "female");
  EXPECT_EQ(sessions[0].at("age_band"), "18-25");
  EXPECT_EQ(sessions[0].at("pilot"), "false");
  EXPECT_EQ(sessions[0].at("passes"), "6");
  EXPECT_EQ(sessions[1].at("handedness"), "");
  EXPECT_EQ(sessions[1].at("pilot"), "true");
  for (const auto& trial : rows_of(folder / "out/trials.csv")) {
    EXPECT_EQ(trial.at("pilot"), trial.at("subject") == "P02" ? "true" : "false");
  }
}

TEST(ExportCsvTest, PracticeIsMarked) {
  const test::TemporaryFolder folder;
  const std::vector<fs::path> files{folder / "1.h5"};
  write_session(files[0], {.trials = 2, .practice = 2});
  export_csv(files, folder / "out", {.samples = true}, ignore);
  const auto trials = rows_of(folder / "out/trials.csv");
  ASSERT_EQ(trials.size(), 8u);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    EXPECT_EQ(trials[i].at("practice"), i < 4 ? "1" : "0");
    EXPECT_EQ(trials[i].at("block").starts_with('-'), i < 4);
  }
  const auto json = nlohmann::json::parse(file_text(folder / "out/dictionary.json"));
  const auto& levels = json["files"]["trials.csv"]["columns"]["practice"]["levels"];
  EXPECT_EQ(levels["1"], "practice, never scored");
}

TEST(ExportCsvTest, ASessionWithoutPassesIsListed) {
  const test::TemporaryFolder folder;
  const std::vector<fs::path> files{folder / "1.h5", folder / "2.h5", folder / "3.h5"};
  write_session(files[0], {.subject = "P01", .trials = 0});
  write_session(files[1], {.subject = "P02", .trials = 0, .ticks_of_no_pass = 30});
  write_session(files[2], {.subject = "P03"});
  const auto done = export_csv(files, folder / "out", {.samples = true}, ignore);
  EXPECT_EQ(done.sessions, 3u);
  EXPECT_EQ(done.samples, 30u + 6u * (kTicksOfPass + 100));
  const auto sessions = rows_of(folder / "out/sessions.csv");
  ASSERT_EQ(sessions.size(), 3u);
  EXPECT_EQ(sessions[0].at("passes"), "0");
  EXPECT_EQ(sessions[1].at("passes"), "0");
  EXPECT_EQ(sessions[1].at("samples"), "30");
  EXPECT_EQ(sessions[2].at("passes"), "6");
  EXPECT_TRUE(fs::exists(folder / "out/samples/P01.csv.gz"));
}

TEST(ExportCsvTest, TheDictionaryKnowsTheColumnsOfTheScores) {
  const test::TemporaryFolder folder;
  const std::vector<fs::path> files{folder / "1.h5"};
  write_session(files[0], {});
  export_csv(files, folder / "out", {}, ignore);
  const auto json = nlohmann::ordered_json::parse(file_text(folder / "out/dictionary.json"));
  std::string heading;
  for (const auto& [name, column] : json["files"]["scores.csv"]["columns"].items()) {
    heading += (heading.empty() ? "" : ",") + name;
  }
  std::vector<analysis::TrialScore> scores(2);  // with all columns that a study may have
  scores[0].path_error = 0.0;
  scores[1].session = 2;
  const std::string table = analysis::scores_csv(scores);
  EXPECT_EQ(heading, table.substr(0, table.find('\n')));
}

}  // namespace
}  // namespace haptrial::exchange::export_csv_test
