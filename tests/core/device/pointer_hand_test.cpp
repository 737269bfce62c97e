#include "core/device/pointer_hand.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "core/device/mouse.h"

namespace haptrial::device {
namespace {

constexpr int kWidth = 800;
constexpr int kHeight = 600;
constexpr double kHalf = 0.1;  // of the picture's height at a distance of 1, per unit

/// Looks along -y from 0.2 m above; x to the right, z downwards in the picture.
Camera from_above() {
  Camera camera;
  camera.eye = {0.0, 0.2, 0.0};
  camera.target = {0.0, 0.0, 0.0};
  camera.up = {0.0, 0.0, -1.0};
  camera.field_of_view = 2.0 * std::atan(kHalf);
  return camera;
}

PointerHandParameters parameters() {
  PointerHandParameters p;
  p.start = {0.0, 0.05, 0.0};
  return p;
}

class PointerHandTest : public testing::Test {
 protected:
  /// A tip that nothing holds back.
  HandPose follow() {
    input_.dt = 0.01;
    input_.keys = keys_;
    pose_ = hand_.follow(camera_, kWidth, kHeight, input_, held_back_.value_or(pose_.position),
                         view_held_);
    return pose_;
  }
  HandPose at(double x, double y) {
    input_.pixel = {x, y};
    return follow();
  }

