// A pilot that is tuned while it runs: what its file holds, its replay, the page, the refusals.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "core/base/error.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/record/tool_rows.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/record/table/schema.h"
#include "experiments/console/console.h"
#include "experiments/runner/session.h"
#include "protocols/bone_drilling/bone_protocol.h"
#include "protocols/bone_drilling/bone_replay.h"
#include "protocols/bone_drilling/load_bones.h"
#include "protocols/bone_drilling/tuning_page.h"
#include "tests/experiments/browser.h"
#include "tests/experiments/command.h"
#include "tests/experiments/session_runs.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::tuning_session_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kGain = "tools.cutting.feel.second_gain";

std::shared_ptr<protocols::TuningPage> page_of(const protocols::BoneDefinition& definition) {
  return std::make_shared<protocols::TuningPage>(definition);
}

void ask(protocols::TuningPage& page, const std::string& key, double value) {
  page.ask(fmt::format(R"({{"key": "{}", "value": {}}})", key, value));
}

/// A pilot of a virtual hand on the simulated clock. @returns its file
fs::path run_pilot(const protocols::BoneDefinition& definition, const fs::path& file,
                   const std::shared_ptr<protocols::TuningPage>& page) {
  SessionRequest request = test::session_request(protocols::bone_drilling(), definition, file, 3);
  request.pilot = true;
  request.auxiliary_pages = {page};
  run_session(request);
  return file;
}

/// Contact forces of a session and of its replay. @returns the largest difference [N]
double largest_difference(const fs::path& file) {
  const protocols::BoneReplay replay(file);
  const auto tool = replay.reader().rows<record::ToolRow>();
  const std::uint64_t offset = tool.front().sequence;
  double largest = 0.0;
  const auto verdict =
      replay.run(1, [&](std::uint64_t, std::uint64_t sequence, const bone::DrillingView&,
                        const std::shared_ptr<const protocols::BoneStage>& stage) {
        const Eigen::Vector3d again = stage->simulator->output().force;
        largest = std::max(largest, (tool[sequence - offset].contact - again).norm());
      });
  EXPECT_EQ(verdict.difference, "");
  return largest;
}

class TuningSessionTest : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  fs::path study_{test::write_small_drilling(folder_.path(), 12.0)};
  protocols::BoneDefinition definition_{protocols::load_bone_definition(study_)};
  std::shared_ptr<protocols::TuningPage> page_{page_of(definition_)};
};

TEST_F(TuningSessionTest, ChangesAreRowsAndAReplayGivesTheSameForces) {
  ask(*page_, kGain, 4e9);
  std::atomic<bool> ended{false};
  std::thread teacher([&] {  // whenever it comes: the rows say on which tick
    for (int n = 0; !ended; ++n) {
      ask(*page_, kGain, n % 2 == 0 ? 1.5e9 : 3e9);
      ask(*page_, "tools.cutting.removal_rate", n % 2 == 0 ? 40.0 : 10.0);
      std::this_thread::yield();
    }
  });
  const fs::path file = run_pilot(definition_, folder_ / "S01.h5", page_);
  ended = true;
  teacher.join();
  const record::SessionReader reader(file);
  const record::Integrity integrity =
      record::check_session(reader, protocols::bone_drilling().tables());
  EXPECT_TRUE(integrity.ok) << integrity.problems.front();
  EXPECT_TRUE(reader.info().pilot);
  const auto rows = reader.rows<record::TuningRow>();
  ASSERT_GT(rows.size(), 10U);
  EXPECT_EQ(rows.front().key, kGain);
  EXPECT_EQ(rows.front().before, 2e9 * 2.0 / 3.0);  // 4e6 N/m^2 over a radius of 3 mm
  EXPECT_EQ(rows.front().after, 4e9);
  EXPECT_GT(reader.rows<record::ProcedureRow>().front().emptied, 20U);
  EXPECT_LT(largest_difference(file), 1e-3) << "the file has forces rounded";
  const auto replayed = test::run_command("haptrial replay '" + file.string() + "'");
  EXPECT_EQ(replayed.status, 0) << replayed.errors;
  EXPECT_THAT(replayed.output, HasSubstr("the same bone, 12000 ticks"));
}

