#include "analysis/exchange/score.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace haptrial::analysis {
namespace {

class Named final : public Score {
 public:
  explicit Named(std::string_view name) : name_(name) {}
  std::string_view name() const override { return name_; }
  std::string_view unit() const override { return "1"; }
  std::vector<ScoreValue> values(const record::SessionReader&) const override { return {}; }

 private:
  std::string_view name_;
};

TEST(ScoreTest, ANameThatIsTakenOrEmptyIsRefused) {
  static const Named first("first");
  static const Named again("first");
  static const Named empty("");
  add_score(first);
  EXPECT_THROW(add_score(again), std::invalid_argument);
  EXPECT_THROW(add_score(empty), std::invalid_argument);
  ASSERT_EQ(scores().size(), 1U);
  EXPECT_EQ(scores().front(), &first);
}

}  // namespace
}  // namespace haptrial::analysis
