// Hints of a definition.

#include "core/bone/hint/hint_setup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/definition/schema.h"
#include "tests/support/message_of.h"

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
}

}  // namespace
}  // namespace haptrial::hint
