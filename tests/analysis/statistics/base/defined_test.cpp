#include "analysis/statistics/base/defined.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace haptrial::analysis::defined_test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(DefinedTest, AValueThatIsNotThereGivesItsReason) {
  const Defined<std::string> none(Undefined{"it needs two values"});
  EXPECT_THAT([&] { (void)*none; }, ThrowsMessage<InputError>(HasSubstr("it needs two values")));
  EXPECT_THAT([&] { (void)none->size(); },
              ThrowsMessage<InputError>(HasSubstr("it needs two values")));
  const Defined<std::string> some(std::string("one"));
  EXPECT_EQ(*some, "one");
  EXPECT_EQ(some->size(), 3u);
}

}  // namespace
}  // namespace haptrial::analysis::defined_test
