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
  EXPECT_THAT(alike_names({"a\u00a0b", "ab"}), UnorderedElementsAre(ElementsAre("a\u00a0b", "ab")));
}

TEST(AlikeNamesTest, LeavesDifferentNamesAlone) {
  EXPECT_THAT(alike_names({"P1", "P2", "P11", "\u00e9", "\u00e8"}), IsEmpty());
  EXPECT_THAT(alike_names({}), IsEmpty());
}

}  // namespace
}  // namespace haptrial
