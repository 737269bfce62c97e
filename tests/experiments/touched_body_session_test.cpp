// A body that gives way, through a whole session: from the readings that are recorded follow the
// forces that were felt.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include "core/deformable/touch/ball_touch.h"
#include "core/deformable/touch/prepared.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/object_rows.h"
#include "core/record/rows/trial_rows.h"
#include "experiments/runner/session.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"
#include "protocols/psychophysics/definition/trials_definition.h"
#include "tests/experiments/session_runs.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::touched_body_session_test {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

/// lump_search whose contacts are recorded.
fs::path with_contacts(const fs::path& folder) {
  std::ifstream shipped(HAPTRIAL_SOURCE_DIR "/experiments/lump_search.toml");
  std::stringstream text;
  text << shipped.rdbuf();
  std::string all = text.str();
  const std::string limit = "limit = 6.0\n";
  all.replace(all.find(limit), limit.size(), limit + "record = true\n");
  fs::path file = folder / "lump_search.toml";
  std::ofstream(file) << all;
  return file;
}

void run(const Experiment& experiment, const fs::path& file) {
  SessionRequest request = test::session_request(experiment, file, 11);
  request.max_trials = 2;
  run_session(request);
}

double value_of(const record::SessionReader& file, std::int32_t pass, const std::string& name) {
  for (const record::VariableRow& row : file.rows<record::VariableRow>()) {
    if (row.pass == pass && row.name == name) {
      return row.value;
    }
  }
  ADD_FAILURE() << name;
  return 0.0;
}

/// The force on the tool at each tick of a stage from the readings alone, in the body's frame.
std::vector<Vector3d> felt_again(const record::SessionReader& file, const record::StageRow& stage,
                                 const protocols::TrialObject& object) {
  const double radius = value_of(file, stage.pass, "radius");
  const double depth = value_of(file, stage.pass, "depth");
  const deformable::Tissue tissue{
      15000.0, 0.45, 1000.0, {{"lump", {0.010, 0.012 - depth - radius, 0.010}, radius, 300000.0}}};
  deformable::BallTouch touch(deformable::prepared(object.felt, tissue),
                              {0.005, 5000.0, {0.3, 0.2}});
  const Eigen::Quaterniond turn(
      Eigen::AngleAxisd(value_of(file, stage.pass, "quarter"), Vector3d::UnitY()));
  std::vector<Vector3d> forces;
  for (const record::Sample& sample :
       file.samples(stage.first_sample, stage.last_sample - stage.first_sample + 1)) {
    const Vector3d tool = turn.conjugate() * sample.position;
    if (forces.empty()) {
      touch.start(tool);
    }
    forces.push_back(turn * touch.tick(tool, 0.001).force);
  }
  return forces;
}

TEST(TouchedBodySessionTest, TheRecordedReadingsGiveTheRecordedForces) {
  const test::TemporaryFolder folder;
  const Experiment experiment = load_experiment(with_contacts(folder.path()));
  run(experiment, folder / "S01.h5");
  const record::SessionReader file(folder / "S01.h5");
  const auto& d = dynamic_cast<const protocols::TrialsDefinition&>(*experiment.definition);
  const auto contacts = file.rows<record::ContactRow>();
  ASSERT_GT(contacts.size(), 1000u);
  std::size_t compared = 0;
  for (const record::StageRow& stage : file.rows<record::StageRow>()) {
    if (stage.stage != "palpate") {
      continue;
    }
    const std::vector<Vector3d> forces = felt_again(file, stage, d.objects.front());
    for (const record::ContactRow& row : contacts) {
      constexpr std::uint64_t kFadedIn = 100;  // [ticks]
      constexpr double kRounded = 0.01;        // most where friction slips a tick earlier [N]
      if (row.sequence >= stage.first_sample + kFadedIn && row.sequence <= stage.last_sample) {
        const Vector3d again = forces.at(row.sequence - stage.first_sample);
        EXPECT_LT((again - row.force).norm(), kRounded) << row.sequence;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 1000u);
}

TEST(TouchedBodySessionTest, TheSameSeedGivesTheSameContacts) {
  const test::TemporaryFolder folder;
  const Experiment experiment = load_experiment(with_contacts(folder.path()));
  run(experiment, folder / "S01.h5");
  run(experiment, folder / "again.h5");
  const auto first = record::SessionReader(folder / "S01.h5").rows<record::ContactRow>();
  const auto second = record::SessionReader(folder / "again.h5").rows<record::ContactRow>();
  EXPECT_TRUE(std::ranges::equal(first, second, [](const auto& a, const auto& b) {
    return a.sequence == b.sequence && a.force == b.force && a.proxy == b.proxy &&
           a.depth == b.depth && a.work == b.work;
  }));
}

}  // namespace
}  // namespace haptrial::experiments::touched_body_session_test
