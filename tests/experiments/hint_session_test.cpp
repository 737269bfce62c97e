// Live hints from experts' sessions through a file into a trainee's, its replay and its report. All
// simulated.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "analysis/bone_drilling/feedback/findings.h"
#include "core/bone/hint/hint_rows.h"
#include "core/bone/model/distance_field.h"
#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "experiments/studies/drilling/expert_sessions.h"
#include "experiments/studies/drilling/procedure_setup.h"
#include "protocols/bone_drilling/bone_protocol.h"
#include "protocols/bone_drilling/bone_replay.h"
#include "protocols/bone_drilling/display/bone_pictures.h"
#include "protocols/bone_drilling/replayed_signals.h"
#include "tests/experiments/command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/replaced.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::hint_session_test {
namespace {

namespace fs = std::filesystem;
namespace drilling = analysis::drilling;
using record::HintRow;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// The shipped study of validity on a coarse bone, in short.
std::string short_study(double seconds) {
  std::string text =
      test::read_text(fs::path(HAPTRIAL_SOURCE_DIR) / "experiments/construct_validity.toml");
  text = test::replaced(text, "time_limit = 500.0", "time_limit = " + std::to_string(seconds));
  text = test::replaced(text, "seed = 1 ", "spacing = 0.0008\nseed = 1 ");
  text = test::replaced(text, "card = true", "card = false");
  return test::replaced(text, "vibration_gain = 1.0", "vibration_gain = 0.0");
}

/// Two surgeons, one procedure each, as experts to learn from.
std::string experts_text() {
  std::string text = short_study(60.0);
  text = test::replaced(text, "participants = 15", "participants = 2");
  text = test::replaced(text, "procedures = 2 ", "procedures = 1 ");
  text = test::replaced(text, "break_after = 1", "break_after = 0");
  text = test::replaced(text, "surgeons = 4\nresidents = 4\nnovices = 7", "surgeons = 2");
  return test::replaced(text, "surgeons = 0.9\nresidents = 0.65\nnovices = 0.15", "surgeons = 0.9");
}

/// A trainee without much skill, with hints in every other procedure.
std::string trainee_text(const std::string& hints, const std::string& heeds) {
  std::string text = short_study(30.0);
  text = test::replaced(text, "participants = 15", "participants = 2");
  text = test::replaced(text, "[groups]", "[hints]\n" + hints + "\n[groups]");
  text = test::replaced(text, "surgeons = 4\nresidents = 4\nnovices = 7", "novices = 2");
  text = test::replaced(text, "[virtual_surgeons.skill]",
                        "heeds_hints = " + heeds + "\n[virtual_surgeons.skill]");
  return test::replaced(text, "surgeons = 0.9\nresidents = 0.65\nnovices = 0.15", "novices = 0.15");
}

class HintSessionTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    write("experts.toml", experts_text());
    good("dry-run experts.toml --out experts");
    good("bone safe safe.toml --study experts");
    write("trainee.toml",
          trainee_text("file = \"safe.toml\"\nshown_in = \"every other\"\nsound = true\n"
                       "hidden_text = \"Da ist Knochen davor\"\n",
                       "1.0"));
    good("dry-run trainee.toml --out trainee");
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static void write(const std::string& name, const std::string& text) {
    test::write_text(*folder_ / name, text);
  }
  static test::CommandResult run(const std::string& arguments) {
    return test::run_command("cd '" + folder_->path().string() + "'; haptrial " + arguments);
  }
  static std::string good(const std::string& arguments) {
    const test::CommandResult result = run(arguments);
    EXPECT_EQ(result.status, 0) << arguments << "\n" << result.errors;
    return result.output + result.errors;
  }
  static fs::path session(const char* subject = "S01") {
    return fs::path(*folder_ / "trainee") / (std::string(subject) + ".h5");
  }
  static std::unique_ptr<test::TemporaryFolder> folder_;
};
std::unique_ptr<test::TemporaryFolder> HintSessionTest::folder_;

TEST_F(HintSessionTest, SafeValuesAreLearnedAndMarkedAsSimulated) {
  const hint::SafeLimits limits = hint::load_safe_limits(*folder_ / "safe.toml");
  EXPECT_EQ(limits.study, "construct_validity");
  EXPECT_EQ(limits.participants, 2u);
  EXPECT_EQ(limits.procedures, 2u);
  EXPECT_TRUE(limits.simulated);
  EXPECT_FALSE(limits.structures.empty());
  EXPECT_THAT(good("bone safe again.toml --study experts"), HasSubstr("simulated ones"));
  EXPECT_EQ(test::read_text(*folder_ / "again.toml"), test::read_text(*folder_ / "safe.toml"));
  const auto refusal = [](const std::string& arguments, const std::string& sentence) {
    const test::CommandResult result = run(arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_THAT(result.errors, HasSubstr(sentence));
  };
  refusal("bone safe safe.toml --study experts", "exists already");
  refusal("bone safe other.toml", "nobody is named to learn from");
  refusal("bone safe other.toml --study trainee", "holds no drilling of an expert");
  EXPECT_FALSE(fs::exists(*folder_ / "other.toml"));
}

TEST_F(HintSessionTest, TheDefinitionSaysWhatIsHinted) {
  const std::string told = good("validate trainee.toml");
  EXPECT_THAT(told, HasSubstr("hints: force, speed, hidden, shown in every other one; safe values "
                              "of 2 experts (safe.toml of construct_validity)"));
  EXPECT_THAT(told, HasSubstr("learned from simulated experts"));
  write("bad.toml", trainee_text("file = \"none.toml\"\n", "1.0"));
  const test::CommandResult missing = run("validate bad.toml");
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.errors, HasSubstr("none.toml"));
}

