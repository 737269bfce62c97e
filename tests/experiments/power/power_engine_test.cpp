// The engine of simulated power with a study of its own: exact tests, parts, kills.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "analysis/power/power_report.h"
#include "analysis/statistics/tests/power.h"
#include "analysis/statistics/tests/t_tests.h"
#include "analysis/statistics/variance/repeated_anova.h"
#include "core/base/child_process.h"
#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "experiments/power/power_part.h"
#include "experiments/power/power_run.h"
#include "protocols/psychophysics/trials_protocol.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using testing::HasSubstr;

constexpr const char* kText = R"(
[experiment]
protocol = "trials"
name = "normal"
[design]
participants = 8
[[blocks]]
name = "main"
trials = 1
[variables]
effect = 0.0
[[stages]]
name = "rest"
until = { time = 0.1 }
[power]
watch = "paired t"
)";

/// Three values of each participant with the correlation 0.5; the report has a paired t test of the
/// first two and an analysis of variance of all.
class NormalStudySimulation final : public StudySimulation {
 public:
  explicit NormalStudySimulation(const protocols::Definition& definition) {
    Table root = definition.root();
    participants_ = definition.design.participants;
    effect_ = root.table("variables").number("effect", {}, "");
  }
  bool people_differ() const override { return true; }
  SimulatedStudy responses(std::uint64_t seed) const override {
    RandomStream random(seed, "normal");
    std::vector<std::vector<double>> rows;
    std::vector<double> a, b;
    for (long p = 0; p < participants_; ++p) {
      const double person = random.normal();
      const auto noise = [&] { return random.normal(); };
      rows.push_back(
          {person + noise(), person + effect_ + noise(), person + 0.5 * effect_ + noise()});
      a.push_back(rows.back()[0]);
      b.push_back(rows.back()[1]);
    }
    const auto t = analysis::paired_t_test(b, a, analysis::Tail::kTwoSided);
    const auto f = analysis::repeated_measures_anova(rows);
    return {{{"paired t", t->p}, {"anova", f->p}}, {{"paired t", t->difference}}, {}, 3, 0.1};
  }
  SimulatedStudy sessions(const std::vector<fs::path>&) const override { return {}; }

 private:
  long participants_{0};
  double effect_{0.0};
};

class NormalStudy final : public Study {
 public:
  const protocols::Protocol& protocol() const override { return protocols::trials_protocol(); }
  void add_preview(const protocols::Definition&, const PreviewRequest&, Preview&) const override {}
  std::vector<std::string> analyze(const AnalysisRequest&) const override { return {}; }
  std::unique_ptr<StudySimulation> study_simulation(const protocols::Definition& definition,
                                                    const std::string&,
                                                    const std::string&) const override {
    return std::make_unique<NormalStudySimulation>(definition);
  }
};

PowerQuestion question_of(int replications, const std::vector<double>& participants,
                          const std::vector<double>& effects) {
  static const NormalStudy study;
  PowerQuestion q;
  q.text = kText;
  q.parts = {{kText, "normal.toml"}};
  q.file_name = q.definition_name = "normal.toml";
  q.title = "normal";
  q.study = &study;
  q.fingerprint = "0123456789abcdef";
  q.plan.watch = "paired t";
  q.plan.replications = q.plan.null_replications = replications;
  q.plan.block = 50;
  q.plan.vary = {{"design.participants", participants, std::nullopt},
                 {"variables.effect", effects, 0.0}};
  for (const double n : participants) {
    q.cells.push_back({{n, 0.0}, true, false, "n " + std::to_string(n)});
  }
  for (const double n : participants) {
    for (const double effect : effects) {
      q.cells.push_back({{n, effect},
                         false,
                         false,
                         "n " + std::to_string(n) + " effect " + std::to_string(effect)});
    }
  }
  return q;
}

analysis::PowerResult simulated_in(const fs::path& folder, const PowerQuestion& q, int jobs) {
  const PowerFolder parts(folder, q);
  fill(parts, q, {jobs});
  return parts.merged();
}

TEST(PowerEngine, FindsTheNoncentralTAndFInFortyCells) {
  constexpr int kReplications = 1000;
  const TemporaryFolder folder;
  const PowerQuestion q =
      question_of(kReplications, {4, 6, 8, 12, 16}, {0.3, 0.6, 0.9, 1.2, 1.5, 1.8, 2.1, 2.4});
  const auto result = simulated_in(folder.path() / "power", q, 2);
  ASSERT_EQ(result.cells.size(), 40u);
  ASSERT_TRUE(analysis::is_power(result));
  int outside = 0;
  for (const analysis::PowerCell& cell : result.cells) {
    const double n = cell.levels[0], effect = cell.levels[1];
    // Differences have the variance 2. Means 0, effect, effect / 2: their sd by sqrt(2) is f.
    analysis::RepeatedPlan plan;
    plan.measurements = 3;
    const double t =
        *analysis::t_power({analysis::TDesign::kPaired, 0.05, false}, n, effect / std::sqrt(2.0));
    const double f = *analysis::repeated_power(plan, n, effect / std::sqrt(6.0) / std::sqrt(2.0));
    for (const auto& [name, power] :
         {std::pair<const char*, double>{"paired t", t}, {"anova", f}}) {
      const auto count = cell.counts.of(name);
      const auto band = analysis::binomial_band(count.made, power, 0.999);
      EXPECT_TRUE(band.holds(count.rejected))
          << name << " n " << n << " effect " << effect << ": " << count.rejected << " of "
          << count.made << ", expected " << power;
      outside += analysis::binomial_band(count.made, power, 0.95).holds(count.rejected) ? 0 : 1;
    }
  }
  EXPECT_LE(outside, 10) << "of 80 shares 4 are expected outside of their 95 % bands";
}

