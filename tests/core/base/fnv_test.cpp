#include "core/base/fnv.h"

#include <gtest/gtest.h>

#include <string>

namespace haptrial {
namespace {

// The test vectors of the authors of FNV (http://www.isthe.com/chongo/tech/comp/fnv).
TEST(FnvTest, HasTheAuthorsValues) {
  EXPECT_EQ(fnv1a(""), 0xcbf29ce484222325U);
  EXPECT_EQ(fnv1a("a"), 0xaf63dc4c8601ec8cU);
  EXPECT_EQ(fnv1a("foobar"), 0x85944171f73967e8U);
}

TEST(FnvTest, TakesANumberAsItsBytesTheLowestFirst) {
  EXPECT_EQ(Fnv1a().add(std::uint64_t{0x7261626f6f66}).value(),
            fnv1a(std::string("foobar\0\0", 8)));
  EXPECT_EQ(Fnv1a().add("foo").add("bar").value(), fnv1a("foobar"));
}

}  // namespace
}  // namespace haptrial
