// Tests that load definitions find the shipped studies, as those of the command do.
#include <gtest/gtest.h>

#include "experiments/command/line/whole_command.h"

namespace haptrial::test {
namespace {

class ShippedStudies : public testing::Environment {
  void SetUp() override { experiments::add_shipped_studies(); }
};

const testing::Environment* const kAdded =
    testing::AddGlobalTestEnvironment(new ShippedStudies);  // GoogleTest deletes it

}  // namespace
}  // namespace haptrial::test