TEST(PowerEngine, GivesTheSameBytesForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const PowerQuestion q = question_of(200, {4, 8}, {0.5, 1.0});
  const auto first = analysis::power_json(simulated_in(folder.path() / "1", q, 1));
  for (const int jobs : {2, 7}) {
    EXPECT_EQ(analysis::power_json(simulated_in(folder.path() / std::to_string(jobs), q, jobs)),
              first);
  }
}

TEST(PowerEngine, GivesTheSameBytesInSharesOfAnyOrder) {
  const TemporaryFolder folder;
  const PowerQuestion q = question_of(200, {4, 8}, {0.5, 1.0});
  const auto first = analysis::power_json(simulated_in(folder.path() / "whole", q, 1));
  const PowerFolder parts(folder.path() / "shares", q);
  for (const int part : {3, 1, 2}) {
    fill(parts, q, {1, part, 3});
  }
  EXPECT_EQ(analysis::power_json(parts.merged()), first);
}

long count_parts(const fs::path& folder) {
  return fs::exists(folder)
             ? std::distance(fs::directory_iterator(folder), fs::directory_iterator())
             : 0;
}

TEST(PowerEngine, GivesTheSameBytesAfterTwentyKills) {
  const TemporaryFolder folder;
  const PowerQuestion q = question_of(4000, {4, 8}, {0.5, 1.0});
  const auto whole = analysis::power_json(simulated_in(folder.path() / "whole", q, 2));
  const long all = count_parts(folder.path() / "whole" / "parts");
  const fs::path killed = folder.path() / "killed";
  RandomStream random(7, "kills");
  std::size_t before = 0;
  int useful = 0;
  for (int kill = 0; kill < 20; ++kill) {
    ChildProcess child([&] {
      const PowerFolder parts(killed, q);
      fill(parts, q, {1});
    });
    const long more = count_parts(killed / "parts") + 1 + static_cast<long>(random.below(3));
    test::wait_until([&] { return count_parts(killed / "parts") >= std::min(more, all); });
    child.kill();
    child.wait();
    if (fs::exists(killed / "program")) {
      const PowerFolder parts(killed, q);
      const std::size_t made = parts.units().size() - parts.missing().size();
      EXPECT_GE(made, before) << "a part was lost";
      useful += made > before && !parts.missing().empty() ? 1 : 0;
      before = made;
    }
  }
  EXPECT_GE(useful, 1) << "no kill came in the middle";
  EXPECT_EQ(analysis::power_json(simulated_in(killed, q, 2)), whole);
  for (const auto& entry : fs::directory_iterator(killed / "parts")) {
    EXPECT_EQ(entry.path().extension(), ".part");
  }
}

TEST(PowerEngine, DoesOnlyWhatIsMissing) {
  const TemporaryFolder folder;
  const PowerQuestion q = question_of(200, {4, 8}, {0.5});
  const PowerFolder parts(folder.path() / "power", q);
  EXPECT_EQ(fill(parts, q, {1}).made, parts.units().size());
  EXPECT_EQ(fill(parts, q, {1}).made, 0u);
  fs::remove(parts.path() / "parts" / parts.units()[3].file());
  EXPECT_THROW(parts.merged(), InputError);
  EXPECT_EQ(fill(parts, q, {1}).made, 1u);
}

void expect_refused(const std::function<void()>& what, const std::string& words) {
  try {
    what();
    ADD_FAILURE() << "not refused: " << words;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(words));
  }
}

TEST(PowerFolder, RefusesWhatDoesNotBelongToIt) {
  const TemporaryFolder folder;
  const PowerQuestion q = question_of(100, {4}, {0.5});
  const fs::path path = folder.path() / "power";
  const PowerFolder parts(path, q);
  fill(parts, q, {1});
  PowerQuestion other = q;
  other.text += "# another\n";
  expect_refused([&] { PowerFolder(path, other); }, "parts of another definition");
  other = q;
  other.fingerprint = "f";
  expect_refused([&] { PowerFolder(path, other).merged(); }, "simulate into a new folder");
  const fs::path part = path / "parts" / parts.units()[0].file();
  std::ofstream(part, std::ios::app) << " ";
  expect_refused([&] { parts.merged(); }, "its checksum is another");
  std::ofstream(path / "program") << "haptrial 0.0.1 (old)\n";
  expect_refused([&] { PowerFolder(path, q); }, "was simulated by haptrial 0.0.1 (old)");
  expect_refused([&] { PowerFolder(folder.path(), q); }, "holds something else");
}

TEST(PowerEngine, NamesTheTestsThatThereAre) {
  PowerQuestion q = question_of(100, {4}, {0.5});
  check_watched(q);
  q.plan.watch = "sign test";
  expect_refused([&] { check_watched(q); }, "allowed: \"paired t\", \"anova\"");
}

}  // namespace
}  // namespace haptrial::experiments