TEST_F(HintSessionTest, TheFileHoldsEveryHintAndTheValuesItWentBy) {
  const record::SessionReader reader(session());
  const record::Integrity integrity =
      record::check_session(reader, protocols::bone_drilling().tables());
  EXPECT_TRUE(integrity.ok) << integrity.problems.front();
  EXPECT_EQ(reader.rows<record::HintLimitRow>(),
            record::limit_rows(hint::load_safe_limits(*folder_ / "safe.toml")));
  const std::vector<record::PassRow> passes = reader.passes();
  ASSERT_EQ(passes.size(), 2u);
  EXPECT_EQ(passes[0].condition, "hints on");
  EXPECT_EQ(passes[1].condition, "hints off");
  EXPECT_EQ(record::SessionReader(session("S02")).passes()[0].condition, "hints off");
  const std::vector<HintRow> hints = reader.rows<HintRow>();
  ASSERT_GT(hints.size(), 4u);
  for (const HintRow& row : hints) {
    const bool first = row.begin <= passes[0].last_sample;
    EXPECT_EQ(row.shown, first);
    EXPECT_LE(row.begin, row.sequence);
    EXPECT_LE(row.sequence, passes[first ? 0 : 1].last_sample);
    EXPECT_GE(row.removals, 3);
    if (row.kind == hint::HintKind::kForce) {
      EXPECT_GT(row.force, row.limit_force);
      EXPECT_LE(row.distance, 5e-3);
      EXPECT_FALSE(row.structure.empty());
    }
  }
}

/// The page for trainees finds the same faults in the file, by a way of its own.
TEST_F(HintSessionTest, HintsAreAboutTheRemovalsThatThePageCallsFaulty) {
  drilling::StudyBones bones;
  const drilling::SafeOptions options;
  ExpertSessions experts(options, bones);
  experts.add_study(*folder_ / "experts");
  const auto learned = drilling::experts_of(experts.for_feedback(), "", options);
  const record::SessionReader reader(session());
  const auto setup = procedure_setup(reader);
  const std::vector<HintRow> hints = reader.rows<HintRow>();
  std::map<hint::HintKind, int> compared;
  for (const drilling::Procedure& procedure : load_procedures(reader, setup, &bones)) {
    const drilling::Findings f = drilling::findings_of(procedure, learned, bones, options);
    const auto& ticks = procedure.ticks;
    for (const HintRow& row : hints) {
      if (row.begin < ticks.front().sequence || row.begin > ticks.back().sequence) {
        continue;
      }
      const std::uint8_t fault = row.kind == hint::HintKind::kForce   ? drilling::kForceFault
                                 : row.kind == hint::HintKind::kSpeed ? drilling::kSpeedFault
                                                                      : drilling::kHiddenFault;
      int faulty = 0;
      for (std::size_t n = 0; n < procedure.removals.size(); ++n) {
        const std::uint64_t at = procedure.removals[n].sequence;
        const bool near = row.kind == hint::HintKind::kHidden ||
                          (f.nearest[n].structure >= 0 && f.nearest[n].at.distance <= 5e-3F);
        faulty += (f.faults[n] & fault) != 0 && near && at >= row.begin && at <= row.sequence;
      }
      // Two that came before the one that began it belong to it, some on the same tick.
      EXPECT_GE(faulty, row.removals - 2);
      EXPECT_LE(faulty, row.removals);
      ++compared[row.kind];
    }
  }
  EXPECT_GT(compared[hint::HintKind::kForce] + compared[hint::HintKind::kSpeed], 0);
  EXPECT_GT(compared[hint::HintKind::kHidden], 0);
}

