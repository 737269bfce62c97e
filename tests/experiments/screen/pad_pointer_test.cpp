// A pointer that a game controller moves, by hand.

#include "experiments/screen/pad_pointer.h"

#include <gtest/gtest.h>

namespace haptrial::experiments::pad_pointer_test {
namespace {

device::GamepadState pushed(double right, double up) {
  device::GamepadState pad;
  pad.move = {right, up};
  return pad;
}

TEST(PadPointerTest, AStickMovesItFasterTheFartherItIsPushed) {
  PadPointer pointer(1000, 800);
  EXPECT_EQ(pointer.moved({}, 0.05).position, Eigen::Vector2d(500, 400)) << "from the middle";
  const Eigen::Vector2d all = pointer.moved(pushed(1.0, 0.0), 0.05).position;
  EXPECT_DOUBLE_EQ(all.x(), 500.0 + 0.35 * 800.0 * 0.05);
  EXPECT_EQ(all.y(), 400.0);
  const Eigen::Vector2d half = pointer.moved(pushed(0.0, 0.5), 0.05).position;
  EXPECT_DOUBLE_EQ(half.y(), 400.0 - 0.25 * 0.35 * 800.0 * 0.05) << "up is up";
  const double still = pointer.moved(pushed(-1.0, 0.0), 5.0).position.x();
  EXPECT_DOUBLE_EQ(all.x() - still, 0.35 * 800.0 * 0.1) << "a picture that took long";
}

TEST(PadPointerTest, ItStaysInTheWindow) {
  PadPointer pointer(1000, 800);
  for (int i = 0; i < 200; ++i) {
    pointer.moved(pushed(1.0, 1.0), 0.1);
  }
  EXPECT_EQ(pointer.moved({}, 0.1).position, Eigen::Vector2d(1000, 0));
}

TEST(PadPointerTest, TriggersAreAWheelAndButtonsStay) {
  PadPointer pointer(1000, 800);
  device::GamepadState pad;
  pad.depth = -1.0;
  pad.buttons = 5;
  EXPECT_DOUBLE_EQ(pointer.moved(pad, 0.1).wheel, -1.3);
  pad.depth = 0.0;
  EXPECT_DOUBLE_EQ(pointer.moved(pad, 0.1).wheel, -1.3);
  EXPECT_EQ(pointer.moved(pad, 0.1).buttons, 5u);
}

}  // namespace
}  // namespace haptrial::experiments::pad_pointer_test
