#include "core/device/own_devices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace haptrial::device {
namespace {

using testing::ThrowsMessage;

TEST(OwnDevicesTest, ADeviceIsFoundByNameWithItsSetting) {
  EXPECT_EQ(own_device("lever"), nullptr);
  add_own_device({"lever", "a lever", nullptr});
  ASSERT_NE(own_device("lever:3"), nullptr);
  EXPECT_EQ(own_device("lever:3")->what, "a lever");
  EXPECT_EQ(setting_of("lever:3"), "3");
  EXPECT_EQ(setting_of("lever"), "");
  EXPECT_EQ(device_names().back(), "lever");
}

TEST(OwnDevicesTest, ANameThatIsTakenOrNoWordIsRefused) {
  for (const char* taken : {"mouse", "replay"}) {
    EXPECT_THAT(
        [&] {
          add_own_device({taken, "", nullptr});
        },
        ThrowsMessage<std::invalid_argument>("add_own_device: there is a device '" +
                                             std::string(taken) + "' already"));
  }
  EXPECT_THAT(
      [] {
        add_own_device({"two words", "", nullptr});
      },
      ThrowsMessage<std::invalid_argument>(
          "add_own_device: 'two words' is no name; allowed: letters, digits and '-'"));
}

}  // namespace
}  // namespace haptrial::device
