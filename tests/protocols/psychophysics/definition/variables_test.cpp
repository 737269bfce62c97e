#include "protocols/psychophysics/definition/names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/base/definition/expression.h"
#include "core/base/error.h"

namespace haptrial::protocols {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class VariablesTest : public testing::Test {
 protected:
  VariablesTest() {
    variables_.declare("level");
    variables_.define("reference", Expression(300.0));
    variables_.define("difference", formula("level - reference"));
    variables_.define("weber", formula("difference / reference"));
  }
  Expression formula(const char* text) { return {text, labels_}; }

  Labels labels_;
  Variables variables_;
};

TEST_F(VariablesTest, AFormulaFollowsTheVariablesThatItNames) {
  variables_.set("level", 330.0);
  EXPECT_DOUBLE_EQ(variables_.value("weber"), 0.1);
  variables_.set("level", 450.0);
  EXPECT_DOUBLE_EQ(variables_.value("weber"), 0.5);
  EXPECT_DOUBLE_EQ(variables_.value(formula("2 * $weber")), 1.0);
}

TEST_F(VariablesTest, ADeclaredNameHasToGetItsValue) {
  EXPECT_THAT([&] { variables_.value("weber"); },
              ThrowsMessage<InputError>(HasSubstr("level has no value yet")));
  EXPECT_THROW(variables_.set("stifness", 1.0), std::invalid_argument);
}

TEST_F(VariablesTest, UnknownNamesAreSaidBeforeTheFirstTrial) {
  EXPECT_NO_THROW(variables_.check(formula("weber > 0.1")));
  EXPECT_THAT([&] { variables_.check(formula("2 * stifness")); },
              ThrowsMessage<InputError>(
                  "there is no variable stifness; allowed: difference, level, reference, weber"));
}

TEST_F(VariablesTest, CirclesAreNamed) {
  variables_.define("a", formula("b + 1"));
  variables_.define("b", formula("c * 2"));
  variables_.define("c", formula("a"));
  EXPECT_THAT([&] { variables_.check(formula("a")); },
              ThrowsMessage<InputError>("a depends on itself, by way of a, b, c"));
  EXPECT_THAT([&] { variables_.value("b"); },
              ThrowsMessage<InputError>("b depends on itself, by way of b, c, a"));
}

TEST_F(VariablesTest, AMeaningIsStatedOnceAndAGivenValueStandsBeforeIt) {
  EXPECT_THROW(variables_.define("reference", Expression(1.0)), InputError);
  const double stated = variables_.value("reference");
  variables_.declare("reference");
  EXPECT_EQ(variables_.value("reference"), stated);
  variables_.set("reference", 5.0);
  EXPECT_EQ(variables_.value("reference"), 5.0);
  EXPECT_THAT(variables_.known(), testing::Contains(testing::Pair("reference", 5.0)));
  variables_.forget_given();
  EXPECT_EQ(variables_.value("reference"), stated);
}

TEST_F(VariablesTest, KnownAreThoseWhoseFormulasHaveAllTheirValues) {
  variables_.declare("answer");
  variables_.define("twice", formula("2 * answer"));
  EXPECT_THAT(variables_.known(), testing::Not(testing::Contains(testing::Key("twice"))));
  variables_.set("answer", 3.0);
  EXPECT_THAT(variables_.known(), testing::Contains(testing::Pair("twice", 6.0)));
}

}  // namespace
}  // namespace haptrial::protocols