TEST_F(HintSessionTest, AReplayShowsTheSameHintsInTheParticipantsWords) {
  const protocols::BoneReplay replay(session());
  protocols::ReplayedHints hints{record::SessionReader(session())};
  std::vector<HintRow> shown;
  for (const HintRow& row : record::SessionReader(session()).rows<HintRow>()) {
    if (row.shown) {
      shown.push_back(row);
    }
  }
  ASSERT_FALSE(shown.empty());
  const std::uint64_t first = std::ranges::min_element(shown, {}, &HintRow::begin)->begin;
  std::unique_ptr<protocols::BoneRenderer> renderer;
  const auto amber = [&renderer](const bone::DrillingView& seen) {
    const render::Image image = renderer->draw(seen);
    int count = 0;
    for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
      count += image.rgb[i] > 200 && image.rgb[i + 1] > 130 && image.rgb[i + 1] < 210 &&
                       image.rgb[i + 2] < 80
                   ? 1
                   : 0;
    }
    return count;
  };
  std::vector<std::string> vital;
  std::uint64_t ticks = 0, on = 0;
  const auto verdict = replay.run(1, [&](std::uint64_t, std::uint64_t sequence,
                                         const bone::DrillingView& seen, const auto& stage) {
    if (vital.empty()) {
      vital = bone::vital_structures(*stage->model);
      renderer = std::make_unique<protocols::BoneRenderer>(replay.definition(), stage);
    }
    const bone::DrillingView view = hints.with(seen, sequence, vital);
    std::uint8_t expected = 0;
    for (const HintRow& row : shown) {
      if (row.begin <= sequence && sequence < row.sequence) {
        expected = static_cast<std::uint8_t>(expected | hint::bit(row.kind));
      }
    }
    EXPECT_EQ(view.hints, expected);
    ++ticks;
    on += expected != 0 ? 1 : 0;
    if (sequence + 1 == first) {
      EXPECT_LT(amber(view), 50);
    } else if (sequence == first) {
      EXPECT_GT(amber(view), 5000);
    }
  });
  EXPECT_EQ(verdict.difference, "");
  EXPECT_GT(on, 100u);
  EXPECT_LT(on, ticks);
  EXPECT_EQ(hint::hint_text(*replay.definition().hints, hint::HintKind::kHidden, ""),
            "Da ist Knochen davor");
  EXPECT_THAT(good("replay trainee/S01.h5 --sound hints.wav"), HasSubstr("the same bone"));
}

TEST_F(HintSessionTest, AReportComparesProceduresWithHintsAndWithout) {
  const std::string told = good("analyze trainee");
  EXPECT_THAT(told, HasSubstr("Simulated: hints on: "));
  const std::string text = test::read_text(*folder_ / "trainee/report.md");
  EXPECT_THAT(text, AllOf(HasSubstr("Hints (simulated)"), HasSubstr("SIMULATED"),
                          HasSubstr("hints a minute of drilling"), HasSubstr("p after Holm")));
  EXPECT_THAT(test::read_text(*folder_ / "trainee/hints.csv"),
              HasSubstr("S01.h5,S01,novices,1,1,\"hints on\",1,"));
  EXPECT_THAT(test::read_text(*folder_ / "trainee/statistics.json"),
              HasSubstr("\"with_less_without\""));
}

TEST_F(HintSessionTest, WhoHeedsHintsGetsFewerOfThem) {
  const auto hints_with = [](const std::string& heeds) {
    write("all.toml", trainee_text("file = \"safe.toml\"\n", heeds));
    const std::string out = "all-" + heeds;
    good("dry-run all.toml --out " + out);
    std::size_t count = 0;
    for (const char* subject : {"S01.h5", "S02.h5"}) {
      count += record::SessionReader(fs::path(*folder_ / out) / subject).rows<HintRow>().size();
    }
    return count;
  };
  const std::size_t heeding = hints_with("1.0");
  const std::size_t deaf = hints_with("0.0");
  RecordProperty("heeding", static_cast<int>(heeding));
  RecordProperty("deaf", static_cast<int>(deaf));
  EXPECT_LT(heeding, deaf);
}

TEST_F(HintSessionTest, HintsThatAreOnlyRecordedChangeNothing) {
  const auto briefly = [](const std::string& text) {
    return test::replaced(text, "time_limit = 30.", "time_limit = 10.");
  };
  write("none.toml", briefly(trainee_text("file = \"safe.toml\"\nshown_in = \"none\"\n", "1.0")));
  write("plain.toml", briefly(test::replaced(trainee_text("", "1.0"), "[hints]\n", "")));
  good("dry-run none.toml --subjects 1 --out none");
  good("dry-run plain.toml --subjects 1 --out plain");
  const record::SessionReader none(*folder_ / "none/S01.h5");
  const record::SessionReader plain(*folder_ / "plain/S01.h5");
  EXPECT_FALSE(plain.has(record::table_of<HintRow>())) << "off by default";
  EXPECT_EQ(plain.passes()[0].condition, "drilling");
  EXPECT_EQ(none.passes()[0].condition, "hints off");
  EXPECT_GT(none.rows<HintRow>().size(), 0u);
  const auto removed = [](const record::SessionReader& reader) {
    return reader.rows<record::RemovalRow>().size();
  };
  EXPECT_EQ(removed(none), removed(plain));
  EXPECT_EQ(none.rows<record::ProcedureRow>().back().checksum,
            plain.rows<record::ProcedureRow>().back().checksum);
}

}  // namespace
}  // namespace haptrial::experiments::hint_session_test
