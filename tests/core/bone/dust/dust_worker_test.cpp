#include "core/bone/dust/dust_worker.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "core/base/random.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/wait.h"

namespace haptrial::bone {
namespace {

BoneModel block_of_bone() {
  BoneModel model;
  model.grid = {{40, 40, 40}, Eigen::Vector3d::Zero(), 0.5e-3};
  model.structures.resize(2);
  model.labels.assign(model.grid.count(), 1);
  return model;
}

/// Waits until the worker's books show everything.
void wait_for(const DustWorker& worker, double deposited) {
  test::wait_until([&] { return std::abs(worker.balance().deposited - deposited) < 1e-3; });
}

TEST(DustWorkerTest, TakesWhatAServoThreadDrillsWithoutHoldingItUp) {
  BoneVolume bone(block_of_bone());
  DustParameters parameters;
  parameters.region = {Eigen::Vector3d::Constant(-0.02), Eigen::Vector3d::Constant(0.04)};
  DustWorker worker(
      parameters, [&](std::vector<DustBone>& bones) { bones.push_back({&bone}); }, 0.002);
  std::atomic<bool> done{false};
  double drilled = 0.0;
  std::size_t allocations = 1;
  std::thread servo([&] {
    RandomStream random(5, "servo");
    const test::AllocationGuard guard;
    for (int tick = 0; tick < 1500; ++tick) {
      const Eigen::Vector3d centre(0.01 + 1e-6 * tick, 0.0195, 0.01);
      double taken = 0.0;
      for (int n = 0; n < 20; ++n) {
        const Voxel voxel(15 + static_cast<int>(random.below(12)),
                          30 + static_cast<int>(random.below(10)),
                          15 + static_cast<int>(random.below(12)));
        taken += static_cast<double>(bone.take(bone.address(voxel), 0.3F));
      }
      worker.deposit({centre, 1e-3, taken});
      drilled += taken;
      DustTools tools;
      tools.tools[0] = {centre, Eigen::Vector3d::UnitY(), 0.03, 1e-3, false};
      worker.place(tools);
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
    allocations = guard.count();
    done = true;
  });
  std::vector<DustQuad> quads;
  std::uint64_t version = 0;
  int pictures = 0;
  while (!done) {
    pictures += worker.quads(quads, version) ? 1 : 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  servo.join();
  EXPECT_EQ(allocations, 0U);
  wait_for(worker, drilled);
  EXPECT_GT(drilled, 500.0);
  pictures += worker.quads(quads, version) ? 1 : 0;
  EXPECT_GT(pictures, 0);
  EXPECT_FALSE(quads.empty());
  const DustBalance b = worker.balance();
  EXPECT_EQ(b.deposited, b.lying + b.held + b.suctioned + b.fallen);
}

TEST(DustWorkerTest, WhatFindsTheChannelFullGoesWithTheNext) {
  BoneVolume bone(block_of_bone());
  DustWorker worker(
      {}, [&](std::vector<DustBone>& bones) { bones.push_back({&bone}); }, 0.5);
  for (int i = 0; i < 20'000; ++i) {  // more than the channel holds, within one period
    worker.deposit({Eigen::Vector3d(0.01, 0.03, 0.01), 1e-3, 0.25});
  }
  test::wait_until([&] { return worker.balance().deposited > 0.0; });  // there is room again
  worker.deposit({Eigen::Vector3d(0.01, 0.03, 0.01), 1e-3, 1.0});
  wait_for(worker, 5001.0);
}

/// However slow its rounds are, and though no other deposit takes along what found no room.
TEST(DustWorkerTest, SettledItHasAllThatWasDeposited) {
  BoneVolume bone(block_of_bone());
  DustWorker worker(
      {},
      [&](std::vector<DustBone>& bones) {
        bones.push_back({&bone});
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
      },
      0.5);
  for (int i = 0; i < 20'000; ++i) {  // more than the channel holds, within one period
    worker.deposit({Eigen::Vector3d(0.01, 0.03, 0.01), 1e-3, 0.25});
  }
  worker.settle();
  EXPECT_NEAR(worker.balance().deposited, 5000.0, 1e-3);
}

TEST(DustWorkerTest, APeriodOutOfBoundsIsRefused) {
  EXPECT_THROW(DustWorker(
                   {}, [](std::vector<DustBone>&) {}, 0.0),
               std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::bone
