// Hints of a definition.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/definition/schema.h"
#include "core/base/file_text.h"
#include "core/bone/hint/hint_setup.h"
#include "core/bone/hint/safe_limits.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::hint {
namespace {

using testing::HasSubstr;

HintSetup read(const std::string& lines) {
  Table root = Table::parse("[hints]\n" + lines, "study.toml");
  Table table = root.table("hints");
  HintSetup setup = hint_schema().read(table);
  root.finish();
  return setup;
}

TEST(HintSetupTest, HasDefaultsForAllButTheFile) {
  const HintSetup s = read("file = \"safe.toml\"\n");
  EXPECT_EQ(s.file, "safe.toml");
  EXPECT_TRUE(s.gives(HintKind::kForce) && s.gives(HintKind::kSpeed) && s.gives(HintKind::kHidden));
  EXPECT_EQ(s.shown, GivenIn{GivenIn::kAll});
  EXPECT_EQ(s.fewest, 3);
  EXPECT_FALSE(s.sound);
}

TEST(HintSetupTest, HintsOfWhatIsHiddenNeedNoFile) {
  const HintSetup s = read("kinds = [\"hidden\"]\nshown_in = \"every other\"\n");
  EXPECT_FALSE(s.gives(HintKind::kForce));
  EXPECT_TRUE(s.gives(HintKind::kHidden));
  EXPECT_EQ(s.shown, GivenIn{GivenIn::kEveryOther});
  const auto refusal = [](const std::string& lines) {
    return test::message_of([&] { read(lines); });
  };
  EXPECT_THAT(refusal(""), HasSubstr("haptrial bone safe"));
  EXPECT_THAT(refusal("kinds = [\"speed\"]\n"), HasSubstr("hints.file"));
  EXPECT_THAT(refusal("kinds = [\"sped\"]\n"), HasSubstr("\"speed\""));
  EXPECT_THAT(refusal("kinds = []\n"), HasSubstr("hints.kinds is an empty array"));
  EXPECT_THAT(refusal("file = \"s\"\nholds = 0.0\n"), HasSubstr("hints.holds"));
}

TEST(HintSetupTest, AMissingFileIsToldAsTheKeyThatNamesIt) {
  HintSetup s = read("file = \"none.toml\"\n");
  EXPECT_THAT(test::message_of([&] { load_limits(s, "/nowhere"); }),
              HasSubstr("hints.file: /nowhere/none.toml: no such file; haptrial bone safe"));
}

TEST(HintSetupTest, TextsMayNameTheStructure) {
  const HintSetup s =
      read("file = \"s\"\nforce_text = \"Leichter! ({structure})\"\nhidden_text = \"Verdeckt\"\n");
  EXPECT_EQ(hint_text(s, HintKind::kForce, "facial nerve"), "Leichter! (facial nerve)");
  EXPECT_EQ(hint_text(s, HintKind::kHidden, "facial nerve"), "Verdeckt");
  EXPECT_EQ(hint_text(s, HintKind::kSpeed, "dura"), "Slow down (near dura)");
  EXPECT_EQ(hint_text(read("file = \"s\"\nspeed_text = \"{structure}! {structure}!\"\n"),
                      HintKind::kSpeed, "dura"),
            "dura! dura!");
}

// Safe values on their way through a file.

SafeLimits made_up() {
  SafeLimits limits;
  limits.study = "construct_validity";
  limits.participants = 2;
  limits.procedures = 3;
  limits.simulated = true;
  limits.structures = {{"facial nerve", {{0.0, 0.002, 0.1 + 0.2, 0.01}, {0.004, 0.006, 1.0, 0.02}}},
                       {"dura", {{0.002, 0.004, 2.0, 1.0 / 3.0}}}};
  return limits;
}

class SafeLimitsTest : public testing::Test {
 protected:
  std::string refusal(const std::string& text) const {
    write_text(folder_ / "safe.toml", text);
    return test::message_of([&] { load_safe_limits(folder_ / "safe.toml"); });
  }
  test::TemporaryFolder folder_;
};

TEST_F(SafeLimitsTest, ComeOutOfTheFileToTheBit) {
  const SafeLimits before = made_up();
  write_text(folder_ / "safe.toml", safe_limits_text(before));
  const SafeLimits after = load_safe_limits(folder_ / "safe.toml");
  EXPECT_EQ(after.study, before.study);
  EXPECT_EQ(after.participants, 2u);
  EXPECT_EQ(after.procedures, 3u);
  EXPECT_EQ(after.share, 0.95);
  EXPECT_TRUE(after.simulated);
  ASSERT_EQ(after.structures.size(), before.structures.size());
  for (std::size_t s = 0; s < before.structures.size(); ++s) {
    EXPECT_EQ(after.structures[s].name, before.structures[s].name);
    ASSERT_EQ(after.structures[s].intervals.size(), before.structures[s].intervals.size());
    for (std::size_t i = 0; i < before.structures[s].intervals.size(); ++i) {
      const SafeInterval& a = after.structures[s].intervals[i];
      const SafeInterval& b = before.structures[s].intervals[i];
      EXPECT_EQ(a.from, b.from);
      EXPECT_EQ(a.to, b.to);
      EXPECT_EQ(a.force, b.force);
      EXPECT_EQ(a.speed, b.speed);
    }
  }
}

TEST_F(SafeLimitsTest, AnIntervalHasItsBeginningAndNotItsEnd) {
  const SafeLimits limits = made_up();
  const SafeStructure* nerve = limits.of("facial nerve");
  ASSERT_NE(nerve, nullptr);
  EXPECT_EQ(nerve->at(0.0), &nerve->intervals[0]);
  EXPECT_EQ(nerve->at(0.0019), &nerve->intervals[0]);
  EXPECT_EQ(nerve->at(0.002), nullptr) << "nobody drilled there";
  EXPECT_EQ(nerve->at(0.004), &nerve->intervals[1]);
  EXPECT_EQ(nerve->at(0.006), nullptr);
  EXPECT_EQ(nerve->at(-0.001), nullptr);
  EXPECT_EQ(limits.of("incus"), nullptr);
}

TEST_F(SafeLimitsTest, MistakesAreToldInSentences) {
  const std::string good = safe_limits_text(made_up());
  const auto with = [&good](const std::string& what, const std::string& by) {
    std::string text = good;
    return text.replace(text.find(what), what.size(), by);
  };
  EXPECT_THAT(refusal(with("force = [2.0]", "force = [2.0, 3.0]")),
              HasSubstr("write one of each for every interval"));
  EXPECT_THAT(refusal(with("from = [0.0, 0.004]", "from = [0.0, 0.001]")),
              HasSubstr("follow one another"));
  EXPECT_THAT(refusal(with("\"dura\"", "\"facial nerve\"")), HasSubstr("no other structure"));
  EXPECT_THAT(refusal(with("force = [2.0]", "force = [-2.0]")), HasSubstr("force"));
  EXPECT_THAT(refusal(with("simulated = true\n", "")), HasSubstr("experts.simulated"));
  EXPECT_THAT(refusal("[experts]\n"), HasSubstr("structures"));
}

}  // namespace
}  // namespace haptrial::hint
