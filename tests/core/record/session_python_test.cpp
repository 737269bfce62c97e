#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "core/bone/hint/hint_rows.h"
#include "core/bone/nerve/nerve_rows.h"
#include "core/bone/record/bone_rows.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/tool_rows.h"
#include "core/bone/region/forbidden_region.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/rows/common_tables.h"
#include "core/subject/drilling/work_row.h"
#include "tests/core/record/session_fixture.h"

namespace haptrial::record {
namespace {

void write_csv(const std::filesystem::path& path, const std::vector<Sample>& samples) {
  std::ofstream out(path);
  out << "sequence,time_ns,pass,stage,position_x,position_y,position_z,velocity_x,velocity_y,"
         "velocity_z,force_x,force_y,force_z,applied_force,target_force,saturated\n";
  for (const Sample& s : samples) {
    out << fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", s.sequence, s.time_ns,
                       s.pass, static_cast<int>(s.stage), s.position.x(), s.position.y(),
                       s.position.z(), s.velocity.x(), s.velocity.y(), s.velocity.z(), s.force.x(),
                       s.force.y(), s.force.z(), s.applied_force, s.target_force,
                       static_cast<int>(s.saturated));
  }
}

// Written by hand from the rows below: the file is compared with the source, not with a reader.
constexpr const char* kExpected = R"({
"attributes": {"schema_version": 5, "program_version": "0.1.0", "program_commit": "0123abc",
  "definition": "[trajectory]\nspeed = 0.016  # größer als 0\n", "definition_name": "recall.toml",
  "subject": "P07", "seed": 18364758544493064720, "device": "virtual", "device_max_force": 8.5,
  "device_workspace_radius": 0.16, "clock": "simulated", "rate": 1000.0,
  "start_utc": "2026-11-20T09:30:00Z", "simulated": 1,
  "participant_identifier": "P07", "participant_handedness": "right",
  "participant_age_band": "18-25", "participant_sex": "", "participant_consent_confirmed": "yes",
  "participant_notes": "trägt Brille"},
"counts": {"ticks": 9001, "overruns": 3, "dropped": 0},
"trials": [[1, "haptic", "training", 1, 1, 18446744073709551615, 0, 4500, "completed", 1, 1],
           [1, "größe", "test", 1, 1, 7, 4501, 8999, "aborted", 0, 2]],
"events": [[-5, "session_start", "Grüße", 0], [9000000000, "fault", "", 0]],
"stimuli": [[1, 0.0, 0.1, -0.2, 0.3, 1.5], [1, 0.001, 0.1, -0.2, 0.30000000000000004, 1.25]],
"frames": [[16666667, 2000000, 0], [50000000, 3500000, 1]],
"timing": [[-1000, 0, 1, 2, 3], [0, 1000, 4, 5, 6]],
"begun": [[0, 1, "haptic", "training", 1, 1, 18446744073709551615, 1, 3]],
"runs": [[1, 0, 0, 0, 0, 36, "running"], [1, 0, 9001, 3, 0, 36, "ended"]]})";

/// A session that h5py is to read. @param drills  with the tables of drillings
void expect_that_python_reads(bool drills) {
  const test::TemporaryFolder folder;
  const std::vector<Sample> samples = test::hand_motion(9001, 3);
  const std::vector<BoneRecord> bones{test::small_bone()};
  TableList own = with_tables(with_tables(drilling_tables(), nerve_tables()), hint_tables());
  own.push_back(&table_of<TearRow>());
  own.push_back(&table_of<LedRow>());
  own.push_back(&table_of<SecondHandRow>());
  own.push_back(&table_of<ToolContactRow>());
  own.push_back(&table_of<OpeningRow>());
  own.push_back(&table_of<FieldRow>());
  own.push_back(&table_of<PieceRow>());
  own.push_back(&table_of<ScrewRow>());
  own.push_back(&table_of<WorkRow>());
  own.push_back(&table_of<CrossingRow>());
  own.push_back(&table_of<BurrRow>());
  own.push_back(&table_of<HandpieceRow>());
  SessionWriter writer =
      drills ? SessionWriter(folder / "session.h5", test::example_info(), own, rows_of(bones))
             : SessionWriter(folder / "session.h5", test::example_info());
  writer.set_planned(36);
  writer.note_counts({0, 0, 0});
  PassRow begun{1, "haptic", Phase::kTraining, 1, 1, ~std::uint64_t{0}};
  begun.practice = true;
  begun.attempt = 3;
  writer.begin_pass({0, begun});
  writer.append(std::span(samples).first(5000));
  writer.flush();  // the unfinished chunk is written twice
  writer.append(std::span(samples).subspan(5000));
  writer.add_pass({1, "haptic", Phase::kTraining, 1, 1, ~std::uint64_t{0}, 0, 4500,
                   PassStatus::kCompleted, true});
  writer.add_pass({1, "größe", Phase::kTest, 1, 1, 7, 4501, 8999, PassStatus::kAborted, false, 2});
  writer.add_event({-5, "session_start", "Grüße"});
  writer.add_event({9000000000, "fault", ""});
  writer.add_stimulus(std::vector<StimulusRow>{{1, 0.0, {0.1, -0.2, 0.3}, 1.5},
                                               {1, 0.001, {0.1, -0.2, 0.1 + 0.2}, 1.25}});
  writer.add_frames(std::vector<FrameRow>{{16666667, 2000000, 0}, {50000000, 3500000, 1}});
  writer.set_timing(std::vector<TimingRow>{{-1000, 0, 1, 2, 3}, {0, 1000, 4, 5, 6}}, {9001, 3, 0});
  writer.close();
  write_csv(folder / "samples.csv", samples);
  std::ofstream(folder / "expected.json") << kExpected;
  const std::string command = fmt::format(
      "/usr/bin/python3 {0}/tests/core/record/read_session.py {1} {0}/docs/"
      "session-file.md",
      HAPTRIAL_SOURCE_DIR, folder.path().string());
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
}

TEST(SessionPythonTest, ReadsWithH5pyAndPandasAsTheDocumentSays) {
  expect_that_python_reads(false);
}

TEST(SessionPythonTest, ReadsDrillingsAsTheDocumentSays) { expect_that_python_reads(true); }

}  // namespace
}  // namespace haptrial::record