  PointerHand hand_{parameters()};
  Camera camera_{from_above()};
  PointerInput input_;
  std::vector<int> keys_;
  std::optional<Eigen::Vector3d> held_back_;
  bool view_held_{false};
  HandPose pose_;
};

TEST_F(PointerHandTest, TheTipLiesUnderThePointerAtTheDistanceOfItsStart) {
  EXPECT_LT((at(400, 300).position - Eigen::Vector3d(0.0, 0.05, 0.0)).norm(), 1e-12);
  const double edge = 0.15 * kHalf;  // of the picture, 0.15 m from the eye
  EXPECT_LT((at(400, 0).position - Eigen::Vector3d(0.0, 0.05, -edge)).norm(), 1e-12);
  EXPECT_LT((at(700, 300).position - Eigen::Vector3d(edge, 0.05, 0.0)).norm(), 1e-12);
}

TEST_F(PointerHandTest, WheelAndKeysTakeItIntoWhatIsSeenAndBack) {
  at(400, 300);
  input_.wheel = 10.0;
  EXPECT_NEAR(follow().position.y(), 0.05 - 10 * parameters().wheel_step, 1e-12);
  input_.wheel = -10.0;
  EXPECT_NEAR(follow().position.y(), 0.05 + 10 * parameters().wheel_step, 1e-12);
  input_.wheel = 0.0;
  follow();
  keys_ = {'W'};
  for (int i = 0; i < 100; ++i) {
    follow();
  }
  EXPECT_NEAR(pose_.position.y(), 0.05 - parameters().depth_speed, 1e-9) << "in a second";
  keys_ = {'S'};
  for (int i = 0; i < 50; ++i) {
    follow();
  }
  EXPECT_NEAR(pose_.position.y(), 0.05 - 0.5 * parameters().depth_speed, 1e-9);
}

/// A hand that went on would have to come all the way back before it lets go.
TEST_F(PointerHandTest, AHandThatIsHeldBackGoesNotMuchFurther) {
  at(400, 300);
  held_back_ = Eigen::Vector3d(0.0, 0.04, 0.0);
  input_.wheel = 1000.0;
  EXPECT_NEAR(follow().position.y(), 0.04 - parameters().leash, 1e-12);
  input_.wheel -= 10.0;
  EXPECT_NEAR(follow().position.y(), 0.04 - parameters().leash + 10 * parameters().wheel_step,
              1e-12);
}

TEST_F(PointerHandTest, ArrowsTiltAsThePictureHasIt) {
  at(400, 300);
  // The axis that points to the eye, y, is tilted to the right of the picture, x.
  keys_ = {262};
  for (int i = 0; i < 50; ++i) {
    follow();
  }
  const double angle = 0.5 * parameters().turn_speed;
  const Eigen::Vector3d handle = pose_.orientation * Eigen::Vector3d::UnitY();
  EXPECT_LT((handle - Eigen::Vector3d(std::sin(angle), std::cos(angle), 0.0)).norm(), 1e-9);
  keys_ = {263};
  for (int i = 0; i < 50; ++i) {
    follow();
  }
  EXPECT_LT(pose_.orientation.angularDistance(Eigen::Quaterniond::Identity()), 1e-7);
  keys_ = {265};  // up in the picture: -z
  follow();
  EXPECT_LT((pose_.orientation * Eigen::Vector3d::UnitY()).z(), -1e-3);
  EXPECT_LT((pose_.position - Eigen::Vector3d(0.0, 0.05, 0.0)).norm(), 1e-12);
}

TEST_F(PointerHandTest, EAndQRollAsThePictureHasIt) {
  at(400, 300);
  keys_ = {'E'};
  follow();
  const Eigen::Vector3d to_the_top = pose_.orientation * -Eigen::Vector3d::UnitZ();
  EXPECT_GT(to_the_top.x(), 1e-3) << "clockwise: the top goes to the right";
  keys_ = {'Q'};
  follow();
  EXPECT_LT(pose_.orientation.angularDistance(Eigen::Quaterniond::Identity()), 1e-7);
}

TEST_F(PointerHandTest, WhileTheButtonIsHeldThePointerTurnsAndTheTipStays) {
  const Eigen::Vector3d before = at(400, 300).position;
  input_.buttons = 2;
  at(450, 300);
  EXPECT_LT((pose_.position - before).norm(), 1e-12);
  EXPECT_NEAR(pose_.orientation.angularDistance(Eigen::Quaterniond::Identity()),
              50 * parameters().turn_per_pixel, 1e-9);
  input_.buttons = 0;
  follow();
  EXPECT_LT((pose_.position - before).norm(), 1e-12) << "nothing jumps when it is let go";
  for (int i = 0; i < 40; ++i) {
    at(i % 2 == 0 ? 380 : 420, 300);
  }
  EXPECT_LT((at(400, 300).position - before).norm(), 1e-6) << "it came back under the pointer";
}

TEST_F(PointerHandTest, AnotherViewDoesNotMoveTheTip) {
  const Eigen::Vector3d before = at(500, 200).position;
  camera_.field_of_view *= 0.5;
  EXPECT_LT((follow().position - before).norm(), 1e-12) << "zoomed";
  camera_.eye.x() += 0.05;
  EXPECT_LT((follow().position - before).norm(), 1e-12) << "moved";
}

/// The hand's motion moves the view, under which the pointer then lies elsewhere: it must not feed
/// itself.
TEST_F(PointerHandTest, AHandThatMovesTheViewComesToRest) {
  view_held_ = true;
  Eigen::Vector3d before = at(400, 300).position;
  at(420, 300);
  double way = (pose_.position - before).norm();
  EXPECT_GT(way, 1e-4);
  for (int i = 0; i < 20; ++i) {
    camera_.eye += pose_.position - before;
    camera_.target += pose_.position - before;
    before = pose_.position;
    follow();
  }
  EXPECT_LT((pose_.position - before).norm(), 1e-12);
}

TEST_F(PointerHandTest, StaysInTheWorkspace) {
  camera_.field_of_view = 2.0;
  EXPECT_LE(at(0, 0).position.norm(), parameters().reach + 1e-12);
  EXPECT_LE(at(800, 600).position.norm(), parameters().reach + 1e-12);
}

MouseParameters in_space() {
  MouseParameters p;
  p.in_space = true;
  p.start = {0.0, 0.03, 0.0};
  return p;
}

DeviceReading after(MouseDevice& mouse, int ticks) {
  DeviceReading reading;
  for (int i = 0; i < ticks; ++i) {
    EXPECT_TRUE(mouse.read(reading));
    mouse.write(Eigen::Vector3d::Zero());
  }
  return reading;
}

TEST(MouseInSpaceTest, BeginsWhereItIsToldAndReachesWhereItIsSent) {
  MouseDevice mouse(in_space(), 1000.0);
  mouse.move(0.02, 0.02);  // of a flat experiment
  EXPECT_LT((after(mouse, 500).tool.position - Eigen::Vector3d(0.0, 0.03, 0.0)).norm(), 2e-5);
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitX()));
  mouse.reach({{0.02, 0.01, -0.01}, turned});
  const DeviceReading early = after(mouse, 20);
  EXPECT_LT(early.orientation.angularDistance(Eigen::Quaterniond::Identity()), 0.2)
      << "no hand turns in no time";
  const DeviceReading there = after(mouse, 1500);
  EXPECT_LT((there.tool.position - Eigen::Vector3d(0.02, 0.01, -0.01)).norm(), 5e-5);
  EXPECT_LT(there.orientation.angularDistance(turned), 1e-9);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  mouse.reach({{nan, 0.0, 0.0}, turned});
  EXPECT_LT((after(mouse, 10).tool.position - there.tool.position).norm(), 5e-5);
  mouse.reach({{1.0, 0.0, 0.0}, turned});
  EXPECT_LT(after(mouse, 3000).tool.position.norm(), mouse.info().workspace_radius);
}

}  // namespace
}  // namespace haptrial::device
