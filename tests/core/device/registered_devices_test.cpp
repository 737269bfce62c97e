#include "core/device/registered_devices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace haptrial::device {
namespace {

using testing::ThrowsMessage;

TEST(RegisteredDevicesTest, ADeviceIsFoundByNameWithItsSetting) {
  EXPECT_EQ(registered_device("lever"), nullptr);
  register_device({"lever", "a lever", nullptr});
  ASSERT_NE(registered_device("lever:3"), nullptr);
  EXPECT_EQ(registered_device("lever:3")->what, "a lever");
  EXPECT_EQ(setting_of("lever:3"), "3");
  EXPECT_EQ(setting_of("lever"), "");
  EXPECT_EQ(device_names().back(), "lever");
}

TEST(RegisteredDevicesTest, ANameThatIsTakenOrNoWordIsRefused) {
  for (const char* taken : {"mouse", "replay"}) {
    EXPECT_THAT(
        [&] {
          register_device({taken, "", nullptr});
        },
        ThrowsMessage<std::invalid_argument>("register_device: there is a device '" +
                                             std::string(taken) + "' already"));
  }
  EXPECT_THAT(
      [] {
        register_device({"two words", "", nullptr});
      },
      ThrowsMessage<std::invalid_argument>(
          "register_device: 'two words' is no name; allowed: letters, digits and '-'"));
}

}  // namespace
}  // namespace haptrial::device
