#include "core/base/alike_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace haptrial {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

TEST(AlikeNamesTest, FindsWhatATypoMayHaveMade) {
  EXPECT_THAT(alike_names({"visual", "haptic", "Visual", "no-guide", "no guide", "No_Guide"}),
              UnorderedElementsAre(ElementsAre("visual", "Visual"),
                                   ElementsAre("no-guide", "no guide", "No_Guide")));
  EXPECT_THAT(alike_names({"1", "P00", "01", "P0", "p0"}),
              UnorderedElementsAre(ElementsAre("1", "01"), ElementsAre("P00", "P0", "p0")));
  EXPECT_THAT(alike_names({"a\u00a0b", "ab"}), UnorderedElementsAre(ElementsAre("a\u00a0b", "ab")));
}

TEST(AlikeNamesTest, LeavesDifferentNamesAlone) {
  EXPECT_THAT(alike_names({"P1", "P2", "P11", "P101", "P10", "\u00e9", "\u00e8"}), IsEmpty());
  EXPECT_THAT(alike_names({"0.5", "0.05", "0,005", "0,05", "10", "100"}), IsEmpty());
  EXPECT_THAT(alike_names({}), IsEmpty());
}

TEST(AlikeNamesTest, WarningsQuoteTheNames) {
  EXPECT_THAT(alike_names_warnings("participants", {"P1", "P2", "p01"}),
              ElementsAre("WARNING: the names of participants differ only in blanks, hyphens, "
                          "capitals or leading zeros and are taken for different participants: "
                          "\"P1\", \"p01\"."));
}

}  // namespace
}  // namespace haptrial