TEST_F(TuningSessionTest, ATunedPilotIsAsOneWithTheSavedDefinition) {
  ask(*page_, kGain, 4e9);
  ask(*page_, "tools.cutting.removal_rate", 60.0);
  const fs::path tuned = run_pilot(definition_, folder_ / "S01.h5", page_);
  const fs::path saved = folder_ / "saved.toml";
  test::write_text(saved, page_->tuning()->view().text);
  const auto again = protocols::load_bone_definition(saved);
  const fs::path made = run_pilot(again, folder_ / "S02.h5", page_of(again));
  const auto checksum = [](const fs::path& file) {
    return record::SessionReader(file).rows<record::ProcedureRow>().front().checksum;
  };
  EXPECT_EQ(checksum(tuned), checksum(made)) << "the hand is in the air for the first half second";
  EXPECT_TRUE(record::SessionReader(made).rows<record::TuningRow>().empty());
  const auto valid = test::run_command("haptrial validate '" + saved.string() + "'");
  EXPECT_EQ(valid.status, 0) << valid.errors;
  const auto dry = test::run_command("haptrial dry-run '" + saved.string() + "' --out '" +
                                     (folder_ / "dry").string() + "'");
  EXPECT_EQ(dry.status, 0) << dry.errors;
}

TEST_F(TuningSessionTest, OnlyAPilotIsTunedOrHasOtherKeys) {
  const std::string run =
      "haptrial run '" + study_.string() + "' --out '" + (folder_ / "out").string() + "' ";
  const auto page = test::run_command(run + "--console --side-page tuning");
  EXPECT_EQ(page.status, 2);
  EXPECT_THAT(page.errors, HasSubstr("--side-page tuning changes the definition"));
  EXPECT_THAT(page.errors, HasSubstr("add --pilot"));
  const auto set = test::run_command(run + "--set drilling.force_limit=4");
  EXPECT_EQ(set.status, 2);
  EXPECT_THAT(set.errors, HasSubstr("--set is given without --pilot"));
  const auto bad = test::run_command(run + "--pilot --set drilling.force_limit=-4");
  EXPECT_EQ(bad.status, 2);
  EXPECT_THAT(bad.errors, HasSubstr("drilling.force_limit is -4; allowed: a number"));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(TuningSessionTest, APilotHasTheKeysThatItIsGiven) {
  const fs::path out = folder_ / "out";
  const auto ran = test::run_command(
      "haptrial run '" + study_.string() + "' --out '" + out.string() +
      "' --pilot --subject P01 --device virtual --set drilling.time_limit=0.3 --set " +
      "tools.cutting.feel.second_gain=3e9");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const record::SessionReader reader(out / "P01.h5");
  EXPECT_TRUE(reader.info().pilot);
  EXPECT_THAT(reader.info().definition, HasSubstr("second_gain = 3e9"));
}

TEST_F(TuningSessionTest, ATunedPilotIsNotResumed) {
  ask(*page_, kGain, 4e9);
  const fs::path file = run_pilot(definition_, folder_ / "S01.h5", page_);
  protocols::SessionPlace place;
  place.subject = "S01";
  protocols::give_seeds(place);
  const auto trials = protocols::bone_drilling().trials(definition_, place);
  try {
    trials->check_resumed(record::SessionReader(file));
    FAIL() << "resumed";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("a tuned pilot is not resumed"));
  }
}

/// A teacher at the page while a pilot runs: changes reach the values, a refusal is said, the
/// definition is saved.
TEST(TuningBrowserTest, ATeacherTunesAndSaves) {
  const test::TemporaryFolder folder;
  const auto definition =
      protocols::load_bone_definition(test::write_small_drilling(folder.path(), 1.0));
  const auto page = page_of(definition);
  SessionControl control;
  ConsoleOptions options;
  options.sides = {page};
  auto console = std::make_unique<Console>(control, options);
  const int status =
      test::run_browser("tuning_browser.py", {console->side_url("tuning"), folder.path().string()},
                        [&](const std::string& line) {
                          ASSERT_EQ(line, "CLOSE\n");
                          console.reset();
                        });
  EXPECT_EQ(status, 0);
  const auto view = page->tuning()->view();
  EXPECT_GT(view.changes, 0U);
  const auto saved = protocols::load_bone_definition(folder / "study_tuned.toml");
  EXPECT_EQ(saved.simulator.tools[0].as<bone::BurrTool>()->feel.force_limit, 7.5);
  if (const char* kept = std::getenv("HAPTRIAL_KEEP_PICTURES")) {
    for (const char* picture : {"tuning.png", "tuning-narrow.png"}) {
      fs::copy_file(folder / picture, fs::path(kept) / picture,
                    fs::copy_options::overwrite_existing);
    }
  }
}

}  // namespace
}  // namespace haptrial::experiments::tuning_session_test
